#include "nsma/search/orbit_solver.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <string>

#include "level_search.hpp"
#include "simplex_optimum.hpp"

namespace nsma {
namespace {

// Relative; a level further outside the interval has no orbit.
constexpr double level_tolerance = 1e-15;
// Levels this close to an end of the interval, relative, are the end: nearer than the energies of orbits are compared
// (1e-12), farther than the rounding of the end. So are vertices of these energies.
constexpr double end_tolerance = 1e-13;

bool below(const EnergyInterval& interval, double level) { return level < *interval.least * (1 - level_tolerance); }

// Above all energies attained.
bool above(const EnergyInterval& interval, double level) {
    return !interval.unbounded && !(interval.greatest && level <= *interval.greatest * (1 + level_tolerance));
}

// One call of OrbitSolver::solve.
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
        if (problem_.verdict == Verdict::admissible && level_is_attained()) {
            answer_.reason.clear();
            find_orbit();
            if (answer_.orbit && !proved_best(answer_)) say_open();
        }
        return std::move(answer_);
    }

private:
    void refuse(Verdict verdict, std::string reason) {
        answer_.verdict = verdict;
        answer_.reason = std::move(reason);
    }

    // In words, what is not known of the orbit that was found.
    void say_open() {
        const double percent = answer_.optimality ? 100 * answer_.optimality->gap : 100.0;
        std::ostringstream text;
        text << std::setprecision(percent < 10 ? 2 : 3) << "the orbit is not proved the best; gap " << percent << " %";
        answer_.reason += (answer_.reason.empty() ? "" : "; ") + text.str();
    }

    // Refuses a level outside the interval, and a closed gap without one.
    bool level_is_attained() {
        if (!request_.level) {
            if (reduction_.gap_sign != 0) return true;
            refuse(Verdict::failed, is_extreme(request_.objective)
                                        ? "a closed gap has orbits at every energy: no least and no greatest"
                                        : "a closed gap has no least-energy orbit: give an energy");
            return false;
        }
        const double level = *request_.level;
        if (below(answer_.interval, level)) {
            refuse(Verdict::below, "level below the least energy of the pattern");
            return false;
        }
        if (!above(answer_.interval, level)) return true;
        const auto& bound = answer_.interval.bound;
        answer_.verdict_proved = bound.has_value() && level > *bound * (1 + level_tolerance);
        if (answer_.verdict_proved) {
            refuse(Verdict::above, "level above the greatest energy of the pattern");
        } else {
            refuse(Verdict::undecided, "level above the greatest energy attained, below the proved bound");
        }
        return false;
    }

