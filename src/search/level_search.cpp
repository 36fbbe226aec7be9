#include "level_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "numerics/polish.hpp"

namespace nsma {
namespace {

// Unknowns beyond which SLSQP, whose steps cost their cube, is left to the augmented Lagrangian with L-BFGS, and a
// quarter of the starts is made, each of which costs as much as all of a small program.
constexpr Eigen::Index slsqp_limit = 64;
// Share of the level below which an objective is taken for zero: that of an orbit found again is, but for rounding.
constexpr double objective_floor = 1e-6;
constexpr double bound_rounding = 1e-9;  // relative; a thousandth of what `global` allows
constexpr int most_pieces = 64;
// Half the side of the box within which a solver is challenged; the level is a sphere of radius one.
constexpr double challenge_box = 0.1;
// Number of the start that OrbitRequest::start gives.
constexpr int warm_start = -1;

}  // namespace

double Goal::value(const Eigen::VectorXd& gamma) const {
    return objective_of_waves(problem.kernel, objective, problem.set.reduction.beta(gamma), reference);
}

LevelSearch::LevelSearch(const OrbitSolverOptions& options, IpoptSolver& ipopt, const Goal& goal, double level,
                         const Eigen::VectorXd& start, std::optional<Candidate> known)
    : options_(options),
      ipopt_solver_(ipopt),
      goal_(goal),
      floor_(objective_floor * level),
      program_(orbit_program(goal.problem.set.reduction, goal.problem.kernel, goal.objective, level, goal.reference)),
      points_(goal.problem.set, level),
      starts_(options.starts),
      unaided_(std::move(known)) {
    if (start.size() > 0) warm_ = points_.reach(goal.problem.set.reduction.gamma(start));
    if (program_.program.variables() > slsqp_limit) starts_ = (starts_ + 3) / 4;
}

void LevelSearch::run_until_proved() {
    unaided_ = descend();
    if (unaided_ && unaided_->optimality.global) return;
    start_nlopt();
    challenge_with_best();
    share_bounds();
}

void LevelSearch::run() {
    if (uses(Solver::nlopt) && nlopt_.run.name.empty()) start_nlopt();
    if (uses(Solver::ipopt)) start_ipopt();
    if (uses(Solver::nlopt) && uses(Solver::ipopt)) {
        if (ipopt_.best && !reaches(nlopt_, *ipopt_.best)) start_nlopt();
        if (nlopt_.best) challenge(*nlopt_.best, Solver::ipopt);
        if (ipopt_.best) challenge(*ipopt_.best, Solver::nlopt);
    }
    challenge_with_best();
    share_bounds();
}

bool LevelSearch::uses(Solver solver) const {
    return options_.solvers != (solver == Solver::ipopt ? SolverChoice::nlopt : SolverChoice::ipopt);
}

std::optional<Eigen::VectorXd> LevelSearch::start(int number) const {
    return number == warm_start ? warm_ : points_.start(number);
}

// NLopt is some twenty times cheaper a call, so it does the search among local optima.
void LevelSearch::start_nlopt() {
    for (int k = 0; k < starts_ && !settled(nlopt_); ++k, ++next_) {
        const auto begin = start(next_);
        if (!begin) return;
        solve(program_.program, *begin, Solver::nlopt, next_);
    }
}

// Starts elsewhere, and goes on to further starts only while Ipopt holds a worse optimum.
void LevelSearch::start_ipopt() {
    for (int k = 0; k < starts_ && !settled(ipopt_); ++k) {
        const int number = k > 0 ? next_++ : warm_ ? warm_start : 0;
        const auto begin = start(number);
        if (!begin) return;
        // Where the orbit of another level leads nowhere, the first point of this one is still due.
        if (!solve(program_.program, *begin, Solver::ipopt, number) && number == warm_start) {
            if (const auto first = start(0)) solve(program_.program, *first, Solver::ipopt, 0);
        }
        if (nlopt_.best && reaches(ipopt_, *nlopt_.best)) return;
    }
}

// One start of one solver on the program or a part of it; false when the answer is not usable. NLopt is SLSQP, then the
// augmented Lagrangian.
bool LevelSearch::solve(const Program& program, const Eigen::VectorXd& start, Solver solver, int number) {
    const Eigen::VectorXd x = program_.point(start);
    if (solver == Solver::ipopt) return judge("ipopt", number, ipopt_solver_.solve(program, x), ipopt_);
    const auto solved_by = [&](const char* name, NloptMethod method) {
        return judge(name, number, solve_with_nlopt(method, program, x, options_.solver), nlopt_);
    };
    return (program.variables() <= slsqp_limit && solved_by("nlopt-slsqp", NloptMethod::slsqp)) ||
           solved_by("nlopt-auglag", NloptMethod::auglag_lbfgs);
}

// Restores, polishes and ranks a raw answer; false when it is not usable.
bool LevelSearch::judge(const char* method, int number, const SolverOutcome& outcome, Contender& contender) {
    Contender trial;
    SolverRun& run = trial.run;
    run.name = method;
    run.start = number;
    run.status = outcome.status;
    run.iterations = outcome.iterations;
    run.seconds = outcome.seconds;
    run.violation = program_.program.violation(outcome.x);
    if (run.violation <= options_.raw_violation) {
        if (const auto near = points_.restored(program_.gamma(outcome.x)))
            trial.best = polished(*near, Candidate::Origin::solver, method);
    }
    run.usable = trial.best.has_value();
    run.objective = trial.best ? trial.best->objective : std::numeric_limits<double>::quiet_NaN();
    const bool usable = run.usable;
    const bool better = trial.best && (!contender.best || preferable(*trial.best, *contender.best));
    if (better || contender.run.name.empty()) std::swap(contender, trial);
    if (!trial.run.name.empty()) others_.push_back(trial.run);
    return usable;
}

// Does the solver, started off to the side of an optimum better than its own, come to it?
void LevelSearch::challenge(const Candidate& better, Solver solver) {
    const Contender& contender = solver == Solver::ipopt ? ipopt_ : nlopt_;
    for (const double part : {0.1, 0.03, 0.01, 0.0}) {
        if (reaches(contender, better)) return;
        const int number = next_++;
        const auto other = start(number);
        if (!other) continue;
        const auto aside = points_.reach((1 - part) * better.gamma + part * *other);
        if (!aside) continue;
        if (solve(program_.program, *aside, solver, number) && reaches(contender, better)) continue;
        // It may leap out of a small piece of the level: once more within a box around the optimum.
        const Eigen::VectorXd centre = program_.point(better.gamma);
        Program boxed = program_.program;
        boxed.lower = boxed.lower.cwiseMax((centre.array() - challenge_box).matrix());
        boxed.upper = boxed.upper.cwiseMin((centre.array() + challenge_box).matrix());
        solve(boxed, *aside, solver, number);
    }
}

// The solvers used so far come to a best orbit that is not theirs, or do not.
void LevelSearch::challenge_with_best() {
    const auto all = ranked();
    if (all.empty() || all.front()->origin == Candidate::Origin::solver) return;
    if (!ipopt_.run.name.empty()) challenge(*all.front(), Solver::ipopt);
    if (!nlopt_.run.name.empty()) challenge(*all.front(), Solver::nlopt);
}

// Bounds are of the program, not of the point: every candidate is judged by the best of them.
void LevelSearch::share_bounds() {
    double bound = 0;  // of every objective at a level
    for (const Candidate* one : ranked()) {
        bound = std::max(bound, one->optimality.lower_bound.value_or(0.0) / program_.objective_unit);
    }
    for (auto* one : {&ipopt_.best, &nlopt_.best, &unaided_}) {
        if (!*one || (*one)->origin == Candidate::Origin::closed_form) continue;
        set_bound(program_.program.objective(program_.point((*one)->gamma)), bound, (*one)->optimality);
    }
}

// A point of the level polished, with the bound that its Lagrangian gives.
std::optional<Candidate> LevelSearch::polished(const Eigen::VectorXd& gamma, Candidate::Origin origin,
                                               const char* method) const {
    const Polished end = polish(program_.program, program_.point(gamma));
    if (!end.feasible) return std::nullopt;
    Candidate result{program_.gamma(end.x), origin, method, 0.0, {}};
    result.objective = goal_.value(result.gamma);
    result.optimality.kkt_residual = end.multipliers.residual;
    set_bound(end.objective, end.lower_bound, result.optimality);
    return result;
}

std::optional<Candidate> LevelSearch::descend() const {
    std::optional<Candidate> best;
    const int pieces = std::clamp(points_.pieces(), 1, most_pieces);
    for (int k = 0; k < pieces; ++k) {
        const auto begin = points_.start(k);
        if (!begin) break;
        auto one = polished(*begin, Candidate::Origin::descent, "segment");
        if (one && (!best || preferable(*one, *best))) best = std::move(one);
        if (best && best->optimality.global) break;
    }
    return best;
}

// `objective` and `bound` in the scale of the program.
void LevelSearch::set_bound(double objective, double bound, Optimality& result) const {
    // Rounding may put a tight bound just above the value it bounds; one further above bounds nothing.
    const double scale = std::max(std::abs(objective), floor_ / program_.objective_unit);
    if (bound > objective + bound_rounding * scale) return;
    bound = std::min(std::max(bound, 0.0), std::max(objective, 0.0));  // no objective at a level is below zero
    result.lower_bound = bound * program_.objective_unit;
    result.gap = std::max(objective - bound, 0.0) / scale;
    result.global = result.gap <= agreement_tolerance;
}

double LevelSearch::difference(const Candidate& a, const Candidate& b) const {
    return std::abs(a.objective - b.objective) / std::max({std::abs(a.objective), std::abs(b.objective), floor_});
}

// The lower objective; of those that agree, the closed form, else the one that is proved.
bool LevelSearch::preferable(const Candidate& a, const Candidate& b) const {
    const bool known = a.origin == Candidate::Origin::closed_form;
    const bool proved = a.optimality.global;
    if (difference(a, b) <= agreement_tolerance) {
        if (known != (b.origin == Candidate::Origin::closed_form)) return known;
        if (proved != b.optimality.global) return proved;
    }
    return a.objective < b.objective;
}

bool LevelSearch::reaches(const Contender& contender, const Candidate& best) const {
    return contender.best &&
           (contender.best->objective <= best.objective || difference(*contender.best, best) <= agreement_tolerance);
}

// Nothing better is left to be found.
bool LevelSearch::settled(const Contender& contender) const {
    if (contender.best && contender.best->optimality.global) return true;
    return unaided_ && unaided_->origin == Candidate::Origin::closed_form && reaches(contender, *unaided_);
}

bool LevelSearch::a_solver_came_to(const Candidate& best) const {
    return reaches(ipopt_, best) || reaches(nlopt_, best);
}

std::optional<double> LevelSearch::difference() const {
    if (!ipopt_.best || !nlopt_.best) return std::nullopt;
    return difference(*ipopt_.best, *nlopt_.best);
}

Agreement LevelSearch::agreement() const {
    const int usable = (ipopt_.best ? 1 : 0) + (nlopt_.best ? 1 : 0);
    if (usable == 0) return Agreement::both_failed;
    if (!uses(Solver::ipopt) || !uses(Solver::nlopt)) return Agreement::single;
    if (usable == 1) return Agreement::one_failed;
    return *difference() <= agreement_tolerance ? Agreement::agree : Agreement::different_optimum;
}

std::vector<SolverRun> LevelSearch::runs() const {
    std::vector<SolverRun> all;
    for (const Contender* one : {&ipopt_, &nlopt_}) {
        if (!one->run.name.empty()) all.push_back(one->run);
    }
    all.insert(all.end(), others_.begin(), others_.end());
    return all;
}

std::vector<const Candidate*> LevelSearch::ranked() const {
    std::vector<const Candidate*> all;
    for (const auto* one : {&ipopt_.best, &nlopt_.best, &unaided_}) {
        if (*one) all.push_back(&**one);
    }
    std::stable_sort(all.begin(), all.end(),
                     [this](const Candidate* a, const Candidate* b) { return preferable(*a, *b); });
    return all;
}

}  // namespace nsma
