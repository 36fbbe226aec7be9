#include "forced.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <exception>
#include <limits>
#include <mutex>
#include <numbers>
#include <stdexcept>
#include <thread>

#include "wave/driven_bar.hpp"
#include "nsma/numerics/interruption.hpp"

namespace nsma {
namespace {

using std::numbers::pi;

// The tip returns when it differs by less than this share of its range; or nearly.
constexpr double return_tolerance = 1e-3;
constexpr double near_tolerance = 0.05;
constexpr int most_periods = 8;
// Energies whose means over the two halves of a record differ by more than this share still grow or fall.
constexpr double steady_tolerance = 0.05;
// A difference of motions of this size, over that of the motion, that grows a thousandfold parts them.
constexpr double small_difference = 1e-9;
const double parting = std::log(1e3);

constexpr int turns_between_cosines = 64;

// The staircase of F cos(2 pi phase): its value in the middle of each step, in continuous phase. Turned step by step,
// and set right where rounding would show.
class Cosine {
public:
    Cosine(double amplitude, double phase, double step) : amplitude_(amplitude), start_(phase), step_(step) { turn(); }

    double next() {
        const double value = amplitude_ * now_.real();
        if (++count_ % turns_between_cosines == 0) {
            turn();
        } else {
            now_ *= each_;
        }
        return value;
    }
    [[nodiscard]] double phase() const {
        const double phase = start_ + static_cast<double>(count_) * step_;
        return phase - std::floor(phase);
    }

private:
    void turn() {
        now_ = std::polar(1.0, 2 * pi * (phase() + 0.5 * step_));
        each_ = std::polar(1.0, 2 * pi * step_);
    }

    double amplitude_, start_, step_;  // phases in periods
    long count_ = 0;
    std::complex<double> now_, each_;
};

// How much two motions differ in their waves.
double distance(const WaveQueue& a, const WaveQueue& b) {
    double sum = 0;
    for (int k = 0; k < a.window(); ++k) sum += std::pow(a.wave(k) - b.wave(k), 2);
    return std::sqrt(sum);
}

// The tip at any time in steps, which is straight between two of them.
double tip_at(const std::vector<double>& tips, double when) {
    const auto step = std::min(static_cast<std::size_t>(when), tips.size() - 2);
    return tips[step] + (when - static_cast<double>(step)) * (tips[step + 1] - tips[step]);
}

// What a bar under a force of one frequency did.
class Point {
public:
    Point(const Scene& scene, int place, bool up) : scene_(scene), forcing_(*scene.forcing) {
        point_.up = up;
        point_.place = place;
        point_.frequency = forcing_.frequencies[static_cast<std::size_t>(place)];
        period_ = 4.0 * scene.mesh.cells / point_.frequency;  // in steps, seldom a whole number
    }

