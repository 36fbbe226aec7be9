#include "search.hpp"

#include <algorithm>
#include <cmath>

#include "restore.hpp"

namespace nsma {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// Unknowns beyond which SLSQP, whose steps cost their cube, is left to the augmented Lagrangian with L-BFGS, and a
// quarter of the starts is made, each of which costs as much as all of a small program.
constexpr Eigen::Index slsqp_limit = 64;
// Objectives are compared relative to the greater one, at least to this share of the level: that of an orbit found
// again is zero but for rounding.
constexpr double objective_floor = 1e-6;
constexpr double bound_rounding = 1e-9;  // relative; a thousandth of what `global` allows
constexpr int most_pieces = 64;
// Half the side of the box within which a solver is asked about an optimum; the level is a sphere of radius one.
constexpr double ask_box = 0.1;

// Number of the start that OrbitRequest::start gives.
constexpr int warm_start = -1;

}  // namespace

bool ipopt_is_usual(const OrbitSolverOptions& options) {
    return options.solvers == SolverChoice::ipopt || options.solvers == SolverChoice::both;
}

double Goal::value(const Eigen::VectorXd& gamma) const {
    return objective_of_waves(problem.kernel, objective, problem.set.reduction.beta(gamma), reference);
}

double Goal::rank(const Eigen::VectorXd& gamma) const {
    return objective == Objective::max_energy ? -value(gamma) : value(gamma);
}

Search::Search(const OrbitSolverOptions& options, IpoptSolver& ipopt, const PatternProblem& problem,
               const OrbitRequest& request, const Goal& goal, double least_energy,
               const std::optional<Candidate>& known)
    : options_(options),
      ipopt_solver_(ipopt),
      problem_(problem),
      goal_(goal),
      floor_(objective_floor * request.level.value_or(least_energy)),
      program_(orbit_program(problem.set.reduction, problem.kernel, goal.objective, request.level, least_energy,
                             goal.reference)),
      with_ipopt_(options.solvers != SolverChoice::nlopt),
      with_nlopt_(options.solvers != SolverChoice::ipopt),
      starts_(options.starts) {
    if (request.level) level_.emplace(problem.set, *request.level);
    if (level_ && request.start.size() > 0) warm_ = level_->reach(problem.set.reduction.gamma(request.start));
    if (program_.program.variables() > slsqp_limit) starts_ = (starts_ + 3) / 4;
    if (!known) return;
    unaided_.usable = unaided_.known = true;
    unaided_.candidate = *known;
    unaided_.rank = goal.rank(known->gamma);
    unaided_.optimality = {goal.value(known->gamma), 0.0, true, 0.0};
}

std::optional<Best> Search::first_proof() {
    if (auto point = segment(); point && point->usable) {
        if (point->optimality.global) return point;
        unaided_ = std::move(*point);
    }
    search_with_nlopt();
    settle();
    for (const Best* best : ranked()) {
        if (best->optimality.global) return *best;
    }
    return std::nullopt;
}

void Search::run() {
    if (with_nlopt_ && nlopt_.run.name.empty()) search_with_nlopt();
    if (with_ipopt_) search_with_ipopt();
    if (with_nlopt_ && with_ipopt_) {
        if (ipopt_.usable && !not_worse(nlopt_, ipopt_)) search_with_nlopt();
        ask(nlopt_, ipopt_, "ipopt");
        ask(ipopt_, nlopt_, "nlopt");
    }
    settle();
}

std::optional<Eigen::VectorXd> Search::start(int k) const {
    if (k == warm_start) return warm_;
    if (level_) return level_->start(k);
    const auto& vertices = problem_.set.vertices;
    if (vertices.empty()) return problem_.set.least;
    return vertices[static_cast<std::size_t>(k) % vertices.size()];
}

int Search::ipopt_start() const { return warm_ ? warm_start : 0; }

// A point on the level a part of the way from `gamma` to start k.
std::optional<Eigen::VectorXd> Search::aside_of(const Eigen::VectorXd& gamma, double part, int k) const {
    const auto other = start(k);
    if (!other) return std::nullopt;
    Eigen::VectorXd aside = (1 - part) * gamma + part * *other;
    return level_ ? level_->reach(aside) : std::optional(std::move(aside));
}

// NLopt is some twenty times cheaper a call, so it does the search among local optima.
void Search::search_with_nlopt() {
    for (int k = 0; k < starts_ && !settled(nlopt_); ++k, ++next_) {
        const auto begin = start(next_);
        if (!begin) return;
        attempt(*begin, "nlopt", next_, nlopt_);
    }
}

