#include "nsma/program/orbit_solver.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "nsma/program/conic_bound.hpp"
#include "nsma/program/level_points.hpp"
#include "nsma/program/lifted_program.hpp"
#include "nsma/program/orbit_program.hpp"
#include "nsma/program/polish.hpp"
#include "nsma/program/restore.hpp"

namespace nsma {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// Two vertices whose energies differ by rounding only are the same end of the interval.
constexpr double tie_tolerance = 1e-13;
// Distance beyond a row, relative to the size of the point, that rounding explains.
constexpr double row_rounding = 1e-13;

// Unknowns beyond which a relaxation takes long enough to be counted eightfold.
constexpr int large_program = 10;
// Unknowns beyond which Ipopt comes to an optimum in less time than an active-set descent from a
// segment, which takes a step for each bound it meets (data/accuracy.md).
constexpr int segment_limit = 48;

bool is_extreme(Objective objective) {
    return objective == Objective::min_energy || objective == Objective::max_energy;
}

// An admissible point and how it was found.
struct Candidate {
    Eigen::VectorXd gamma;
    std::string method;
};

bool admissible_point(const Reduction& reduction, const Eigen::VectorXd& gamma) {
    const double tolerance = row_rounding * gamma.lpNorm<1>();
    for (Eigen::Index j = 0; j < gamma.size(); ++j) {
        if (reduction.bounded[static_cast<std::size_t>(j)] != 0 && gamma[j] < -tolerance) return false;
    }
    return reduction.rows.rows() == 0 ||
           (reduction.rows.cast<double>() * gamma).maxCoeff() <= tolerance;
}

// Both points at which a line meets the level, for a flat of dimension one.
std::vector<Eigen::VectorXd> line_points(const Reduction& reduction, double level) {
    const Eigen::VectorXd w = reduction.contact_row.cast<double>();
    const auto n = w.size();
    Eigen::VectorXd base = Eigen::VectorXd::Zero(n);
    Eigen::VectorXd direction = Eigen::VectorXd::Ones(n);
    if (w.squaredNorm() > 0) base = reduction.gap_sign * w / w.squaredNorm();
    if (n == 2) direction = Eigen::Vector2d(-w[1], w[0]).normalized();
    const double square = level / reduction.energy_factor - base.squaredNorm();
    std::vector<Eigen::VectorXd> points;
    if (square < 0) return points;
    for (const double side : {1.0, -1.0}) {
        Eigen::VectorXd point = base + side * std::sqrt(square) * direction;
        if (!admissible_point(reduction, point)) continue;
        for (Eigen::Index j = 0; j < n; ++j) {
            if (reduction.bounded[static_cast<std::size_t>(j)] != 0) point[j] = std::max(point[j], 0.0);
        }
        points.push_back(std::move(point));
    }
    return points;
}

class Solve {
public:
    Solve(const OrbitSolverOptions& options, IpoptSolver& ipopt, const Bar& bar,
          const PatternProblem& problem, const OrbitRequest& request)
        : options_(options), ipopt_(ipopt), bar_(bar), problem_(problem), request_(request),
          reduction_(problem.set.reduction) {}

    OrbitAnswer run() {
        answer_.pattern = problem_.kernel.pattern;
        answer_.gap_sign = bar_.gap_sign();
        answer_.kernel_dimension = problem_.kernel.dimension();
        answer_.verdict = problem_.verdict;
        answer_.reason = problem_.set.reason;
        answer_.interval = problem_.interval;
        answer_.verdict_proved = problem_.proof.verdict_proved;
        answer_.level = request_.level;
        answer_.objective = request_.objective;
        if (problem_.verdict == Verdict::admissible && level_verdict()) {
            answer_.reason.clear();
            find();
        }
        return std::move(answer_);
    }

private:
    // Sets below/above and returns false where the level is outside the interval.
    bool level_verdict() {
        if (!request_.level) {
            if (reduction_.gap_sign != 0 || is_extreme(request_.objective)) return true;
            answer_.verdict = Verdict::failed;
            answer_.reason = "a closed gap has no least-energy orbit: give an energy";
            return false;
        }
        const double level = *request_.level;
        if (level < *answer_.interval.least * (1 - options_.level_tolerance)) {
            answer_.verdict = Verdict::below;
            answer_.reason = "level below the least energy of the pattern";
            return false;
        }
        const auto& [least, greatest, bound, unbounded, least_exact, greatest_exact] = answer_.interval;
        if (unbounded || (greatest && level <= *greatest * (1 + options_.level_tolerance))) return true;
        answer_.verdict_proved = bound.has_value() && level > *bound * (1 + options_.level_tolerance);
        answer_.verdict = answer_.verdict_proved ? Verdict::above : Verdict::undecided;
        answer_.reason = answer_.verdict_proved
                             ? "level above the greatest energy of the pattern"
                             : "level above the greatest energy attained, below the proved bound";
        return false;
    }