    ForcedPoint run(const State& start, double phase) {
        DrivenBar bar(scene_.bar, scene_.mesh, start, scene_.damping);
        Cosine force(forcing_.amplitude, phase, 1.0 / period_);
        const auto settle = static_cast<long>(std::llround(forcing_.settle * period_));
        bool pressed = false;
        for (long n = 0; n < settle; ++n) {
            if (n % turns_between_cosines == 0) stop_point();
            pressed = bar.step(force.next()).wall_force < 0;
        }
        record(bar, force, pressed);
        for (int k = 0; k < bar.queue().window(); ++k) point_.waves.push_back(bar.queue().wave(k));
        point_.phase = force.phase();
        return std::move(point_);
    }

private:
    void record(DrivenBar& bar, Cosine& force, bool contact) {
        const auto steps = static_cast<long>(std::llround(forcing_.record * period_));
        const double unit = scene_.bar.energy_unit();
        const double before = bar.energy();
        // A motion beside this one, to see whether they part.
        State neighbour = bar.queue().state();
        const double size =
            std::sqrt(before / (scene_.bar.density * scene_.bar.area * scene_.mesh.cell_length(scene_.bar)));
        neighbour[2 * scene_.mesh.cells - 1] += small_difference * size;
        DrivenBar other(scene_.bar, scene_.mesh, neighbour, scene_.damping);
        const double apart = distance(bar.queue(), other.queue());

        std::vector<double> tips{bar.tip()};
        tips.reserve(static_cast<std::size_t>(steps) + 1);
        double energy = before, work = 0, loss = 0, landing = 0, sum = 0, first_half = 0;
        long phases = 0;
        bool touched = false;
        for (long n = 0; n < steps; ++n) {
            if (n % turns_between_cosines == 0) stop_point();
            const double pull = force.next();
            const auto step = bar.step(pull);
            (void)other.step(pull);
            work += step.work;
            loss += step.loss;
            landing -= step.landing;
            energy += step.work - step.loss + step.landing;
            sum += energy;
            if (n == steps / 2) first_half = sum / static_cast<double>(n + 1);
            point_.energy_max = std::max(point_.energy_max, energy / unit);
            point_.peak_force = std::max(point_.peak_force, -step.wall_force);
            const double next_section = static_cast<double>(point_.section.size()) * period_;
            if (next_section < static_cast<double>(n + 1)) {
                const double part = next_section - static_cast<double>(n);
                point_.section.push_back({tips.back() + part * (bar.tip() - tips.back()), step.tip_velocity});
            }
            const bool presses = step.wall_force < 0;
            phases += presses && !contact;
            contact = presses;
            touched = touched || presses;
            tips.push_back(bar.tip());
        }
        const double after = bar.energy();
        const double count = forcing_.record;
        const double mean = sum / static_cast<double>(steps);
        const auto [least, greatest] = std::minmax_element(tips.begin(), tips.end());
        point_.tip_least = *least;
        point_.tip_greatest = *greatest;
        point_.energy_mean = mean / unit;
        point_.work = work / unit / count;
        point_.loss = loss / unit / count;
        point_.landing = landing / unit / count;
        point_.growth = (after - before) / unit / count;
        point_.balance =
            work == 0 && loss == 0 ? 0 : std::abs(work - loss - landing - (after - before)) / (std::abs(work) + loss);
        point_.contact_phases = static_cast<double>(phases) / count;
        const double now = distance(bar.queue(), other.queue());
        // What has died out is as near as can be told.
        point_.divergence = apart > 0 ? std::log(std::max(now / apart, std::numeric_limits<double>::epsilon())) : 0.0;
        find_return(tips, return_tolerance);
        const bool returns = point_.periods > 0;
        if (!returns) find_return(tips, near_tolerance);
        const double second_half = 2 * mean - first_half;
        const bool settled = std::abs(second_half - first_half) <= steady_tolerance * mean;
        // A difference that only shears grows with the number of periods.
        const bool parts = point_.divergence > parting + std::log(count);
        if (returns) {
            point_.kind = touched ? ForcedKind::periodic : ForcedKind::contact_free;
        } else if (!settled) {
            point_.kind = ForcedKind::transient;
            point_.periods = 0;
        } else if (point_.periods > 0) {
            point_.kind = ForcedKind::nearly_periodic;
        } else {
            point_.kind = parts ? ForcedKind::chaotic : ForcedKind::quasi_periodic;
        }
    }

    // The least number of periods after which the tip is where it was, all through the record, and after as many of
    // them as there are in half of it: neither grows, fades nor beats.
    void find_return(const std::vector<double>& tips, double tolerance) {
        const double range = point_.tip_greatest - point_.tip_least;
        const auto defect_after = [&](int periods) {
            const double shift = periods * period_;
            double worst = 0;
            for (std::size_t n = 0; static_cast<double>(n) + shift <= static_cast<double>(tips.size() - 1); ++n)
                worst = std::max(worst, std::abs(tip_at(tips, static_cast<double>(n) + shift) - tips[n]));
            return range > 0 ? worst / range : 0.0;
        };
        for (int periods = 1; periods <= std::min(most_periods, forcing_.record / 2); ++periods) {
            const double defect = defect_after(periods);
            if (periods == 1) point_.defect = defect;
            if (defect > tolerance) continue;
            const int many = periods * std::max(1, forcing_.record / (2 * periods));
            if (defect_after(many) > tolerance) continue;
            point_.periods = periods;
            point_.defect = defect;
            return;
        }
    }

