#include "nsma/search/orbit_solver.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>

#include "search.hpp"
#include "simplex_optimum.hpp"

namespace nsma {
namespace {

// Levels this close to an end of the interval, relative, are the end: nearer than the energies of orbits are compared
// (1e-12), farther than the rounding of the end.
constexpr double end_tolerance = 1e-13;
// Two vertices whose energies differ by rounding only are the same end of the interval.
constexpr double tie_tolerance = 1e-13;
// Distance beyond a row, relative to the size of the point, that rounding explains.
constexpr double row_rounding = 1e-13;

bool below(const EnergyInterval& interval, double level, const OrbitSolverOptions& options) {
    return level < *interval.least * (1 - options.level_tolerance);
}

// Above all energies attained.
bool above(const EnergyInterval& interval, double level, const OrbitSolverOptions& options) {
    return !interval.unbounded && !(interval.greatest && level <= *interval.greatest * (1 + options.level_tolerance));
}

bool admissible_point(const Reduction& reduction, const Eigen::VectorXd& gamma) {
    const double tolerance = row_rounding * gamma.lpNorm<1>();
    for (Eigen::Index j = 0; j < gamma.size(); ++j) {
        if (reduction.bounded[static_cast<std::size_t>(j)] != 0 && gamma[j] < -tolerance) return false;
    }
    return reduction.rows.rows() == 0 || (reduction.rows.cast<double>() * gamma).maxCoeff() <= tolerance;
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
    Solve(const OrbitSolverOptions& options, IpoptSolver& ipopt, const Bar& bar, const PatternProblem& problem,
          const OrbitRequest& request)
        : options_(options),
          ipopt_(ipopt),
          bar_(bar),
          problem_(problem),
          request_(request),
          reduction_(problem.set.reduction),
          goal_{problem, request.objective, request.reference} {}

    OrbitAnswer run() {
        answer_.pattern = problem_.kernel.pattern;
        answer_.gap_sign = bar_.gap_sign();
        answer_.kernel_dimension = problem_.kernel.dimension();
        answer_.verdict = problem_.verdict;
        answer_.kind = problem_.kind;
        answer_.reason = problem_.set.reason;
        answer_.interval = problem_.interval;
        answer_.verdict_proved = problem_.proof.verdict_proved;
        answer_.level = request_.level;
        answer_.objective = request_.objective;
        if (problem_.verdict == Verdict::admissible && level_verdict()) {
            answer_.reason.clear();
            find();
            if (answer_.orbit && !proved_best(answer_)) say_open();
        }
        return std::move(answer_);
    }

private:
    // In words, what is not known of the orbit that was found.
    void say_open() {
        const double percent = answer_.optimality ? 100 * answer_.optimality->gap : 100.0;
        std::ostringstream text;
        text << std::setprecision(percent < 10 ? 2 : 3) << "the orbit is not proved the best, gap " << percent << " %";
        answer_.reason += (answer_.reason.empty() ? "" : "; ") + text.str();
    }

    // Sets below/above and returns false where the level is outside the interval.
    bool level_verdict() {
        if (!request_.level) {
            if (reduction_.gap_sign != 0 || is_extreme(request_.objective)) return true;
            answer_.verdict = Verdict::failed;
            answer_.reason = "a closed gap has no least-energy orbit: give an energy";
            return false;
        }
        const double level = *request_.level;
        if (below(answer_.interval, level, options_)) {
            answer_.verdict = Verdict::below;
            answer_.reason = "level below the least energy of the pattern";
            return false;
        }
        if (!above(answer_.interval, level, options_)) return true;
        const auto& bound = answer_.interval.bound;
        answer_.verdict_proved = bound.has_value() && level > *bound * (1 + options_.level_tolerance);
        answer_.verdict = answer_.verdict_proved ? Verdict::above : Verdict::undecided;
        answer_.reason = answer_.verdict_proved ? "level above the greatest energy of the pattern"
                                                : "level above the greatest energy attained, below the proved bound";
        return false;
    }

    void find() {
        if (request_.objective == Objective::nearest) {
            if (!set_reference()) return;
            answer_.reference = goal_.reference;
        }
        if (end_of_interval()) return;
        const std::optional<Candidate> known = best_known();
        if (known && options_.solvers == SolverChoice::proof) return take_known({*known});
        optimise(known);
    }

    bool set_reference() {
        if (goal_.reference.size() > 0) return true;
        if (reduction_.gap_sign != 0) {
            const Orbit least = make_orbit(bar_, problem_.kernel, reduction_.beta(problem_.set.least));
            goal_.reference = reference_window(least);
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
        goal_.reference = reference_window(*smooth.orbit);
        return true;
    }

    // The orbits at the ends of the energy interval, where no level is asked or it is one of them.
    bool end_of_interval() {
        const auto& set = problem_.set;
        const bool closed = reduction_.gap_sign == 0;
        const auto same = [&](std::optional<double> end) {
            return end && std::abs(*request_.level - *end) <= end_tolerance * *end;
        };
        if (!request_.level && closed) {
            refuse_closed_gap_extreme();
        } else if (request_.objective == Objective::max_energy) {
            take_known({{set.vertices.front(), "vertex"}});
        } else if (!request_.level || (!closed && same(answer_.interval.least))) {
            take_known({{set.least, "least-norm"}});
        } else if (same(answer_.interval.greatest)) {
            std::vector<Candidate> tied;
            for (const auto& vertex : set.vertices) {
                if (set.energy(vertex) >= *answer_.interval.greatest * (1 - tie_tolerance))
                    tied.push_back({vertex, "vertex"});
            }
            take_known(tied);
        } else {
            return false;
        }
        return true;
    }

    // The best orbit at a level inside the interval, where a closed form gives it.
    [[nodiscard]] std::optional<Candidate> best_known() const {
        const double level = *request_.level;
        if (problem_.set.shape == AdmissibleSet::Shape::simplex) return Candidate{simplex_point(level), "closed-form"};
        if (problem_.set.flat_dimension == 1) {
            std::optional<Candidate> best;
            for (const auto& point : line_points(reduction_, level)) {
                if (!best || goal_.value(point) < goal_.value(best->gamma)) best = {point, "closed-form"};
            }
            return best;
        }
        // No variable of a chain has a contact step: its orbits are all without force.
        if (request_.objective != Objective::least_force) return std::nullopt;
        const auto point = LevelPoints(problem_.set, level).start(0);
        return point ? std::optional(Candidate{*point, "closed-form"}) : std::nullopt;
    }

    [[nodiscard]] Eigen::VectorXd simplex_point(double energy) const {
        const bool closed = reduction_.gap_sign == 0;
        const SimplexLevel level{reduction_.variables(), closed ? 0.0 : problem_.set.least.sum(),
                                 energy / reduction_.energy_factor};
        switch (request_.objective) {
            case Objective::least_force: return least_peak_point(level);
            case Objective::nearest: return nearest_point(level, target_of(goal_.reference));
            default: return smoothest_point(level, shock_closure(problem_.kernel, reduction_));
        }
    }

    // The linear form of the reduced variables that is the scalar product with a window of waves.
    [[nodiscard]] Eigen::VectorXd target_of(const Eigen::VectorXd& window) const {
        const Kernel& kernel = problem_.kernel;
        Eigen::VectorXd amplitudes = Eigen::VectorXd::Zero(kernel.dimension());
        for (int n = 0; n < window.size(); ++n) {
            const int step = n % kernel.pattern.period_steps();
            if (const int column = kernel.column(step); column >= 0)
                amplitudes[column] += kernel.sign[static_cast<std::size_t>(step)] * window[n];
        }
        return reduction_.gamma(amplitudes);
    }

    // The best of orbits in closed form, which are all that can be the best.
    void take_known(const std::vector<Candidate>& candidates) {
        const auto best = std::min_element(candidates.begin(), candidates.end(), [&](const auto& a, const auto& b) {
            return goal_.value(a.gamma) < goal_.value(b.gamma);
        });
        answer_.agreement = Agreement::not_needed;
        accept(*best);
        answer_.optimality = Optimality{goal_.value(best->gamma), 0.0, true, 0.0};
    }

    void refuse_closed_gap_extreme() {
        answer_.verdict = Verdict::failed;
        answer_.reason = "a closed gap has orbits at every energy: no least and no greatest";
    }

    void optimise(const std::optional<Candidate>& known) {
        Search search(options_, ipopt_, problem_, request_, goal_, answer_.interval.least.value_or(1.0), known);
        if (options_.solvers == SolverChoice::proof) {
            if (const auto proved = search.first_proof()) {
                answer_.agreement = Agreement::not_needed;
                answer_.solvers = search.runs();
                if (take(*proved)) return;
            }
        }
        search.run();
        answer_.agreement = search.agreement();
        answer_.objective_difference = search.difference();
        answer_.solvers = search.runs();
        for (const Best* best : search.ranked()) {
            if (!take(*best)) continue;
            if (search.unsolved(best) && !search.a_solver_came_to(*best))
                no_solver_came("the " + best->candidate.method);
            return;
        }
        // Both failed: the segment still gives an orbit of this pattern at this level.
        if (const auto segment = search.segment(); segment && take(*segment)) {
            answer_.reason = "no solver answer was usable: polished segment point";
        }
        if (answer_.verdict == Verdict::admissible && !answer_.orbit) {
            answer_.verdict = Verdict::failed;
            answer_.verdict_proved = false;
            answer_.reason = "no point on the level was reached";
        }
    }

    bool take(const Best& best) {
        accept(best.candidate);
        answer_.optimality = best.optimality;
        return answer_.verdict == Verdict::admissible;
    }

    // The kept orbit is better than what any solver holds: they do not agree about it.
    void no_solver_came(const std::string& origin) {
        if (answer_.agreement != Agreement::both_failed) answer_.agreement = Agreement::different_optimum;
        answer_.reason = "no solver came to the best orbit known, found by " + origin;
    }

    void accept(const Candidate& candidate) {
        Orbit orbit = make_orbit(bar_, problem_.kernel, reduction_.beta(candidate.gamma));
        Replay judged = replay(orbit, request_.level);
        answer_.method = candidate.method;
        answer_.energy = energy_ratio(orbit);
        answer_.objective_value = goal_.value(candidate.gamma);
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
    Goal goal_;
    OrbitAnswer answer_;
};

}  // namespace

PatternProblem pattern_problem(const Pattern& pattern, int gap_sign, const PatternOptions& options) {
    validate(pattern);
    PatternProblem problem;
    problem.kernel = exact_kernel(pattern);
    problem.set = admissible_set(reduce(conditions(problem.kernel, gap_sign)));
    if (problem.kernel.dimension() == 0) {
        problem.verdict = Verdict::trivial;
    } else if (problem.set.status == AdmissibleSet::Status::empty) {
        problem.verdict = Verdict::inadmissible;
    } else if (problem.set.status == AdmissibleSet::Status::nonempty) {
        problem.verdict = Verdict::admissible;
        problem.kind = pattern_kind(pattern);
    }
    problem.interval = problem.set.interval();
    if (!options.prove) return problem;
    problem.proof = prove(problem.kernel, problem.set);
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

OrbitSolver::OrbitSolver(const OrbitSolverOptions& options)
    : options_(options), ipopt_(std::make_unique<IpoptSolver>(options.solver)) {
    if (options.starts < 1) {
        throw std::invalid_argument("starts: expected >= 1, got " + std::to_string(options.starts));
    }
}

OrbitSolver::~OrbitSolver() = default;
OrbitSolver::OrbitSolver(OrbitSolver&&) noexcept = default;
OrbitSolver& OrbitSolver::operator=(OrbitSolver&&) noexcept = default;

OrbitAnswer OrbitSolver::solve(const Bar& bar, const PatternProblem& problem, const OrbitRequest& request) {
    validate(bar);
    if (bar.gap_sign() != problem.set.reduction.gap_sign) {
        throw std::invalid_argument("gap sign: expected " + std::to_string(problem.set.reduction.gap_sign) + ", got " +
                                    std::to_string(bar.gap_sign()));
    }
    if (request.level && !(std::isfinite(*request.level) && *request.level > 0)) {
        throw std::invalid_argument("level: expected a finite number > 0, got " + std::to_string(*request.level));
    }
    if (request.level && is_extreme(request.objective)) {
        throw std::invalid_argument("level: expected none for objective " + std::string(name(request.objective)) +
                                    ", got " + std::to_string(*request.level));
    }
    const Eigen::Index window = 2 * static_cast<Eigen::Index>(problem.kernel.pattern.cells);
    if (request.reference.size() > 0 && request.reference.size() != window) {
        throw std::invalid_argument("reference: expected size " + std::to_string(window) + ", got " +
                                    std::to_string(request.reference.size()));
    }
    const Eigen::Index amplitudes = problem.kernel.dimension();
    if (request.start.size() > 0 && (request.start.size() != amplitudes || !request.start.allFinite())) {
        throw std::invalid_argument("start: expected " + std::to_string(amplitudes) + " finite amplitudes, got " +
                                    std::to_string(request.start.size()));
    }
    const auto begin = std::chrono::steady_clock::now();
    OrbitAnswer answer = Solve(options_, *ipopt_, bar, problem, request).run();
    answer.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return answer;
}

bool OrbitSolver::outside(const EnergyInterval& interval, double level) const {
    return below(interval, level, options_) || above(interval, level, options_);
}

Eigen::VectorXd reference_window(const Orbit& orbit) { return wave_basis(orbit.kernel) * orbit.beta; }

}  // namespace nsma