    void find() {
        if (request_.objective == Objective::nearest && !set_reference()) return;
        if (closed_form()) return;
        optimise();
    }

    bool set_reference() {
        reference_ = request_.reference;
        if (reference_.size() > 0) return true;
        if (reduction_.gap_sign != 0) {
            const Orbit least = make_orbit(bar_, problem_.kernel, reduction_.beta(problem_.set.least));
            reference_ = reference_window(least);
            return true;
        }
        OrbitRequest first = request_;
        first.objective = Objective::least_shock;
        const OrbitAnswer smooth = Solve(options_, ipopt_, bar_, problem_, first).run();
        if (!smooth.orbit) {
            answer_.verdict = Verdict::failed;
            answer_.reason = "no reference orbit: " + smooth.reason;
            return false;
        }
        reference_ = reference_window(*smooth.orbit);
        return true;
    }

    // Orbits known without a solver: ends of the interval, points and segments.
    bool closed_form() {
        const auto& set = problem_.set;
        std::vector<Candidate> candidates;
        const auto add = [&](const Eigen::VectorXd& gamma, const char* method) {
            candidates.push_back({gamma, method});
        };
        if (!request_.level) {
            if (!is_extreme(request_.objective)) {
                add(set.least, "least-norm");
            } else if (reduction_.gap_sign == 0) {
                refuse_closed_gap_extreme();
                return true;
            } else if (request_.objective == Objective::max_energy && set.unbounded()) {
                answer_.verdict = Verdict::failed;
                answer_.reason = "the energy of this pattern is unbounded";
                return true;
            } else if (set.flat_dimension == 0) {
                add(set.least, "closed-form");
            }
        } else {
            const double level = *request_.level;
            const auto same = [&](double end) {
                return std::abs(level - end) <= options_.level_tolerance * end;
            };
            if (reduction_.gap_sign != 0 && same(*answer_.interval.least)) {
                add(set.least, "least-norm");
            } else if (answer_.interval.greatest && same(*answer_.interval.greatest)) {
                for (const auto& vertex : set.vertices) {
                    if (set.energy(vertex) >= *answer_.interval.greatest * (1 - tie_tolerance)) {
                        add(vertex, "vertex");
                    }
                }
            } else if (reduction_.gap_sign == 0 ? reduction_.variables() == 1 || set.flat_dimension == 1
                                                : set.flat_dimension == 1) {
                for (const auto& point : line_points(reduction_, level)) add(point, "closed-form");
            }
        }
        const Candidate* best = nullptr;
        double value = infinity;
        for (const auto& candidate : candidates) {
            const double objective = objective_value(candidate.gamma);
            if (objective < value) {
                value = objective;
                best = &candidate;
            }
        }
        if (best == nullptr) return false;
        answer_.agreement = Agreement::not_needed;
        accept(*best);
        // A point or the whole line was looked at; of the vertices at the greatest energy only
        // those known were.
        if (best->method != "vertex") answer_.optimality = Optimality{value, 0.0, true, 0.0, 0};
        return true;
    }

    void refuse_closed_gap_extreme() {
        answer_.verdict = Verdict::failed;
        answer_.reason = "a closed gap has orbits at every energy: no least and no greatest";
    }

    [[nodiscard]] double objective_value(const Eigen::VectorXd& gamma) const {
        return objective_of_waves(problem_.kernel, request_.objective, reduction_.beta(gamma), reference_);
    }