    void find_orbit() {
        if (request_.objective == Objective::nearest) {
            if (!set_reference()) return;
            answer_.reference = goal_.reference;
        }
        std::vector<Candidate> known = ends_of_interval();
        const bool at_end = !known.empty();
        if (!at_end) known = optima_in_closed_form();
        const auto best = std::min_element(known.begin(), known.end(), [](const Candidate& a, const Candidate& b) {
            return a.objective < b.objective;
        });
        if (best != known.end() && (at_end || options_.solvers == SolverChoice::proof)) {
            keep(*best);
        } else {
            search(best != known.end() ? std::optional(*best) : std::nullopt);
        }
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
            refuse(Verdict::failed, "no reference orbit: " + smooth.reason);
            return false;
        }
        goal_.reference = reference_window(*smooth.orbit);
        return true;
    }

    [[nodiscard]] Candidate closed_form(Eigen::VectorXd gamma, const char* method) const {
        const double value = goal_.value(gamma);
        return {std::move(gamma), Candidate::Origin::closed_form, method, value, {value, 0.0, true, 0.0}};
    }

    // The orbits at an end of the energy interval, where no level is given or it is the end; else none.
    [[nodiscard]] std::vector<Candidate> ends_of_interval() const {
        const auto& set = problem_.set;
        const auto same = [&](std::optional<double> end) {
            return end && std::abs(*request_.level - *end) <= end_tolerance * *end;
        };
        if (request_.objective == Objective::max_energy) return {closed_form(set.vertices.front(), "vertex")};
        if (!request_.level || (reduction_.gap_sign != 0 && same(answer_.interval.least)))
            return {closed_form(set.least, "least-norm")};
        std::vector<Candidate> tied;
        if (!same(answer_.interval.greatest)) return tied;
        for (const auto& vertex : set.vertices) {
            if (set.energy(vertex) >= *answer_.interval.greatest * (1 - end_tolerance))
                tied.push_back(closed_form(vertex, "vertex"));
        }
        return tied;
    }

    // Orbits one of which is the best at a level inside the interval, where a formula gives them; else none.
    [[nodiscard]] std::vector<Candidate> optima_in_closed_form() const {
        if (problem_.set.shape == AdmissibleSet::Shape::simplex) {
            return {closed_form(
                simplex_optimum(problem_.kernel, problem_.set, request_.objective, *request_.level, goal_.reference),
                "closed-form")};
        }
        if (reduction_.variables() == 2) return segment_points();
        // No variable of a chain has a contact step: its orbits are all without force.
        if (request_.objective != Objective::least_force) return {};
        const auto point = LevelPoints(problem_.set, *request_.level).start(0);
        if (!point) return {};
        return {closed_form(*point, "closed-form")};
    }

    // A chain of two variables is a segment about its least-energy point: the level cuts it twice.
    [[nodiscard]] std::vector<Candidate> segment_points() const {
        const Eigen::VectorXd& middle = problem_.set.least;
        const double square = *request_.level / reduction_.energy_factor - middle.squaredNorm();
        const Eigen::VectorXd w = reduction_.contact_row.cast<double>();
        const Eigen::VectorXd step = std::sqrt(std::max(square, 0.0)) * Eigen::Vector2d(-w[1], w[0]).normalized();
        return {closed_form(middle + step, "closed-form"), closed_form(middle - step, "closed-form")};
    }

    void search(const std::optional<Candidate>& known) {
        LevelSearch search(options_, ipopt_, goal_, *request_.level, request_.start, known);
        if (options_.solvers == SolverChoice::proof) {
            search.run_until_proved();
            const auto all = search.ranked();
            if (!all.empty() && all.front()->optimality.global) {
                answer_.solvers = search.runs();
                if (keep(*all.front())) return;
            }
        }
        search.run();
        answer_.agreement = search.agreement();
        answer_.objective_difference = search.difference();
        answer_.solvers = search.runs();
        for (const Candidate* best : search.ranked()) {
            if (!keep(*best)) continue;
            if (best->origin != Candidate::Origin::solver && !search.a_solver_came_to(*best)) {
                // The kept orbit is better than what any solver holds: they do not agree about it.
                if (answer_.agreement != Agreement::both_failed) answer_.agreement = Agreement::different_optimum;
                answer_.reason = "no solver came to the best orbit known; found by the " + best->method;
            }
            return;
        }
        // Both failed: descent still gives an orbit of this pattern at this level.
        if (const auto segment = search.descend(); segment && keep(*segment)) {
            answer_.reason = "no solver answer was usable: polished segment point";
        } else if (answer_.verdict == Verdict::admissible) {
            answer_.verdict_proved = false;
            refuse(Verdict::failed, "no point on the level was reached");
        }
    }

    // Makes the answer of a candidate; false where replay refuses it.
    bool keep(const Candidate& candidate) {
        Orbit orbit = make_orbit(bar_, problem_.kernel, reduction_.beta(candidate.gamma));
        answer_.replay = replay(orbit, request_.level);
        const Replay& judged = *answer_.replay;
        answer_.method = candidate.method;
        answer_.energy = energy_ratio(orbit);
        answer_.objective_value = candidate.objective;
        answer_.optimality = candidate.optimality;
        answer_.classification = classify(orbit);
        answer_.verdict_proved = judged.accepted;
        answer_.verdict = Verdict::admissible;
        answer_.orbit.reset();
        if (judged.accepted) {
            answer_.orbit = std::move(orbit);
        } else {
            refuse(Verdict::failed,
                   judged.same_labels ? "replay: worst relative violation " + std::to_string(judged.violations.worst())
                                      : "replay: the marcher saw other contact steps than the "
                                        "pattern's");
        }
        return judged.accepted;
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

void validate(const OrbitRequest& request, const Bar& bar, const PatternProblem& problem) {
    validate(bar);
    const auto refuse = [](const std::string& what, const std::string& expected, const std::string& got) {
        throw std::invalid_argument(what + ": expected " + expected + ", got " + got);
    };
    if (bar.gap_sign() != problem.set.reduction.gap_sign)
        refuse("gap sign", std::to_string(problem.set.reduction.gap_sign), std::to_string(bar.gap_sign()));
    if (request.level && !(std::isfinite(*request.level) && *request.level > 0))
        refuse("level", "a finite number > 0", std::to_string(*request.level));
    if (request.level && is_extreme(request.objective)) {
        refuse("level", "none for objective " + std::string(name(request.objective)), std::to_string(*request.level));
    }
    const Eigen::Index window = 2 * static_cast<Eigen::Index>(problem.kernel.pattern.cells);
    if (request.reference.size() > 0 && request.reference.size() != window)
        refuse("reference", "size " + std::to_string(window), std::to_string(request.reference.size()));
    const Eigen::Index amplitudes = problem.kernel.dimension();
    if (request.start.size() > 0 && (request.start.size() != amplitudes || !request.start.allFinite()))
        refuse("start", std::to_string(amplitudes) + " finite amplitudes", std::to_string(request.start.size()));
}

}  // namespace

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
    validate(request, bar, problem);
    const auto begin = std::chrono::steady_clock::now();
    OrbitAnswer answer = Solve(options_, *ipopt_, bar, problem, request).run();
    answer.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return answer;
}

bool proved_exactly(const OrbitAnswer& answer) {
    return answer.exact_proof && answer.exact_proof->gap <= agreement_tolerance;
}

bool ipopt_is_usual(const OrbitSolverOptions& options) {
    return options.solvers == SolverChoice::ipopt || options.solvers == SolverChoice::both;
}

bool outside(const EnergyInterval& interval, double level) { return below(interval, level) || above(interval, level); }

Eigen::VectorXd reference_window(const Orbit& orbit) {
    return Eigen::VectorXd::NullaryExpr(2 * static_cast<Eigen::Index>(orbit.kernel.pattern.cells), [&](Eigen::Index n) {
        return orbit.kernel.wave(orbit.beta, static_cast<int>(n));
    });
}

}  // namespace nsma