// Starts elsewhere, and goes on to further starts only while Ipopt holds a worse optimum.
void Search::search_with_ipopt() {
    for (int k = 0; k < starts_ && !settled(ipopt_); ++k) {
        const int number = ipopt_.run.name.empty() ? ipopt_start() : next_++;
        const auto begin = start(number);
        if (!begin) return;
        // Where the orbit of another level leads nowhere, the first point of this one is still due.
        if (!attempt(*begin, "ipopt", number, ipopt_) && number == warm_start) {
            if (const auto first = start(0)) attempt(*first, "ipopt", 0, ipopt_);
        }
        if (with_nlopt_ && nlopt_.usable && not_worse(ipopt_, nlopt_)) return;
    }
}

// Does the solver, started off to the side of an optimum better than its own, come to it?
void Search::ask(const Best& better, Best& worse, const char* solver) {
    for (const double part : {0.1, 0.03, 0.01, 0.0}) {
        if (!better.usable || not_worse(worse, better)) return;
        const int number = next_++;
        const auto aside = aside_of(better.candidate.gamma, part, number);
        if (!aside) continue;
        if (!attempt(*aside, solver, number, worse) || !not_worse(worse, better)) {
            // It may leap out of a small piece of the level: once more within a box around the optimum.
            const Eigen::VectorXd centre = program_.point(better.candidate.gamma);
            Program boxed = program_.program;
            boxed.lower = boxed.lower.cwiseMax((centre.array() - ask_box).matrix());
            boxed.upper = boxed.upper.cwiseMin((centre.array() + ask_box).matrix());
            attempt(*aside, solver, number, worse, &boxed);
        }
    }
}

// Solvers used so far are asked about a best orbit that is not theirs; then every orbit is judged by the best bound.
void Search::settle() {
    if (ranked().empty()) return;
    const Best* const best = ranked().front();
    if (unsolved(best)) {
        if (!ipopt_.run.name.empty()) ask(*best, ipopt_, "ipopt");
        if (!nlopt_.run.name.empty()) ask(*best, nlopt_, "nlopt");
    }
    double value = -infinity;
    for (const Best* one : ranked()) {  // bounds are of the program, not of the point
        if (one->optimality.lower_bound && program_.objective_unit > 0) {
            value = std::max(value, *one->optimality.lower_bound / program_.objective_unit);
        }
    }
    if (value == -infinity) return;
    for (Best* one : {&ipopt_, &nlopt_, &unaided_}) {
        if (one->usable && !one->known)
            set_bound(program_.program.objective(program_.point(one->candidate.gamma)), value, one->optimality);
    }
}

SolverOutcome Search::call(const std::string& solver, const Program& program, const Eigen::VectorXd& x) {
    if (solver == "nlopt-slsqp") return solve_with_nlopt(NloptMethod::slsqp, program, x, options_.solver);
    if (solver == "nlopt-auglag") return solve_with_nlopt(NloptMethod::auglag_lbfgs, program, x, options_.solver);
    return ipopt_solver_.solve(program, x);
}

// One start of one solver, restored, polished and ranked; false when it is not usable. `posed`: a part of the program.
// "nlopt" stands for SLSQP, then the augmented Lagrangian.
bool Search::attempt(const Eigen::VectorXd& start, const std::string& solver, int number, Best& best,
                     const Program* posed) {
    if (solver == "nlopt") {
        const bool small = program_.program.variables() <= slsqp_limit;
        return (small && attempt(start, "nlopt-slsqp", number, best, posed)) ||
               attempt(start, "nlopt-auglag", number, best, posed);
    }
    const SolverOutcome outcome = call(solver, posed != nullptr ? *posed : program_.program, program_.point(start));
    SolverRun run;
    run.name = solver;
    run.start = number;
    run.status = outcome.status;
    run.iterations = outcome.iterations;
    run.seconds = outcome.seconds;
    run.violation = program_.program.violation(outcome.x);
    run.objective = std::numeric_limits<double>::quiet_NaN();

    Best trial;
    if (run.violation <= options_.raw_violation) {
        if (const auto near = restored(program_, problem_.set, level_ ? &*level_ : nullptr, outcome.x)) {
            trial = found(polish(program_.program, program_.point(*near)), solver.c_str());
        }
    }
    run.usable = trial.usable;
    if (run.usable) run.objective = goal_.value(trial.candidate.gamma);
    trial.run = run;
    const bool better = trial.usable && (!best.usable || preferable(trial, best));
    if (better || best.run.name.empty()) std::swap(best, trial);
    if (!trial.run.name.empty()) others_.push_back(trial.run);
    return run.usable;
}