    // Lower is better, also for max_energy.
    [[nodiscard]] double rank(const Eigen::VectorXd& gamma) const {
        const double value = objective_value(gamma);
        return request_.objective == Objective::max_energy ? -value : value;
    }

    struct Best {
        double rank = infinity;
        Candidate candidate;
        SolverRun run;
        bool usable = false;
        bool global = false;
        Optimality optimality;
    };

    void optimise() {
        const auto& set = problem_.set;
        const OrbitProgram program =
            orbit_program(reduction_, problem_.kernel, request_.objective, request_.level,
                          answer_.interval.least.value_or(1.0), reference_);
        std::optional<LevelPoints> level;
        if (request_.level) level.emplace(set, *request_.level);
        const auto start = [&](int k) -> std::optional<Eigen::VectorXd> {
            if (level) return level->start(k);
            const auto& vertices = set.vertices;
            if (vertices.empty()) return set.least;
            return vertices[static_cast<std::size_t>(k) % vertices.size()];
        };

        const bool stop_at_proof = options_.solvers == SolverChoice::proof;
        const bool many_unknowns = reduction_.variables() > segment_limit;
        if (stop_at_proof && !many_unknowns && proved_segment(program, level, start(0))) return;

        Best ipopt;
        Best nlopt;
        const bool with_ipopt = options_.solvers != SolverChoice::nlopt;
        const bool with_nlopt = options_.solvers != SolverChoice::ipopt;
        std::vector<SolverRun> others;
        if (const auto begin = start(0); stop_at_proof && many_unknowns && begin) {
            attempt(program, level, *begin, "ipopt", 0, ipopt, others);
            if (accept_proved(ipopt, {ipopt.run}) || proved_segment(program, level, begin)) return;
        }
        // NLopt is some twenty times cheaper a call, so it does the search among local optima;
        // Ipopt starts elsewhere and goes on to further starts only while it holds a worse one.
        int next = 1;
        const auto search_with_nlopt = [&] {
            for (int k = 0; k < options_.starts && !nlopt.global; ++k, ++next) {
                const auto begin = start(next);
                if (!begin) return;
                if (!attempt(program, level, *begin, "nlopt-slsqp", next, nlopt, others)) {
                    attempt(program, level, *begin, "nlopt-auglag", next, nlopt, others);
                }
            }
        };
        if (with_nlopt) search_with_nlopt();
        if (stop_at_proof && nlopt.usable) {
            settle(program, level, nullptr, &nlopt, next, others);
            std::vector<SolverRun> runs{nlopt.run};
            runs.insert(runs.end(), others.begin(), others.end());
            if (accept_proved(nlopt, std::move(runs))) return;
        }
        for (int k = 0; with_ipopt && k < options_.starts && !ipopt.global; ++k) {
            const bool first = ipopt.run.name.empty();
            const int number = first ? 0 : next++;
            const auto begin = start(number);
            if (!begin) break;
            attempt(program, level, *begin, "ipopt", number, ipopt, others);
            if (with_nlopt && nlopt.usable && not_worse(ipopt, nlopt)) break;
        }
        if (with_nlopt && with_ipopt) {
            if (ipopt.usable && !not_worse(nlopt, ipopt)) search_with_nlopt();
            // Where one still holds a worse optimum it is asked about the better one: does it,
            // started off to the side, come to the same point?
            const auto ask = [&](const Best& better, Best& worse, const char* solver) {
                if (!better.usable || not_worse(worse, better)) return;
                const int number = next++;
                const auto aside = aside_of(better.candidate.gamma, level, start(number));
                if (aside) attempt(program, level, *aside, solver, number, worse, others);
            };
            ask(nlopt, ipopt, "ipopt");
            ask(ipopt, nlopt, "nlopt-slsqp");
        }

        settle(program, level, with_ipopt ? &ipopt : nullptr, with_nlopt ? &nlopt : nullptr, next, others);
        compare(with_ipopt, ipopt, with_nlopt, nlopt);
        if (with_ipopt && !ipopt.run.name.empty()) answer_.solvers.push_back(ipopt.run);
        if (with_nlopt && !nlopt.run.name.empty()) answer_.solvers.push_back(nlopt.run);
        answer_.solvers.insert(answer_.solvers.end(), others.begin(), others.end());

        std::vector<Best*> ranked;
        for (Best* best : {&ipopt, &nlopt}) {
            if (best->usable) ranked.push_back(best);
        }
        if (relaxed_.usable) ranked.push_back(&relaxed_);
        std::stable_sort(ranked.begin(), ranked.end(),
                         [this](const Best* a, const Best* b) { return preferable(*a, *b); });
        if (request_.objective == Objective::max_energy && take_vertex(ranked)) return;
        for (const Best* best : ranked) {
            accept(best->candidate);
            answer_.optimality = best->optimality;
            if (answer_.verdict != Verdict::admissible) continue;
            if (best == &relaxed_ && !not_worse(ipopt, relaxed_) && !not_worse(nlopt, relaxed_)) {
                no_solver_came("a relaxation");
            }
            return;
        }
        // Both failed: the segment still gives an orbit of this pattern at this level.
        if (const auto fallback = start(0)) {
            const Polished polished = polish(program.program, program.point(*fallback));
            accept({polished.feasible ? program.gamma(polished.x) : *fallback, "segment"});
            answer_.optimality = optimality_of(program, polished);
            if (answer_.verdict == Verdict::admissible) {
                answer_.reason = "no solver answer was usable: polished segment point";
            }
        }
    }

