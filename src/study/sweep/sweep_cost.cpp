#include "sweep_cost.hpp"

#include <algorithm>
#include <cmath>

#include "nsma/orbit/pattern_kind.hpp"
#include "nsma/search/pattern_problem.hpp"

namespace nsma {
namespace {

// Measured [us] on sweeps of 12 to 700 cells, m up to 350, by every choice of solvers: of most patterns within a factor
// of two, of single levels within ten.
constexpr double decided = 30;        // a pattern without orbits; with its proof 2 m^2 more where there are some
constexpr double outside_level = 20;  // a level outside the interval: to store it
constexpr double closed_form = 100;   // an orbit by a formula
constexpr double by_ipopt = 5'500;    // one of a contact motion by solvers,
constexpr double by_nlopt = 1'000;
constexpr double polished = 0.15;    // and so many m^3 more
constexpr double searched = 3'000;   // one of a free pattern from eight starts, each of them a twentieth,
constexpr double searched_on = 4;    // and so many m^3 more,
constexpr double searched_all = 12;  // or so many where every method is tried in turn

// So that those of 10 million patterns add up; it is more than a day.
std::int64_t whole(double cost) {
    constexpr double most = 1e11;
    return std::llround(std::min(cost, most));
}

double answer_cost(PatternKind kind, double m, Objective objective, const OrbitSolverOptions& options) {
    const bool proof = options.solvers == SolverChoice::proof;
    if (is_extreme(objective) || m < 2) return closed_form;
    const double cube = m * m * m;
    if (kind == PatternKind::free) {
        if (proof && (m == 2 || objective == Objective::least_force)) return closed_form;
        return (searched + (proof ? searched_all : searched_on) * cube) * (12 + options.starts) / 20;
    }
    if (proof) return closed_form;
    return (options.solvers != SolverChoice::nlopt ? by_ipopt : 0) +
           (options.solvers != SolverChoice::ipopt ? by_nlopt : 0) + polished * cube;
}

}  // namespace

SweepCost::SweepCost(const Scene& scene, const OrbitSolverOptions& options)
    : sieve_(scene.mesh.cells, scene.bar.gap_sign()),
      options_(options),
      objective_(scene.objective),
      all_kinds_(scene.all_kinds),
      levels_(scene.levels) {
    std::sort(levels_.begin(), levels_.end());
}

SweepCost::Cost SweepCost::operator()(const Pattern& pattern) {
    const Sieved sieved = sieve_(pattern.free_steps, pattern.contact_steps);
    const double m = sieved.kernel_dimension;
    Cost cost;
    cost.verdict = whole(decided);
    if (sieved.finding != Finding::admissible || m > max_unknowns) return cost;
    cost.verdict = whole(decided + 2 * m * m);
    const auto kind = pattern_kind(pattern);
    if (!is_solved(all_kinds_, kind)) return cost;
    const auto first = std::lower_bound(levels_.begin(), levels_.end(), sieved.energy_least);
    const auto last = sieved.unbounded ? levels_.end() : std::upper_bound(first, levels_.end(), sieved.energy_greatest);
    const auto inside = static_cast<double>(is_extreme(objective_) ? 1 : last - first);
    const auto asked = static_cast<double>(is_extreme(objective_) ? 1 : levels_.size());
    const double answer = answer_cost(*kind, m, objective_, options_);
    cost.outside = whole(outside_level);
    cost.inside = whole(answer);
    cost.answers = whole(inside * answer + (asked - inside) * outside_level);
    return cost;
}

}  // namespace nsma
