#pragma once

#include <optional>
#include <string>
#include <vector>

#include "orbit_program.hpp"
#include "numerics/solver.hpp"
#include "set/level_points.hpp"
#include "nsma/search/orbit_solver.hpp"
#include "nsma/search/pattern_problem.hpp"

namespace nsma {

/// The objective over the reduced variables.
struct Goal {
    const PatternProblem& problem;
    Objective objective;
    Eigen::VectorXd reference;  ///< of `nearest`

    [[nodiscard]] double value(const Eigen::VectorXd& gamma) const;
};

/// An admissible point, how it was found and what is known of it.
struct Candidate {
    enum class Origin { closed_form, descent, solver };

    Eigen::VectorXd gamma;
    Origin origin = Origin::closed_form;
    std::string method;    ///< as in OrbitAnswer
    double objective = 0;  ///< in reported units; lower is better
    Optimality optimality;
};

/// The search for the best orbit at one level: each solver from its own starts, then from near the best orbit known.
class LevelSearch {
public:
    /// `start`: as in OrbitRequest. `known`: the best orbit in closed form, where there is one, with which the solvers
    /// are compared.
    LevelSearch(const OrbitSolverOptions& options, IpoptSolver& ipopt, const Goal& goal, double level,
                const Eigen::VectorXd& start, std::optional<Candidate> known);

    /// Descent from every piece of the level, then NLopt, until an answer is proved the best.
    void run_until_proved();
    /// Every solver chosen, going on with what is known already.
    void run();

    /// What each solver and descent or the closed form came to, the best first.
    [[nodiscard]] std::vector<const Candidate*> ranked() const;
    /// Whether a solver has an objective as good as that.
    [[nodiscard]] bool a_solver_came_to(const Candidate& best) const;
    /// The best of the points of all pieces of the level, polished.
    [[nodiscard]] std::optional<Candidate> descend() const;

    [[nodiscard]] Agreement agreement() const;
    [[nodiscard]] std::optional<double> difference()
        const;                                          ///< of the solvers, relative; absent unless both are usable
    [[nodiscard]] std::vector<SolverRun> runs() const;  ///< the best of each solver first

private:
    enum class Solver { ipopt, nlopt };
    struct Contender {
        SolverRun run;  // of its best candidate, else its first; without a name before that
        std::optional<Candidate> best;
    };

    void start_nlopt();
    void start_ipopt();
    bool solve(const Program& program, const Eigen::VectorXd& start, Solver solver, int number);
    bool judge(const char* method, int number, const SolverOutcome& outcome, Contender& contender);
    void challenge(const Candidate& better, Solver solver);
    void challenge_with_best();
    void share_bounds();

    [[nodiscard]] std::optional<Eigen::VectorXd> start(int number) const;
    [[nodiscard]] std::optional<Candidate> polished(const Eigen::VectorXd& gamma, Candidate::Origin origin,
                                                    const char* method) const;
    void set_bound(double objective, double bound, Optimality& result) const;
    [[nodiscard]] bool settled(const Contender& contender) const;
    [[nodiscard]] double difference(const Candidate& a, const Candidate& b) const;
    [[nodiscard]] bool preferable(const Candidate& a, const Candidate& b) const;
    [[nodiscard]] bool reaches(const Contender& contender, const Candidate& best) const;
    [[nodiscard]] bool uses(Solver solver) const;

    const OrbitSolverOptions& options_;
    IpoptSolver& ipopt_solver_;
    const Goal& goal_;
    double floor_;  // objectives are compared relative to the greater one, at least to this
    OrbitProgram program_;
    LevelPoints points_;
    std::optional<Eigen::VectorXd> warm_;  // on the level, from an orbit at another
    int starts_;                           // of each solver
    int next_ = 1;                         // number of the next start
    Contender ipopt_;
    Contender nlopt_;
    std::optional<Candidate> unaided_;  // without a solver
    std::vector<SolverRun> others_;
};

}  // namespace nsma