    // The kept orbit is better than what any solver holds: they do not agree about it.
    void no_solver_came(const std::string& origin) {
        if (answer_.agreement != Agreement::both_failed) answer_.agreement = Agreement::different_optimum;
        answer_.reason = "no solver came to the best orbit known, found by " + origin;
    }

    // The greatest energy is known from the proof of the interval; a solver may stop at a vertex
    // below it. Takes the greatest vertex known where no solver came to it, and judges the gap of
    // either by the proved bound.
    bool take_vertex(const std::vector<Best*>& ranked) {
        const auto& interval = answer_.interval;
        if (!interval.greatest || !interval.bound) return false;
        const auto& vertices = problem_.set.vertices;
        Candidate candidate;
        if (!vertices.empty()) candidate = {vertices.front(), "vertex"};
        if (!ranked.empty() && (vertices.empty() || ranked.front()->rank <= rank(vertices.front()) * (1 - options_.agreement_tolerance))) {
            candidate = ranked.front()->candidate;
        }
        if (candidate.method.empty()) return false;
        accept(candidate);
        if (candidate.method == "vertex" && !ranked.empty() &&
            ranked.front()->rank > rank(candidate.gamma) + options_.agreement_tolerance * std::abs(rank(candidate.gamma))) {
            no_solver_came("the vertex search");
        }
        Optimality optimality;
        optimality.gap = std::max(0.0, *interval.bound / *answer_.energy - 1);
        optimality.global = optimality.gap <= options_.agreement_tolerance;
        answer_.optimality = optimality;
        return answer_.verdict == Verdict::admissible;
    }

    // The point of a segment, polished: an answer without a solver where it is proved the best.
    bool proved_segment(const OrbitProgram& program, const std::optional<LevelPoints>& level,
                        const std::optional<Eigen::VectorXd>& start) {
        if (!start) return false;
        const Polished polished = polish(program.program, program.point(*start));
        if (!polished.feasible) return false;
        Best segment;
        segment.usable = true;
        segment.candidate = {program.gamma(polished.x), "segment"};
        segment.rank = rank(segment.candidate.gamma);
        segment.optimality = optimality_of(program, polished);
        segment.global = segment.optimality.global;
        return accept_proved(segment, {});
    }

    // Ends the search with an answer proved to be the best; false where it is not.
    bool accept_proved(const Best& best, std::vector<SolverRun> runs) {
        if (!best.usable || !best.global) return false;
        answer_.agreement = Agreement::not_needed;
        accept(best.candidate);
        answer_.optimality = best.optimality;
        answer_.solvers = std::move(runs);
        return answer_.verdict == Verdict::admissible;
    }

