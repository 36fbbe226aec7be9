#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "forced.hpp"

#include "nsma/orbit/backbone.hpp"
#include "nsma/orbit/orbit.hpp"
#include "nsma/numerics/interruption.hpp"
#include "nsma/search/pattern_problem.hpp"

namespace nsma {
namespace {

using std::numbers::pi;

// Of an orbit over a period, at an angular frequency of once a period: the work of F cos at its best phase, and the
// loss.
std::array<double, 2> work_and_loss(const Orbit& orbit, const Scene& scene) {
    const Pattern& pattern = orbit.kernel.pattern;
    const Eigen::VectorXd tip = tip_displacement(orbit);
    const double step = orbit.mesh().time_step(orbit.bar);
    std::complex<double> harmonic = 0;
    double squares = 0;
    for (int n = 0; n < pattern.period_steps(); ++n) {
        const double moved = tip[n + 1] - tip[n];
        harmonic += moved * std::polar(1.0, 2 * pi * (n + 0.5) / pattern.period_steps());
        squares += moved * moved / step;
    }
    const double work = scene.forcing->amplitude * std::abs(harmonic);
    if (scene.damping.kind == Damping::Kind::tip)
        return {work, scene.damping.value * orbit.bar.impedance() * orbit.bar.area * squares};
    if (scene.damping.kind == Damping::Kind::none) return {work, 0.0};
    const double cell = orbit.mesh().cell_length(orbit.bar);
    const double kinetic = 0.5 * orbit.bar.density * orbit.bar.area * cell * field(orbit).velocity.squaredNorm();
    return {work, 2 * scene.damping.value * kinetic * step};
}

}  // namespace

std::vector<BalancePoint> balance_points(const Scene& scene) {
    std::vector<BalancePoint> points;
    const auto& [lo, hi] = std::minmax_element(scene.forcing->frequencies.begin(), scene.forcing->frequencies.end());
    constexpr int most_modes = 30;
    for (int mode = 1; mode <= most_modes && scene.bar.gap != 0; ++mode) {
        std::vector<Pattern> patterns = mode_patterns(mode, scene.mesh.cells, scene.bar.gap_sign());
        std::reverse(patterns.begin(), patterns.end());  // frequencies rise
        for (const Pattern& pattern : patterns) {
            stop_point();
            if (pattern.frequency_ratio() < *lo || pattern.frequency_ratio() > *hi) continue;
            const PatternProblem problem = pattern_problem(pattern, scene.bar.gap_sign(), {.prove = false});
            if (problem.verdict != Verdict::admissible) continue;
            const Orbit orbit = make_orbit(scene.bar, problem.kernel, problem.set.reduction.beta(problem.set.least));
            const auto [work, loss] = work_and_loss(orbit, scene);
            points.push_back({mode, pattern.frequency_ratio(), energy_ratio(orbit),
                              loss > 0 ? work / loss : std::numeric_limits<double>::infinity()});
        }
    }
    return points;
}

std::vector<BalancePoint> predicted_jumps(const std::vector<BalancePoint>& points) {
    std::vector<BalancePoint> found;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const bool rises = points[i].energy < points[i + 1].energy;  // of a negative gap they fall with the frequency
        const BalancePoint& a = points[rises ? i : i + 1];
        const BalancePoint& b = points[rises ? i + 1 : i];
        if (a.mode != b.mode || !(a.ratio >= 1) || b.ratio >= 1) continue;
        const double part = std::log(a.ratio) / std::log(a.ratio / b.ratio);
        found.push_back({a.mode, a.frequency + part * (b.frequency - a.frequency),
                         a.energy * std::pow(b.energy / a.energy, part), 1.0});
    }
    return found;
}

}  // namespace nsma
