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
    const auto whole = [](double cost) { return std::llround(cost); };
    Cost cost;
    cost.verdict = whole(decided);
    if (sieved.finding != Finding::admissible || m > max_unknowns) return cost;
    cost.verdict = whole(decided + 2 * m * m);
    const auto kind = pattern_kind(pattern);
    if (!is_solved(all_kinds_, kind)) return cost;
    const auto first = std::lower_bound(levels_.begin(), levels_.end(), sieved.energy_least);
    const auto last = sieved.unbounded ? levels_.end() : std::upper_bound(first, levels_.end(), sieved.energy_greatest);
    const std::int64_t inside = is_extreme(objective_) ? 1 : last - first;
    const std::int64_t asked = is_extreme(objective_) ? 1 : static_cast<std::int64_t>(levels_.size());
    cost.outside = whole(outside_level);
    cost.inside = whole(answer_cost(*kind, m, objective_, options_));
    cost.answers = inside * cost.inside + (asked - inside) * cost.outside;
    return cost;
}

}  // namespace nsma