    // Where the Lagrangian leaves a gap: bounds the objective by relaxations, whose solutions are
    // starts that find better optima; the solvers are then asked about those.
    void settle(const OrbitProgram& program, const std::optional<LevelPoints>& level, Best* ipopt,
                Best* nlopt, int& next, std::vector<SolverRun>& others) {
        Best* best = ipopt;
        if (best == nullptr || (nlopt != nullptr && nlopt->usable && (!best->usable || preferable(*nlopt, *best)))) best = nlopt;
        if (options_.bound_nodes < 1 || !best->usable || best->global || !level) return;
        std::optional<Polished> better;
        double objective = program.program.objective(program.point(best->candidate.gamma));
        ConicBoundOptions bounding;
        const bool large = reduction_.variables() > large_program;
        bounding.node_limit = large ? (options_.bound_nodes + 7) / 8 : options_.bound_nodes;
        if (large) bounding.max_iterations = 2'000;
        bounding.improve = [&](const Eigen::VectorXd& x) {
            if (const auto near = restored(program, problem_.set, &*level, x)) {
                const Polished polished = polish(program.program, program.point(*near));
                if (polished.feasible && polished.objective < objective * (1 - options_.agreement_tolerance)) {
                    objective = polished.objective;
                    better = polished;
                }
            }
            return objective;
        };
        const ConicBound bound = conic_bound(program.program, objective, bounding);
        if (better) {
            relaxed_.usable = true;
            relaxed_.candidate = {program.gamma(better->x), "relaxation"};
            relaxed_.rank = rank(relaxed_.candidate.gamma);
            relaxed_.optimality = optimality_of(program, *better);
            for (Best* one : {ipopt, nlopt}) {
                if (one == nullptr) continue;
                const int number = next++;
                const auto aside = aside_of(relaxed_.candidate.gamma, level, level->start(number));
                if (aside) attempt(program, level, *aside, one == ipopt ? "ipopt" : "nlopt-slsqp", number, *one, others);
            }
        }
        for (Best* one : {ipopt, nlopt, &relaxed_}) {
            if (one == nullptr || !one->usable) continue;
            one->optimality.nodes = bound.nodes;
            const double value = program.program.objective(program.point(one->candidate.gamma));
            if (bound.value > -infinity) set_bound(program, value, bound.value, one->optimality);
            one->global = one->optimality.global;
        }
    }

    // Ipopt on the form of the program that its size prefers.
    [[nodiscard]] SolverOutcome solve_by_ipopt(const OrbitProgram& program, const Eigen::VectorXd& x) {
        if (!prefers_lifted(program, problem_.kernel)) return ipopt_.solve(program.program, x);
        const LiftedProgram lifted = lifted_program(program, reduction_, problem_.kernel);
        SolverOutcome outcome = ipopt_.solve(lifted.program, lifted.point(x));
        outcome.x.conservativeResize(x.size());
        return outcome;
    }

    // One call of one solver, restored, polished and ranked; false when it is not usable.
    bool attempt(const OrbitProgram& program, const std::optional<LevelPoints>& level,
                 const Eigen::VectorXd& start, const std::string& solver, int number, Best& best,
                 std::vector<SolverRun>& others) {
        const Eigen::VectorXd x = program.point(start);
        SolverOutcome outcome;
        if (solver == "ipopt") {
            outcome = solve_by_ipopt(program, x);
        } else {
            const auto method =
                solver == "nlopt-slsqp" ? NloptMethod::slsqp : NloptMethod::auglag_lbfgs;
            outcome = solve_with_nlopt(method, program.program, x, options_.solver);
        }
        SolverRun run;
        run.name = solver;
        run.start = number;
        run.status = outcome.status;
        run.iterations = outcome.iterations;
        run.seconds = outcome.seconds;
        run.violation = program.program.violation(outcome.x);
        run.objective = std::numeric_limits<double>::quiet_NaN();

        Best trial;
        if (run.violation <= options_.raw_violation) {
            const auto near = restored(program, problem_.set, level ? &*level : nullptr, outcome.x);
            if (near) {
                const Polished polished = polish(program.program, program.point(*near));
                if (polished.feasible) {
                    trial.usable = true;
                    trial.candidate = {program.gamma(polished.x), solver};
                    trial.rank = rank(trial.candidate.gamma);
                    trial.optimality = optimality_of(program, polished);
                    trial.global = trial.optimality.global;
                    run.usable = true;
                    run.objective = objective_value(trial.candidate.gamma);
                }
            }
        }
        trial.run = run;
        const bool better = trial.usable && (!best.usable || preferable(trial, best));
        if (better || best.run.name.empty()) std::swap(best, trial);
        if (!trial.run.name.empty()) others.push_back(trial.run);
        return run.usable;
    }