// A polished point with the bound that its Lagrangian gives.
Best Search::found(const Polished& polished, const char* method) const {
    Best result;
    if (!polished.feasible) return result;
    result.usable = true;
    result.candidate = {program_.gamma(polished.x), method};
    result.rank = goal_.rank(result.candidate.gamma);
    result.optimality.kkt_residual = polished.multipliers.residual;
    set_bound(polished.objective, polished.stationary ? polished.lower_bound : 0.0, result.optimality);
    return result;
}

std::optional<Best> Search::segment() {
    std::optional<Best> best;
    const int pieces = level_ ? std::min(level_->pieces(), most_pieces) : 0;
    for (int k = 0; k < std::max(pieces, 1); ++k) {
        const auto begin = start(k);
        if (!begin) break;
        Best one = found(polish(program_.program, program_.point(*begin)), "segment");
        if (!one.usable) {
            one.candidate = {*begin, "segment"};
            one.rank = goal_.rank(*begin);
        }
        if (!best || (one.usable && (!best->usable || preferable(one, *best)))) best = std::move(one);
        if (best->optimality.global) break;
    }
    return best;
}

// `objective` and `bound` in the scale of the program.
void Search::set_bound(double objective, double bound, Optimality& result) const {
    // Rounding may put a tight bound just above the value it bounds; one further above bounds nothing.
    const double floor = floor_ / program_.objective_unit;
    if (bound > objective + bound_rounding * std::max(std::abs(objective), floor)) return;
    bound = std::min(std::max(bound, 0.0), std::max(objective, 0.0));  // no objective at a level is below zero
    result.lower_bound = bound * program_.objective_unit;
    result.gap = std::max(objective - bound, 0.0) / std::max(std::abs(objective), floor);
    result.global = result.gap <= options_.agreement_tolerance;
}

double Search::difference(const Best& a, const Best& b) const {
    return std::abs(a.rank - b.rank) / std::max({std::abs(a.rank), std::abs(b.rank), floor_});
}

// The lower objective; of those that agree, the closed form, else the one that is proved.
bool Search::preferable(const Best& a, const Best& b) const {
    if (a.known != b.known && difference(a, b) <= options_.agreement_tolerance) return a.known;
    const bool proved = a.optimality.global;
    if (proved != b.optimality.global && difference(a, b) <= options_.agreement_tolerance) return proved;
    return a.rank < b.rank;
}

bool Search::not_worse(const Best& a, const Best& b) const {
    return a.usable && (a.rank <= b.rank || difference(a, b) <= options_.agreement_tolerance);
}

// Nothing better is left to be found.
bool Search::settled(const Best& best) const {
    return best.optimality.global || (unaided_.known && not_worse(best, unaided_));
}

bool Search::a_solver_came_to(const Best& best) const { return not_worse(ipopt_, best) || not_worse(nlopt_, best); }

std::optional<double> Search::difference() const {
    if (!ipopt_.usable || !nlopt_.usable) return std::nullopt;
    return difference(ipopt_, nlopt_);
}

Agreement Search::agreement() const {
    if (!with_ipopt_ || !with_nlopt_) {
        return (with_ipopt_ ? ipopt_ : nlopt_).usable ? Agreement::single : Agreement::both_failed;
    }
    if (const auto apart = difference()) {
        return *apart <= options_.agreement_tolerance ? Agreement::agree : Agreement::different_optimum;
    }
    return ipopt_.usable || nlopt_.usable ? Agreement::one_failed : Agreement::both_failed;
}

std::vector<SolverRun> Search::runs() const {
    std::vector<SolverRun> all;
    for (const Best* best : {&ipopt_, &nlopt_}) {
        if (!best->run.name.empty()) all.push_back(best->run);
    }
    all.insert(all.end(), others_.begin(), others_.end());
    return all;
}

std::vector<const Best*> Search::ranked() const {
    std::vector<const Best*> all;
    for (const Best* best : {&ipopt_, &nlopt_, &unaided_}) {
        if (best->usable) all.push_back(best);
    }
    std::stable_sort(all.begin(), all.end(), [this](const Best* a, const Best* b) { return preferable(*a, *b); });
    return all;
}

}  // namespace nsma
