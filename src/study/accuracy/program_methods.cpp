#include "program_methods.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>

#include <fmt/format.h>

#include "numerics/polish.hpp"

namespace nsma {
namespace {

using Kind = ProgramMethod::Kind;

constexpr double best_tolerance = 1e-6;  // relative: the cross-check's own
constexpr double warm_level = 1.02;
constexpr int reference_starts = 16;  // the reference may cost more than any method
constexpr int pose_repeats = 5;
constexpr int ipopt_iterations = 500;
constexpr int nlopt_iterations = 2'000;  // of ten evaluations each

enum class Claim { answer, limit, none };

// What the last word of a library claims.
Claim claim_of(const std::string& status) {
    static const std::map<std::string, Claim> claims{{"Solve_Succeeded", Claim::answer},
                                                     {"Solved_To_Acceptable_Level", Claim::answer},
                                                     {"Feasible_Point_Found", Claim::answer},
                                                     {"SUCCESS", Claim::answer},
                                                     {"STOPVAL_REACHED", Claim::answer},
                                                     {"FTOL_REACHED", Claim::answer},
                                                     {"XTOL_REACHED", Claim::answer},
                                                     {"Maximum_Iterations_Exceeded", Claim::limit},
                                                     {"Maximum_CpuTime_Exceeded", Claim::limit},
                                                     {"Time_Limit_Exceeded", Claim::limit},
                                                     {"MAXEVAL_REACHED", Claim::limit},
                                                     {"MAXTIME_REACHED", Claim::limit}};
    const auto found = claims.find(status);
    return found == claims.end() ? Claim::none : found->second;
}

NloptMethod nlopt_method(Kind kind) {
    switch (kind) {
        case Kind::auglag_lbfgs: return NloptMethod::auglag_lbfgs;
        case Kind::auglag_slsqp: return NloptMethod::auglag_slsqp;
        case Kind::cobyla: return NloptMethod::cobyla;
        case Kind::isres: return NloptMethod::isres;
        default: return NloptMethod::slsqp;
    }
}

// The Lagrangian of a polished point bounds the objective by itself.
bool certified(const Polished& polished) {
    return polished.feasible && polished.stationary &&
           polished.lower_bound >= polished.objective - best_tolerance * std::abs(polished.objective);
}

Outcome refusal(const Violations& v) {
    if (v.worst() <= replay_tolerance) return Outcome::other_motion;
    return v.energy >= std::max({v.cond1, v.cond2, v.cond3}) ? Outcome::off_level : Outcome::outside;
}

void judge(Trial& trial, const ProgramCase& on, const Orbit& orbit, bool stopped_by_limit) {
    const Replay judged = replay(orbit, on.level);
    const double value = objective_of_waves(on.problem.kernel, on.objective, orbit.beta, on.reference);
    trial.gap = std::abs(value - on.best) / std::abs(on.best);
    trial.violation = judged.violations.worst();
    if (judged.accepted) {
        trial.outcome = value <= on.best + best_tolerance * std::abs(on.best) ? Outcome::success : Outcome::worse;
    } else {
        trial.outcome = stopped_by_limit ? Outcome::limit : refusal(judged.violations);
    }
}

OrbitAnswer thorough_answer(const Bar& bar, const PatternProblem& problem, Objective objective, double level) {
    OrbitSolver solver({.solvers = SolverChoice::proof, .starts = reference_starts, .solver = {}});
    OrbitAnswer answer = solver.solve(bar, problem, {.level = level, .objective = objective});
    if (!answer.orbit) throw std::invalid_argument(fmt::format("level: expected an attainable one, got {}", level));
    return answer;
}

}  // namespace

std::string ProgramMethod::name() const {
    static constexpr std::array names{"both solvers", "default",      "segment", "Ipopt", "SLSQP",
                                      "AUGLAG+LBFGS", "AUGLAG+SLSQP", "COBYLA",  "ISRES"};
    return names.at(static_cast<std::size_t>(kind));
}

std::string ProgramMethod::setting() const {
    if (whole()) return kind == Kind::both ? "cross-checked" : "until proved";
    if (kind == Kind::segment) return "polish";
    return fmt::format("tol {:.0e}, {}{}", tolerance, polish ? "polish" : "raw", warm ? ", warm" : "");
}

std::vector<ProgramMethod> program_methods(bool quick) {
    std::vector<ProgramMethod> methods{{Kind::both}, {Kind::proof}, {Kind::segment}};
    const auto add = [&](Kind kind, const std::vector<double>& tolerances) {
        for (const double tolerance : tolerances) {
            for (const bool polish : {false, true}) {
                methods.push_back({kind, tolerance, polish});
                if (kind == Kind::ipopt) methods.push_back({kind, tolerance, polish, true});
            }
        }
    };
    const std::vector<double> many = quick ? std::vector{1e-4, 1e-10} : std::vector{1e-4, 1e-6, 1e-8, 1e-10, 1e-12};
    const std::vector<double> few = quick ? std::vector{1e-6} : std::vector{1e-4, 1e-7, 1e-10};
    add(Kind::ipopt, many);
    add(Kind::slsqp, many);
    add(Kind::auglag_lbfgs, few);
    add(Kind::auglag_slsqp, few);
    add(Kind::cobyla, few);
    add(Kind::isres, {quick ? 1e-2 : 1e-4});
    return methods;
}

std::vector<ProgramMethod> mapped_methods() {
    return {{Kind::both},
            {Kind::proof},
            {Kind::segment},
            {.kind = Kind::ipopt, .tolerance = 1e-10, .polish = false},
            {Kind::ipopt, 1e-10},
            {.kind = Kind::slsqp, .tolerance = 1e-10, .polish = false},
            {Kind::slsqp, 1e-10},
            {Kind::auglag_lbfgs, 1e-7},
            {Kind::auglag_slsqp, 1e-7},
            {Kind::cobyla, 1e-7}};
}

ProgramCase solved_case(const Bar& bar, const PatternProblem& problem, Objective objective, double level) {
    const Reduction& reduction = problem.set.reduction;
    Eigen::VectorXd reference;
    if (objective == Objective::nearest) {
        reference = reference_window(make_orbit(bar, problem.kernel, reduction.beta(problem.set.least)));
    }
    const auto pose = [&] { return orbit_program(reduction, problem.kernel, objective, level, reference); };
    const auto pose_and_start = [&] {
        (void)pose();
        (void)LevelPoints(problem.set, level).start(0);
    };
    const OrbitAnswer answer = thorough_answer(bar, problem, objective, level);
    ProgramCase on{bar, problem, objective, level, reference, pose(), LevelPoints(problem.set, level)};
    on.pose_seconds = repeated(pose_repeats, [&] { return cpu_seconds_of(pose_and_start); }).median;
    on.best = *answer.objective_value;
    on.proved = proved_best(answer);
    on.best_x = on.program.point(reduction.gamma(answer.orbit->beta));
    return on;
}

Eigen::VectorXd warm_start(const ProgramCase& on) {
    const EnergyInterval& interval = on.problem.interval;
    // Upward unless that leaves the interval.
    const bool up = interval.unbounded || on.level * warm_level < interval.greatest.value_or(0.0);
    const double near = up ? on.level * warm_level : on.level / warm_level;
    if (near < interval.least.value_or(0.0)) return on.best_x;
    const OrbitAnswer neighbour = thorough_answer(on.bar, on.problem, on.objective, near);
    const auto reached = on.points.reach(on.problem.set.reduction.gamma(neighbour.orbit->beta));
    return reached ? on.program.point(*reached) : on.best_x;
}

MethodRuns counted(const ProgramCase& on, const std::string& method, const std::vector<Trial>& trials) {
    MethodRuns runs;
    runs.pattern = on.problem.kernel.pattern;
    runs.size = on.problem.kernel.dimension();
    runs.method = method;
    runs.proved = on.proved;
    std::vector<double> iterations;
    for (const Trial& trial : trials) {
        ++runs.runs;
        runs.reported += trial.reported;
        runs.false_success += trial.reported && trial.outcome != Outcome::success;
        runs.certified += trial.certified;
        ++runs.outcomes.at(static_cast<std::size_t>(trial.outcome));
        iterations.push_back(trial.iterations);
    }
    runs.iterations = spread(iterations).median;
    return runs;
}

MethodRunner::MethodRunner(const ProgramMethod& method, double time_limit)
    : method_(method),
      options_{.tolerance = method.tolerance,
               .max_iterations = method.kind == Kind::ipopt ? ipopt_iterations : nlopt_iterations,
               .time_limit = time_limit},
      orbit_solver_({.solvers = method.kind == Kind::both ? SolverChoice::both : SolverChoice::proof, .solver = {}}),
      ipopt_(options_) {}

Trial MethodRunner::run(const ProgramCase& on, const Program& posed, const Eigen::VectorXd& start) {
    if (method_.whole()) return run_whole(on);
    Trial trial;
    const double seconds = cpu_seconds_of([&] { trial = run_posed(on, posed, start); });
    trial.seconds = on.pose_seconds + seconds;
    return trial;
}

Trial MethodRunner::run_whole(const ProgramCase& on) {
    Trial trial;
    OrbitAnswer answer;
    trial.seconds = cpu_seconds_of(
        [&] { answer = orbit_solver_.solve(on.bar, on.problem, {.level = on.level, .objective = on.objective}); });
    for (const auto& one : answer.solvers) trial.iterations += one.iterations;
    trial.reported = answer.verdict == Verdict::admissible;
    trial.certified = proved_best(answer);
    if (answer.orbit) judge(trial, on, *answer.orbit, false);  // not timed: it has replayed its answer already
    return trial;
}

Trial MethodRunner::run_posed(const ProgramCase& on, const Program& posed, const Eigen::VectorXd& start) {
    const SolverOutcome raw = solve(posed, start);
    const Claim claim = claim_of(raw.status);
    Trial trial;
    trial.iterations = raw.iterations;
    trial.reported = claim == Claim::answer;
    if (raw.x.size() != on.program.program.variables() || !raw.x.allFinite()) return trial;
    Eigen::VectorXd gamma = on.program.gamma(raw.x);
    const auto near = method_.polish ? on.points.restored(gamma) : std::nullopt;
    if (near) {
        const Polished polished = polish(on.program.program, on.program.point(*near));
        if (polished.feasible) gamma = on.program.gamma(polished.x);
        trial.certified = certified(polished);
        if (method_.kind == Kind::segment) {
            trial.reported = polished.feasible && polished.stationary;
            trial.iterations = polished.steps;
        }
    }
    judge(trial, on, make_orbit(on.bar, on.problem.kernel, on.problem.set.reduction.beta(gamma)),
          claim == Claim::limit);
    return trial;
}

SolverOutcome MethodRunner::solve(const Program& posed, const Eigen::VectorXd& start) {
    if (method_.kind == Kind::segment) return {start, "", 0, 0.0};
    if (method_.kind == Kind::ipopt) return ipopt_.solve(posed, start);
    return solve_with_nlopt(nlopt_method(method_.kind), posed, start, options_);
}

}  // namespace nsma