    // From the polish alone: its KKT residual, the bound of its Lagrangian and that of products.
    [[nodiscard]] Optimality optimality_of(const OrbitProgram& program, const Polished& polished) {
        Optimality result;
        result.kkt_residual = polished.multipliers.residual;
        if (polished.stationary && std::isfinite(polished.lower_bound)) {
            set_bound(program, polished.objective, polished.lower_bound, result);
        }
        if (result.global || !polished.feasible) return result;
        // No point changes this bound: it is computed once.
        if (!product_bound_) product_bound_ = product_bound(program.program);
        if (*product_bound_ > -infinity && (!result.lower_bound || *product_bound_ > polished.lower_bound)) {
            set_bound(program, polished.objective, *product_bound_, result);
        }
        return result;
    }

    // `objective` and `bound` in the scale of the program.
    void set_bound(const OrbitProgram& program, double objective, double bound, Optimality& result) const {
        // Rounding may put a tight bound above the value it bounds.
        bound = std::min(bound, objective);
        if (program.objective_unit > 0) result.lower_bound = bound * program.objective_unit;
        result.gap = objective != 0 ? (objective - bound) / std::abs(objective) : 0.0;
        result.global = result.gap <= options_.agreement_tolerance;
    }

    [[nodiscard]] static double difference(const Best& a, const Best& b) {
        const double scale = std::max(std::abs(a.rank), std::abs(b.rank));
        return scale > 0 ? std::abs(a.rank - b.rank) / scale : 0.0;
    }

    // A point on the level a tenth of the way from `gamma` to another admissible point.
    [[nodiscard]] static std::optional<Eigen::VectorXd> aside_of(
        const Eigen::VectorXd& gamma, const std::optional<LevelPoints>& level,
        const std::optional<Eigen::VectorXd>& other) {
        if (!other) return std::nullopt;
        Eigen::VectorXd aside = 0.9 * gamma + 0.1 * *other;
        return level ? level->reach(aside) : std::optional(std::move(aside));
    }

    // The lower objective; of two that agree, the one that is proved.
    [[nodiscard]] bool preferable(const Best& a, const Best& b) const {
        if (a.global != b.global && difference(a, b) <= options_.agreement_tolerance) return a.global;
        return a.rank < b.rank;
    }

    [[nodiscard]] bool not_worse(const Best& a, const Best& b) const {
        return a.usable && (a.rank <= b.rank || difference(a, b) <= options_.agreement_tolerance);
    }

    void compare(bool with_ipopt, const Best& ipopt, bool with_nlopt, const Best& nlopt) {
        if (!with_ipopt || !with_nlopt) {
            const Best& only = with_ipopt ? ipopt : nlopt;
            answer_.agreement = only.usable ? Agreement::single : Agreement::both_failed;
            return;
        }
        if (ipopt.usable && nlopt.usable) {
            answer_.objective_difference = difference(ipopt, nlopt);
            answer_.agreement = *answer_.objective_difference <= options_.agreement_tolerance
                                    ? Agreement::agree
                                    : Agreement::different_optimum;
        } else {
            answer_.agreement =
                ipopt.usable || nlopt.usable ? Agreement::one_failed : Agreement::both_failed;
        }
    }

