#include "nsma/orbit/motion_label.hpp"

#include <algorithm>
#include <cmath>

#include "fnv_hash.hpp"
#include "index.hpp"
#include "minimal_period.hpp"
#include "nsma/orbit/conditions.hpp"

namespace nsma {
namespace {

// One shortest period of a motion: its waves, and which steps press or rest at the wall.
struct Cycle {
    std::vector<double> waves;
    std::vector<char> loaded;
    std::vector<char> rests;

    [[nodiscard]] int steps() const { return static_cast<int>(waves.size()); }
    [[nodiscard]] bool at_wall(int n) const {
        return loaded[index(n % steps())] != 0 || rests[index(n % steps())] != 0;
    }
};

// Steps [begin, begin + steps) at the wall, begin in [0, n_T), cyclically.
struct Rest {
    int begin = 0;
    int steps = 0;
};

std::vector<Rest> rests_of(const Cycle& cycle) {
    const int period = cycle.steps();
    std::vector<Rest> all;
    for (int n = 0; n < period; ++n) {
        if (!cycle.at_wall(n) || cycle.at_wall(n + period - 1)) continue;
        Rest rest{n, 1};
        while (cycle.at_wall(n + rest.steps)) ++rest.steps;
        all.push_back(rest);
    }
    return all;
}

// The rests that contact may take: those with force, else the longest. Of a tip that never leaves the wall all but one
// silent step.
std::vector<Rest> contacts_of(const Cycle& cycle) {
    const int period = cycle.steps();
    std::vector<Rest> all = rests_of(cycle);
    if (all.empty()) {
        for (int n = 0; n < period; ++n) {
            if (cycle.rests[index(n)] != 0 && cycle.loaded[index(n)] == 0)
                all.push_back({(n + 1) % period, period - 1});
        }
        return all;
    }
    const auto presses = [&](const Rest& rest) {
        for (int n = rest.begin; n < rest.begin + rest.steps; ++n) {
            if (cycle.loaded[index(n % period)] != 0) return true;
        }
        return false;
    };
    if (std::any_of(all.begin(), all.end(), presses)) {
        std::erase_if(all, [&](const Rest& rest) { return !presses(rest); });
    } else {
        const int longest = std::max_element(all.begin(), all.end(), [](const Rest& a, const Rest& b) {
                                return a.steps < b.steps;
                            })->steps;
        std::erase_if(all, [longest](const Rest& rest) { return rest.steps < longest; });
    }
    return all;
}

// Flight first, then contact; backward in time a wave changes its sign with the free step it arrives in.
std::vector<double> waves_from(const Cycle& cycle, int flight_begin, int free_steps, bool reversed) {
    const int period = cycle.steps();
    std::vector<double> waves(index(period));
    for (int n = 0; n < period; ++n) {
        const bool flight = n < free_steps;
        const int back = flight ? free_steps - 1 - n : free_steps + period - 1 - n;
        const int step = (flight_begin + (reversed ? back : n)) % period;
        waves[index(n)] = reversed && flight ? -cycle.waves[index(step)] : cycle.waves[index(step)];
    }
    return waves;
}

// Whether a stands before b: at the first wave in which they differ it is the greater.
bool precedes(const std::vector<double>& a, const std::vector<double>& b, double tolerance) {
    for (std::size_t n = 0; n < a.size(); ++n) {
        if (std::abs(a[n] - b[n]) > tolerance) return a[n] > b[n];
    }
    return false;
}

}  // namespace

std::optional<LabelledMotion> least_label(const Orbit& orbit, double tolerance) {
    const Eigen::VectorXd waves = orbit.kernel.waves(orbit.beta);
    const double silence = tolerance * waves.cwiseAbs().maxCoeff();
    if (silence == 0) return std::nullopt;
    const Eigen::VectorXd tip = tip_history(orbit.kernel, orbit.beta);
    const int gap_sign = orbit.bar.gap_sign();
    const double touch = tolerance * (gap_sign != 0 ? 1.0 : tip.cwiseAbs().maxCoeff());

    Cycle cycle;
    const int period = minimal_period(waves, silence);
    for (int n = 0; n < period; ++n) {
        const bool silent = std::abs(waves[n]) <= silence;
        bool contact = false;  // under the orbit's own label, in any repetition
        for (int k = n; k < waves.size(); k += period) contact = contact || k >= orbit.kernel.pattern.free_steps;
        cycle.waves.push_back(waves[n]);
        cycle.loaded.push_back(static_cast<char>(contact && !silent));
        cycle.rests.push_back(static_cast<char>(silent && std::abs(tip[n] - gap_sign) <= touch));
    }
    std::optional<LabelledMotion> first;
    for (const Rest& contact : contacts_of(cycle)) {
        for (const bool reversed : {false, true}) {
            LabelledMotion motion;
            motion.label = {period - contact.steps, contact.steps, (contact.begin + contact.steps) % period, reversed};
            motion.waves = waves_from(cycle, motion.label.shift_steps, motion.label.free_steps, reversed);
            if (!first || precedes(motion.waves, first->waves, silence)) first = std::move(motion);
        }
    }
    return first;
}

std::array<std::uint64_t, 2> fingerprints(const LabelledMotion& motion) {
    constexpr double steps = 1e7;
    double largest = 0;
    for (const double wave : motion.waves) largest = std::max(largest, std::abs(wave));
    std::array<std::uint64_t, 2> result{};
    for (std::size_t grid = 0; grid < 2; ++grid) {
        FnvHash hash;
        hash.add(static_cast<std::uint64_t>(motion.label.free_steps));
        hash.add(static_cast<std::uint64_t>(motion.label.contact_steps));
        for (const double wave : motion.waves) {
            hash.add(static_cast<std::uint64_t>(std::llround(steps * wave / largest + (grid == 0 ? 0.0 : 0.5))));
        }
        result.at(grid) = hash.value();
    }
    return result;
}

}  // namespace nsma
