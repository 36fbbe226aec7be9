#pragma once

#include <memory>
#include <string>
#include <vector>

#include "accuracy_records.hpp"
#include "numerics/solver.hpp"
#include "set/level_points.hpp"
#include "nsma/search/orbit_solver.hpp"
#include "search/orbit_program.hpp"

namespace nsma {

/// One way to solve the program of a pattern at a level.
struct ProgramMethod {
    enum class Kind {
        both,     ///< OrbitSolver, each solver against the other
        proof,    ///< OrbitSolver until an answer is proved, without a cross-check
        segment,  ///< the admissible point of a segment, polished; no solver
        ipopt,
        nlopt
    };
    Kind kind = Kind::both;
    NloptMethod nlopt = NloptMethod::slsqp;
    std::string name;
    double tolerance = 1e-8;
    bool polish = false;  ///< restore and polish the raw answer, and bound the objective
    bool warm = false;    ///< start at the optimum of a level 2 % away

    /// Brings its own start and poses the program itself.
    [[nodiscard]] bool whole() const { return kind == Kind::both || kind == Kind::proof; }
    [[nodiscard]] std::string setting() const;  ///< e.g. "tol 1e-08, polish"
};

/// Every method at every tolerance it is studied at.
[[nodiscard]] std::vector<ProgramMethod> program_methods(bool quick);
/// One setting of each method, for the stability maps: its best one of the study.
[[nodiscard]] std::vector<ProgramMethod> mapped_methods();

/// A program with its proved best objective.
struct ProgramCase {
    /// Solves for the reference. `problem` must be admissible and outlive this object.
    ProgramCase(const Bar& bar, const PatternProblem& problem, Objective objective, double level);

    Bar bar;
    const PatternProblem& problem;
    Objective objective;
    double level;               ///< E/E_unit
    Eigen::VectorXd reference;  ///< window of `nearest`: the least-energy orbit
    OrbitProgram program;
    LevelPoints points;
    double best = 0;          ///< objective of the best orbit known, reported units
    bool proved = false;      ///< ... and proved to be the best
    Eigen::VectorXd best_x;   ///< its unknowns
    double pose_seconds = 0;  ///< CPU, to pose the program and find a start: part of every run
    Eigen::VectorXd warm_x;   ///< on this level, from the best orbit of a level 2 % away

private:
    [[nodiscard]] double posing_seconds() const;
};

/// One run, judged.
struct Trial {
    Outcome outcome = Outcome::not_finite;
    bool reported = false;  ///< the library claims success
    std::string status;
    double gap = 0;          ///< |objective - best|/best
    double violation = 0;    ///< worst of the replay, relative
    bool certified = false;  ///< the method's own bound proves its answer the best
    double seconds = 0;      ///< CPU, with posing, polish, bound and replay
    int iterations = 0;

    [[nodiscard]] double error() const { return gap > violation ? gap : violation; }
};

/// Runs one method; solver objects are kept between runs.
class MethodRunner {
public:
    explicit MethodRunner(const ProgramMethod& method, double time_limit = 5.0);

    /// Poses `posed` (the case's program or a variant over the same unknowns) from `start`; the
    /// default path and warm methods bring their own start. COBYLA and ISRES run in a child
    /// process, since nothing else ends them for sure.
    [[nodiscard]] Trial run(const ProgramCase& on, const Program& posed, const Eigen::VectorXd& start);

    [[nodiscard]] const ProgramMethod& method() const { return method_; }

private:
    [[nodiscard]] SolverOutcome call(const Program& posed, const Eigen::VectorXd& start);

    ProgramMethod method_;
    SolverOptions options_;
    std::unique_ptr<OrbitSolver> orbit_solver_;
    std::unique_ptr<IpoptSolver> ipopt_;
};

/// CPU time of this process [s].
[[nodiscard]] double cpu_seconds();

}  // namespace nsma
