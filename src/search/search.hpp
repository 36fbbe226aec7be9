#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "orbit_program.hpp"
#include "numerics/polish.hpp"
#include "numerics/solver.hpp"
#include "set/level_points.hpp"
#include "nsma/search/orbit_solver.hpp"

namespace nsma {

/// An admissible point and how it was found.
struct Candidate {
    Eigen::VectorXd gamma;
    std::string method;
};

/// The objective over the reduced variables.
struct Goal {
    const PatternProblem& problem;
    Objective objective;
    Eigen::VectorXd reference;  ///< of `nearest`

    [[nodiscard]] double value(const Eigen::VectorXd& gamma) const;
    /// Lower is better, also for max_energy.
    [[nodiscard]] double rank(const Eigen::VectorXd& gamma) const;
};

/// The best that one solver, or a closed form, came to.
struct Best {
    double rank = std::numeric_limits<double>::infinity();
    Candidate candidate;
    SolverRun run;
    bool usable = false;
    bool known = false;  ///< the best in closed form
    Optimality optimality;
};

/// The search for the best orbit at one level: each solver from its own starts, then from near the best orbit known.
class Search {
public:
    /// `known`: the best orbit in closed form, where there is one; solvers are asked whether they agree.
    Search(const OrbitSolverOptions& options, IpoptSolver& ipopt, const PatternProblem& problem,
           const OrbitRequest& request, const Goal& goal, double least_energy, const std::optional<Candidate>& known);

    /// The search of SolverChoice::proof until an answer is proved to be the best; absent where none is.
    [[nodiscard]] std::optional<Best> first_proof();
    /// The whole search, going on with what is known already.
    void run();

    [[nodiscard]] Agreement agreement() const;
    [[nodiscard]] std::optional<double> difference()
        const;                                              ///< of the solvers, relative; absent unless both are usable
    [[nodiscard]] std::vector<SolverRun> runs() const;      ///< the best of each solver first
    [[nodiscard]] std::vector<const Best*> ranked() const;  ///< the usable ones, the best first
    /// A solver asked for came to the objective of `best`.
    [[nodiscard]] bool a_solver_came_to(const Best& best) const;
    /// Not the answer of a solver.
    [[nodiscard]] bool unsolved(const Best* best) const { return best == &unaided_; }
    /// The best of the points of all pieces of the level, polished: admissible without a solver.
    [[nodiscard]] std::optional<Best> segment();

private:
    [[nodiscard]] std::optional<Eigen::VectorXd> start(int k) const;
    [[nodiscard]] int ipopt_start() const;  // number of its first one
    [[nodiscard]] std::optional<Eigen::VectorXd> aside_of(const Eigen::VectorXd& gamma, double part, int k) const;
    void search_with_nlopt();
    void search_with_ipopt();
    void ask(const Best& better, Best& worse, const char* solver);
    void settle();
    [[nodiscard]] bool settled(const Best& best) const;
    bool attempt(const Eigen::VectorXd& start, const std::string& solver, int number, Best& best,
                 const Program* posed = nullptr);
    [[nodiscard]] SolverOutcome call(const std::string& solver, const Program& program, const Eigen::VectorXd& x);
    [[nodiscard]] Best found(const Polished& polished, const char* method) const;
    void set_bound(double objective, double bound, Optimality& result) const;
    [[nodiscard]] double difference(const Best& a, const Best& b) const;
    [[nodiscard]] bool preferable(const Best& a, const Best& b) const;
    [[nodiscard]] bool not_worse(const Best& a, const Best& b) const;

    const OrbitSolverOptions& options_;
    IpoptSolver& ipopt_solver_;
    const PatternProblem& problem_;
    const Goal& goal_;
    double floor_;
    OrbitProgram program_;
    std::optional<LevelPoints> level_;
    std::optional<Eigen::VectorXd> warm_;  // on the level, from an orbit at another
    bool with_ipopt_;
    bool with_nlopt_;
    int starts_;    // of each solver
    int next_ = 1;  // number of the next start
    Best ipopt_;
    Best nlopt_;
    Best unaided_;  // the best one without a solver
    std::vector<SolverRun> others_;
};

}  // namespace nsma
