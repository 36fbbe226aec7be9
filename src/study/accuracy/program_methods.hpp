#pragma once

#include <string>
#include <vector>

#include "accuracy_records.hpp"
#include "numerics/solver.hpp"
#include "set/level_points.hpp"
#include "nsma/search/orbit_solver.hpp"
#include "nsma/search/pattern_problem.hpp"
#include "search/orbit_program.hpp"

namespace nsma {

/// One way to solve the program of a pattern at a level.
struct ProgramMethod {
    enum class Kind {
        both,     ///< OrbitSolver, each solver against the other
        proof,    ///< OrbitSolver until an answer is proved, without a cross-check
        segment,  ///< the admissible point of a segment, polished; no solver
        ipopt,
        slsqp,
        auglag_lbfgs,
        auglag_slsqp,
        cobyla,
        isres
    };
    Kind kind = Kind::both;
    double tolerance = 1e-8;
    bool polish = true;  ///< restore and polish the raw answer, and bound the objective
    bool warm = false;   ///< start at the optimum of a level 2 % away

    /// Brings its own start and poses the program itself.
    [[nodiscard]] bool whole() const { return kind == Kind::both || kind == Kind::proof; }
    [[nodiscard]] bool derivative_free() const { return kind == Kind::cobyla || kind == Kind::isres; }
    [[nodiscard]] std::string name() const;     ///< e.g. "Ipopt"
    [[nodiscard]] std::string setting() const;  ///< e.g. "tol 1e-08, polish"
};

/// Every method at every tolerance it is studied at.
[[nodiscard]] std::vector<ProgramMethod> program_methods(bool quick);
/// One setting of each method, for the stability maps: its best one of the study.
[[nodiscard]] std::vector<ProgramMethod> mapped_methods();

/// A program with its proved best objective.
struct ProgramCase {
    Bar bar;
    const PatternProblem& problem;
    Objective objective;
    double level;               ///< E/E_unit
    Eigen::VectorXd reference;  ///< window of `nearest`: the least-energy orbit
    OrbitProgram program;
    LevelPoints points;
    double pose_seconds = 0;   ///< CPU, to pose the program and find a start: part of every run
    double best = 0;           ///< objective of the best orbit known, reported units
    bool proved = false;       ///< ... and proved to be the best
    Eigen::VectorXd best_x{};  ///< its unknowns
};

/// Poses the program, times that, and solves it. `problem` must be admissible and outlive the case. Throws
/// std::invalid_argument on a level that is not attainable.
[[nodiscard]] ProgramCase solved_case(const Bar& bar, const PatternProblem& problem, Objective objective, double level);

/// The point on the case's level that a segment from the best orbit of a level 2 % away reaches.
[[nodiscard]] Eigen::VectorXd warm_start(const ProgramCase& on);

/// One run, judged.
struct Trial {
    Outcome outcome = Outcome::not_finite;
    bool reported = false;   ///< the library claims success
    double gap = 1;          ///< |objective - best|/best; 1 without an orbit
    double violation = 1;    ///< worst of the replay, relative; 1 without an orbit
    bool certified = false;  ///< the method's own bound proves its answer the best
    double seconds = 0;      ///< CPU, with posing, polish, bound and replay
    int iterations = 0;

    [[nodiscard]] double error() const { return gap > violation ? gap : violation; }
};

/// Pattern, proof and counts of the runs of a method on a case.
[[nodiscard]] MethodRuns counted(const ProgramCase& on, const std::string& method, const std::vector<Trial>& trials);

/// Runs one method; solver objects are kept between runs.
class MethodRunner {
public:
    explicit MethodRunner(const ProgramMethod& method, double time_limit = 5.0);

    /// Poses `posed` (the case's program or a variant over the same unknowns) from `start`, which a whole method does
    /// not use.
    [[nodiscard]] Trial run(const ProgramCase& on, const Program& posed, const Eigen::VectorXd& start);

private:
    [[nodiscard]] Trial run_whole(const ProgramCase& on);
    [[nodiscard]] Trial run_posed(const ProgramCase& on, const Program& posed, const Eigen::VectorXd& start);
    [[nodiscard]] SolverOutcome solve(const Program& posed, const Eigen::VectorXd& start);

    ProgramMethod method_;
    SolverOptions options_;
    OrbitSolver orbit_solver_;
    IpoptSolver ipopt_;
};

}  // namespace nsma