    const Scene& scene_;
    const Forcing& forcing_;
    ForcedPoint point_;
    double period_ = 0;
};

}  // namespace

std::string_view name(ForcedKind kind) {
    constexpr std::array<std::string_view, 6> names{"contact-free",   "periodic", "nearly-periodic",
                                                    "quasi-periodic", "chaotic",  "transient"};
    return names.at(static_cast<std::size_t>(kind));
}

std::vector<Jump> jumps(const std::vector<ForcedPoint>& points) {
    constexpr double other = 1.2;                         // that much apart two energies are two answers
    std::vector<std::array<const ForcedPoint*, 2>> both;  // by frequency: up, down
    for (const ForcedPoint& point : points) {
        both.resize(std::max(both.size(), static_cast<std::size_t>(point.place) + 1), {nullptr, nullptr});
        both[static_cast<std::size_t>(point.place)][point.up ? 0 : 1] = &point;
    }
    std::vector<Jump> found;
    bool before = false;
    const auto settled = [](const ForcedPoint& point) {
        return point.kind != ForcedKind::transient && point.kind != ForcedKind::chaotic &&
               point.kind != ForcedKind::quasi_periodic;
    };
    for (std::size_t i = 0; i < both.size(); ++i) {
        const auto [up, down] = both[i];
        if (up == nullptr || down == nullptr) return {};
        const double ratio = up->energy_max / down->energy_max;
        const bool differ = ratio > other || ratio < 1 / other;
        // A sweep leaves what depends on its direction at the far end.
        if (i > 0 && differ != before) {
            const ForcedPoint* const left = both[i - 1][before ? 0 : 1];
            const ForcedPoint* const right = before ? up : down;
            const double change = before ? right->energy_max / left->energy_max : left->energy_max / right->energy_max;
            if (settled(*left) && settled(*right) && (change > other || change < 1 / other))
                found.push_back({before, left->frequency, right->frequency, change > 1});
        }
        before = differ;
    }
    return found;
}

std::vector<ForcedPoint> forced_response(const Scene& scene, const std::vector<ForcedPoint>& known,
                                         const std::function<void(const ForcedPoint&)>& done) {
    if (!scene.forcing) throw std::invalid_argument("scene.forcing: expected one, got none");
    const Forcing& forcing = *scene.forcing;
    // Points that follow each other: one after another.
    std::vector<std::vector<ForcedPoint>> strands;
    for (const bool up : {true, false}) {
        if (!(up ? forcing.up : forcing.down)) continue;
        strands.emplace_back();
        const auto count = static_cast<int>(forcing.frequencies.size());
        for (int i = 0; i < count; ++i) {
            ForcedPoint point;
            point.up = up;
            point.place = up ? i : count - 1 - i;
            if (forcing.from_rest && i > 0) strands.emplace_back();
            strands.back().push_back(point);
        }
    }
    std::array<std::vector<const ForcedPoint*>, 2> done_before;  // of sweeps down, up
    for (auto& sweep : done_before) sweep.resize(forcing.frequencies.size());
    for (const ForcedPoint& point : known)
        done_before.at(point.up ? 1 : 0).at(static_cast<std::size_t>(point.place)) = &point;
    std::mutex mutex;
    std::size_t next = 0;
    std::exception_ptr failure;  // the first that a thread met
    const auto work = [&] {
        for (;;) {
            std::vector<ForcedPoint>* strand = nullptr;
            {
                const std::lock_guard lock(mutex);
                if (next == strands.size() || failure || stop_requested()) return;
                strand = &strands[next++];
            }
            State state = rest_state(scene.bar, scene.mesh);
            double phase = 0;
            try {
                for (ForcedPoint& point : *strand) {
                    {
                        const std::lock_guard lock(mutex);
                        if (failure) return;
                    }
                    const ForcedPoint* old = done_before.at(point.up ? 1 : 0).at(static_cast<std::size_t>(point.place));
                    point = old != nullptr ? *old : Point(scene, point.place, point.up).run(state, phase);
                    state = state_of_waves(scene.bar, point.waves);
                    phase = point.phase;
                    if (old != nullptr) continue;
                    const std::lock_guard lock(mutex);
                    done(point);
                }
            } catch (const Interrupted&) {
                return;
            } catch (...) {
                const std::lock_guard lock(mutex);
                if (!failure) failure = std::current_exception();
                return;
            }
        }
    };
    {
        std::vector<std::jthread> threads;
        const unsigned count = std::max(1U, std::thread::hardware_concurrency());
        for (unsigned i = 1; i < std::min<std::size_t>(count, strands.size()); ++i) threads.emplace_back(work);
        work();
    }
    if (failure) std::rethrow_exception(failure);
    std::vector<ForcedPoint> points;
    for (const auto& strand : strands) {
        for (const ForcedPoint& point : strand) {
            if (!point.waves.empty()) points.push_back(point);
        }
    }
    return points;
}

}  // namespace nsma
