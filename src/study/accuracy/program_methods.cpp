#include "program_methods.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <set>
#include <stdexcept>

#include "guarded_solver.hpp"
#include "numerics/polish.hpp"
#include "search/restore.hpp"

namespace nsma {
namespace {

constexpr double best_tolerance = 1e-6;  // relative: the cross-check's own
constexpr double warm_level = 1.02;
constexpr int reference_starts = 16;  // the reference may cost more than any method
constexpr int pose_repeats = 5;
constexpr int ipopt_iterations = 500;
constexpr int nlopt_evaluations = 20'000;

// Which words of the libraries claim an answer.
bool claims_success(const std::string& status) {
    static const std::set<std::string> words{"Solve_Succeeded",      "Solved_To_Acceptable_Level",
                                             "Feasible_Point_Found", "SUCCESS",
                                             "STOPVAL_REACHED",      "FTOL_REACHED",
                                             "XTOL_REACHED"};
    return words.count(status) > 0;
}

bool stopped_by_limit(const std::string& status) {
    static const std::set<std::string> words{"Maximum_Iterations_Exceeded",
                                             "Maximum_CpuTime_Exceeded",
                                             "Time_Limit_Exceeded",
                                             "MAXEVAL_REACHED",
                                             "MAXTIME_REACHED",
                                             "KILLED"};
    return words.count(status) > 0;
}

Outcome refusal(const Replay& judged, const std::string& status) {
    if (stopped_by_limit(status)) return Outcome::limit;
    const Violations& v = judged.violations;
    if (v.worst() <= replay_tolerance) return Outcome::other_motion;
    return v.energy >= std::max({v.cond1, v.cond2, v.cond3}) ? Outcome::off_level : Outcome::outside;
}

// The Lagrangian of a polished point bounds the objective by itself.
bool certified(const Polished& polished) {
    return polished.feasible && polished.stationary &&
           polished.lower_bound >= polished.objective - best_tolerance * std::abs(polished.objective);
}

double quartile(const std::vector<double>& sorted, double share) {
    const double place = share * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

std::string_view name(Outcome outcome) {
    static constexpr std::array<std::string_view, outcome_count> names{
        "success", "worse", "off-level", "outside", "other-motion", "not-finite", "limit"};
    return names.at(static_cast<std::size_t>(outcome));
}

std::string_view description(Outcome outcome) {
    static constexpr std::array<std::string_view, outcome_count> lines{
        "replayed within 1e-9 and within 1e-6 of the best objective",
        "replayed within 1e-9, but a worse orbit: a local optimum or an early stop",
        "replay refuses: the energy is not the level asked",
        "replay refuses: COND1, COND2 or COND3 is violated",
        "replay refuses: the marcher sees contact at other steps",
        "no point came back, or one with NaN",
        "stopped by its limit of time or evaluations before its point was good"};
    return lines.at(static_cast<std::size_t>(outcome));
}

Spread spread(std::vector<double> values) {
    if (values.empty()) throw std::invalid_argument("values: expected at least one, got none");
    std::sort(values.begin(), values.end());
    return {quartile(values, 0.5), quartile(values, 0.25), quartile(values, 0.75)};
}

double cpu_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::string ProgramMethod::setting() const {
    if (whole()) return kind == Kind::both ? "cross-checked" : "until proved";
    if (kind == Kind::segment) return "polish";
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "tol %.0e", tolerance);
    return std::string(text.data()) + (polish ? ", polish" : ", raw") + (warm ? ", warm" : "");
}

std::vector<ProgramMethod> program_methods(bool quick) {
    using Kind = ProgramMethod::Kind;
    std::vector<ProgramMethod> methods;
    methods.push_back({Kind::both, NloptMethod::slsqp, "both solvers", 0, true, false});
    methods.push_back({Kind::proof, NloptMethod::slsqp, "default", 0, true, false});
    methods.push_back({Kind::segment, NloptMethod::slsqp, "segment", 0, true, false});
    const std::vector<double> tolerances =
        quick ? std::vector{1e-4, 1e-10} : std::vector{1e-4, 1e-6, 1e-8, 1e-10, 1e-12};
    for (const double tolerance : tolerances) {
        for (const bool polish : {false, true}) {
            for (const bool warm : {false, true}) {
                methods.push_back({Kind::ipopt, NloptMethod::slsqp, "Ipopt", tolerance, polish, warm});
            }
        }
    }
    const auto add = [&](NloptMethod method, const char* label, const std::vector<double>& at) {
        for (const double tolerance : at) {
            for (const bool polish : {false, true}) {
                methods.push_back({Kind::nlopt, method, label, tolerance, polish, false});
            }
        }
    };
    add(NloptMethod::slsqp, "SLSQP", tolerances);
    const std::vector<double> few = quick ? std::vector{1e-6} : std::vector{1e-4, 1e-7, 1e-10};
    add(NloptMethod::auglag_lbfgs, "AUGLAG+LBFGS", few);
    add(NloptMethod::auglag_slsqp, "AUGLAG+SLSQP", few);
    add(NloptMethod::cobyla, "COBYLA", few);
    add(NloptMethod::isres, "ISRES", {quick ? 1e-2 : 1e-4});
    return methods;
}

std::vector<ProgramMethod> mapped_methods() {
    using Kind = ProgramMethod::Kind;
    return {{Kind::both, NloptMethod::slsqp, "both solvers", 0, true, false},
            {Kind::proof, NloptMethod::slsqp, "default", 0, true, false},
            {Kind::segment, NloptMethod::slsqp, "segment", 0, true, false},
            {Kind::ipopt, NloptMethod::slsqp, "Ipopt raw", 1e-10, false, false},
            {Kind::ipopt, NloptMethod::slsqp, "Ipopt", 1e-10, true, false},
            {Kind::nlopt, NloptMethod::slsqp, "SLSQP raw", 1e-10, false, false},
            {Kind::nlopt, NloptMethod::slsqp, "SLSQP", 1e-10, true, false},
            {Kind::nlopt, NloptMethod::auglag_lbfgs, "AUGLAG+LBFGS", 1e-7, true, false},
            {Kind::nlopt, NloptMethod::auglag_slsqp, "AUGLAG+SLSQP", 1e-7, true, false},
            {Kind::nlopt, NloptMethod::cobyla, "COBYLA", 1e-7, true, false}};
}

ProgramCase::ProgramCase(const Bar& the_bar, const PatternProblem& the_problem, Objective the_objective,
                         double the_level)
    : bar(the_bar),
      problem(the_problem),
      objective(the_objective),
      level(the_level),
      reference(objective == Objective::nearest
                    ? reference_window(make_orbit(bar, problem.kernel, problem.set.reduction.beta(problem.set.least)))
                    : Eigen::VectorXd()),
      program(orbit_program(problem.set.reduction, problem.kernel, objective, level,
                            problem.interval.least.value_or(1.0), reference)),
      points(problem.set, level) {
    OrbitSolverOptions thorough;
    thorough.solvers = SolverChoice::proof;
    thorough.starts = reference_starts;
    OrbitSolver solver(thorough);
    const auto gamma_at = [&](double at, OrbitAnswer& answer) {
        answer = solver.solve(bar, problem, {at, objective, {}, {}});
        if (!answer.orbit) throw std::invalid_argument("level: expected an attainable one, got " + std::to_string(at));
        return problem.set.reduction.gamma(answer.orbit->beta);
    };
    pose_seconds = posing_seconds();
    OrbitAnswer answer;
    best_x = program.point(gamma_at(level, answer));
    best = *answer.objective_value;
    proved = answer.optimality && answer.optimality->global;
    // Upward unless that leaves the interval.
    const bool up = problem.interval.unbounded || level * warm_level < problem.interval.greatest.value_or(0.0);
    const double near = up ? level * warm_level : level / warm_level;
    warm_x = best_x;
    if (near < problem.interval.least.value_or(0.0)) return;
    OrbitAnswer neighbour;
    if (const auto reached = points.reach(gamma_at(near, neighbour))) warm_x = program.point(*reached);
}

double ProgramCase::posing_seconds() const {
    std::vector<double> seconds;
    for (int repeat = 0; repeat < pose_repeats; ++repeat) {
        const double begin = cpu_seconds();
        const OrbitProgram again = orbit_program(problem.set.reduction, problem.kernel, objective, level,
                                                 problem.interval.least.value_or(1.0), reference);
        const LevelPoints starts(problem.set, level);
        const auto start = starts.start(0);
        seconds.push_back(cpu_seconds() - begin);
    }
    return spread(std::move(seconds)).median;
}

MethodRunner::MethodRunner(const ProgramMethod& method, double time_limit) : method_(method) {
    options_.tolerance = method.tolerance;
    options_.time_limit = time_limit;
    options_.max_iterations = method.kind == ProgramMethod::Kind::ipopt ? ipopt_iterations : nlopt_evaluations / 10;
    OrbitSolverOptions whole;
    whole.solvers = method.kind == ProgramMethod::Kind::both ? SolverChoice::both : SolverChoice::proof;
    if (method.whole()) orbit_solver_ = std::make_unique<OrbitSolver>(whole);
    if (method.kind == ProgramMethod::Kind::ipopt) ipopt_ = std::make_unique<IpoptSolver>(options_);
}

SolverOutcome MethodRunner::call(const Program& posed, const Eigen::VectorXd& start) {
    if (method_.kind == ProgramMethod::Kind::segment) return {start, "segment", 0, 0.0};
    const double begin = cpu_seconds();
    SolverOutcome outcome;
    if (method_.kind == ProgramMethod::Kind::ipopt) {
        outcome = ipopt_->solve(posed, start);
    } else if (method_.nlopt == NloptMethod::cobyla || method_.nlopt == NloptMethod::isres) {
        return solve_guarded(method_.nlopt, posed, start, options_, 2 * options_.time_limit + 1);
    } else {
        outcome = solve_with_nlopt(method_.nlopt, posed, start, options_);
    }
    outcome.seconds = cpu_seconds() - begin;
    return outcome;
}

Trial MethodRunner::run(const ProgramCase& on, const Program& posed, const Eigen::VectorXd& start) {
    Trial trial;
    Eigen::VectorXd beta;
    std::optional<Orbit> orbit;
    if (method_.whole()) {
        const double begin = cpu_seconds();
        const OrbitAnswer answer = orbit_solver_->solve(on.bar, on.problem, {on.level, on.objective, {}});
        trial.seconds = cpu_seconds() - begin;
        trial.status = answer.method;
        for (const auto& one : answer.solvers) trial.iterations += one.iterations;
        trial.reported = answer.verdict == Verdict::admissible;
        trial.certified = answer.optimality && answer.optimality->global;
        orbit = answer.orbit;
    } else {
        const SolverOutcome outcome = call(posed, method_.warm ? on.warm_x : start);
        trial.seconds = on.pose_seconds + outcome.seconds;
        trial.status = outcome.status;
        trial.iterations = outcome.iterations;
        trial.reported = claims_success(outcome.status);
        if (outcome.x.size() == on.program.program.variables() && outcome.x.allFinite()) {
            Eigen::VectorXd gamma = on.program.gamma(outcome.x);
            if (method_.polish) {
                const double begin = cpu_seconds();
                if (const auto near = restored(on.program, on.problem.set, &on.points, outcome.x)) {
                    const Polished polished = polish(on.program.program, on.program.point(*near));
                    if (polished.feasible) gamma = on.program.gamma(polished.x);
                    trial.certified = certified(polished);
                    if (method_.kind == ProgramMethod::Kind::segment) {
                        trial.reported = polished.feasible && polished.stationary;
                        trial.iterations = polished.steps;
                    }
                }
                trial.seconds += cpu_seconds() - begin;
            }
            const double begin = cpu_seconds();
            orbit = make_orbit(on.bar, on.problem.kernel, on.problem.set.reduction.beta(gamma));
            trial.seconds += cpu_seconds() - begin;
        }
    }
    trial.gap = trial.violation = 1.0;
    if (!orbit) return trial;
    const double begin = cpu_seconds();
    const Replay judged = replay(*orbit, on.level);
    // The whole path has replayed its answer already; nobody else's is one before that.
    if (!method_.whole()) trial.seconds += cpu_seconds() - begin;
    const double value = objective_of_waves(on.problem.kernel, on.objective, orbit->beta, on.reference);
    trial.gap = std::abs(value - on.best) / std::abs(on.best);
    trial.violation = judged.violations.worst();
    if (!judged.accepted) {
        trial.outcome = refusal(judged, trial.status);
    } else {
        trial.outcome = value <= on.best + best_tolerance * std::abs(on.best) ? Outcome::success : Outcome::worse;
    }
    return trial;
}

}  // namespace nsma