    void accept(const Candidate& candidate) {
        Orbit orbit = make_orbit(bar_, problem_.kernel, reduction_.beta(candidate.gamma));
        Replay judged = replay(orbit, request_.level);
        answer_.method = candidate.method;
        answer_.energy = energy_ratio(orbit);
        answer_.objective_value = objective_value(candidate.gamma);
        answer_.classification = classify(orbit);
        answer_.verdict_proved = judged.accepted;
        if (judged.accepted) {
            answer_.verdict = Verdict::admissible;
        } else {
            answer_.verdict = Verdict::failed;
            answer_.reason = judged.same_labels
                                 ? "replay: worst relative violation " + std::to_string(judged.violations.worst())
                                 : "replay: the marcher saw other contact steps than the pattern's";
        }
        answer_.replay = std::move(judged);
        if (answer_.verdict == Verdict::admissible) {
            answer_.orbit = std::move(orbit);
        } else {
            answer_.orbit.reset();
        }
    }

    const OrbitSolverOptions& options_;
    IpoptSolver& ipopt_;
    const Bar& bar_;
    const PatternProblem& problem_;
    const OrbitRequest& request_;
    const Reduction& reduction_;
    Eigen::VectorXd reference_;
    Best relaxed_;  // a better orbit that bounding came upon
    std::optional<double> product_bound_;  // in the scale of the program
    OrbitAnswer answer_;
};

}  // namespace

PatternProblem pattern_problem(const Pattern& pattern, int gap_sign, const PatternOptions& options) {
    validate(pattern);
    PatternProblem problem;
    problem.kernel = exact_kernel(pattern);
    problem.set = admissible_set(reduce(conditions(problem.kernel, gap_sign)), options.admissible);
    if (problem.kernel.dimension() == 0) {
        problem.verdict = Verdict::trivial;
    } else if (problem.set.status == AdmissibleSet::Status::empty) {
        problem.verdict = Verdict::inadmissible;
    } else if (problem.set.status == AdmissibleSet::Status::nonempty) {
        problem.verdict = Verdict::admissible;
    }
    problem.interval = problem.set.interval();
    if (!options.prove) return problem;
    problem.proof = prove(problem.kernel, problem.set, options.proof);
    const auto& certificate = problem.proof.certificate;
    auto& interval = problem.interval;
    if (problem.proof.verdict_proved && certificate.energy_least) {
        interval.least = to_double(*certificate.energy_least);
        interval.least_exact = to_string(*certificate.energy_least);
    }
    if (certificate.energy_attained) interval.greatest = to_double(*certificate.energy_attained);
    if (certificate.energy_bound) interval.bound = to_double(*certificate.energy_bound);
    if (certificate.energy_attained && problem.proof.exact_greatest()) {
        interval.greatest_exact = to_string(*certificate.energy_attained);
    }
    return problem;
}

OrbitSolver::OrbitSolver(const OrbitSolverOptions& options) : options_(options), ipopt_(options.solver) {
    if (options.starts < 1) {
        throw std::invalid_argument("starts: expected >= 1, got " + std::to_string(options.starts));
    }
}

OrbitAnswer OrbitSolver::solve(const Bar& bar, const PatternProblem& problem,
                               const OrbitRequest& request) {
    validate(bar);
    if (bar.gap_sign() != problem.set.reduction.gap_sign) {
        throw std::invalid_argument("gap sign: expected " +
                                    std::to_string(problem.set.reduction.gap_sign) + ", got " +
                                    std::to_string(bar.gap_sign()));
    }
    if (request.level && !(std::isfinite(*request.level) && *request.level > 0)) {
        throw std::invalid_argument("level: expected a finite number > 0, got " +
                                    std::to_string(*request.level));
    }
    const Eigen::Index window = 2 * static_cast<Eigen::Index>(problem.kernel.pattern.cells);
    if (request.reference.size() > 0 && request.reference.size() != window) {
        throw std::invalid_argument("reference: expected size " + std::to_string(window) + ", got " +
                                    std::to_string(request.reference.size()));
    }
    const auto begin = std::chrono::steady_clock::now();
    OrbitAnswer answer = Solve(options_, ipopt_, bar, problem, request).run();
    answer.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return answer;
}

Eigen::VectorXd reference_window(const Orbit& orbit) {
    return wave_basis(orbit.kernel) * orbit.beta;
}

}  // namespace nsma
