#include "nsma/orbit/replay.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "wave/wave_queue.hpp"

namespace nsma {

namespace {

/// Below this share of the largest wave an orbit has no contact force to compare with.
constexpr double no_force = 1e-12;

/// Raw figures of one period with the labelled schedule.
struct Labelled {
    double penetration = 0.0;            ///< max (x_n - d)+, n = 0..r [m]
    double separation = 0.0;             ///< max |x_n - d|, n = 0, r..n_T [m]
    double tension = 0.0;                ///< max (lambda_n)+ [N]
    double largest_force = 0.0;          ///< max |lambda_n| [N]
    double largest_tip = 0.0;            ///< max |x_n| [m]
    double force_of_largest_wave = 0.0;  ///< 2 z S max|b| [N]
    double defect = 0.0;                 ///< ||b_nT - b_0|| / ||b_0||
};

Labelled labelled_period(const Orbit& orbit, const State& initial) {
    const Pattern& pattern = orbit.kernel.pattern;
    const double gap = orbit.bar.gap;
    WaveQueue queue(orbit.bar, orbit.mesh(), initial);
    const WaveQueue start = queue;
    Labelled result;
    for (int n = 0; n <= pattern.period_steps(); ++n) {
        const double distance = queue.tip() - gap;
        result.largest_tip = std::max(result.largest_tip, std::abs(queue.tip()));
        if (n <= pattern.free_steps) {
            result.penetration = std::max(result.penetration, distance);
        }
        if (n == 0 || n >= pattern.free_steps) {
            result.separation = std::max(result.separation, std::abs(distance));
        }
        if (n == pattern.period_steps()) {
            break;
        }
        if (n < pattern.free_steps) {
            queue.step_free();
        } else {
            result.tension = std::max(result.tension, queue.contact_force());
            result.largest_force = std::max(result.largest_force, std::abs(queue.contact_force()));
            queue.step_contact();
        }
    }
    double norm = 0.0;
    double defect = 0.0;
    double largest_wave = 0.0;
    for (int k = 0; k < start.window(); ++k) {
        norm = std::hypot(norm, start.wave(k));
        defect = std::hypot(defect, queue.wave(k) - start.wave(k));
        largest_wave = std::max(largest_wave, std::abs(start.wave(k)));
    }
    result.defect = norm > 0.0 ? defect / norm : 0.0;
    result.force_of_largest_wave = 2.0 * orbit.bar.impedance() * orbit.bar.area * largest_wave;
    return result;
}

/// value / scale, where 0 / 0 is no violation.
double relative(double value, double scale) { return value == 0.0 ? 0.0 : value / scale; }

}  // namespace

double Violations::worst() const { return std::max({periodicity, cond1, cond2, cond3, energy}); }

Replay replay(const Orbit& orbit, std::optional<double> level, int periods, double tolerance) {
    if (level && !(std::isfinite(*level) && *level > 0.0)) {
        throw std::invalid_argument(fmt::format("level: expected a finite value > 0, got {}", *level));
    }
    if (!std::isfinite(tolerance) || tolerance < 0.0) {
        throw std::invalid_argument(fmt::format("tolerance: expected a finite value >= 0, got {}", tolerance));
    }
    const Pattern& pattern = orbit.kernel.pattern;
    const State initial = initial_state(orbit);

    const Labelled seen = labelled_period(orbit, initial);
    const double displacement_scale = orbit.bar.gap != 0.0 ? std::abs(orbit.bar.gap) : seen.largest_tip;
    const double force_scale =
        seen.largest_force > no_force * seen.force_of_largest_wave ? seen.largest_force : seen.force_of_largest_wave;
    Replay result;
    result.violations.periodicity = seen.defect;
    result.violations.cond1 = relative(seen.penetration, displacement_scale);
    result.violations.cond2 = relative(seen.separation, displacement_scale);
    result.violations.cond3 = relative(seen.tension, force_scale);
    if (level) {
        const double ratio = energy(orbit.bar, orbit.mesh(), initial) / orbit.bar.energy_unit();
        result.violations.energy = std::abs(ratio - *level) / *level;
    }

    result.march = march(orbit.bar, orbit.mesh(), initial, pattern.period_steps(), periods);
    result.same_labels = true;
    for (int n = 0; n < pattern.period_steps(); ++n) {
        const MarchedStep& step = result.march.first_period[static_cast<std::size_t>(n)];
        if (!step.silent && step.contact != (n >= pattern.free_steps)) {
            result.same_labels = false;
        }
    }
    const double march_worst = std::max({
        result.march.periodicity_defect,
        relative(result.march.worst_penetration, displacement_scale),
        relative(result.march.worst_separation, displacement_scale),
        relative(result.march.worst_tension, force_scale),
    });
    result.accepted = result.violations.worst() <= tolerance && march_worst <= tolerance && result.same_labels;
    return result;
}

}  // namespace nsma
