#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "nsma/search/orbit_solver.hpp"
#include "nsma/search/pattern_problem.hpp"
#include "nsma/study/records.hpp"
#include "nsma/study/scene.hpp"

namespace nsma {

/// One piece of a sweep that one process does by itself.
struct WorkUnit {
    long pattern = 0;  ///< position among patterns_of(scene)
    /// -1: decide the pattern; 0: its least-energy orbit; k >= 1: the k-th answer asked of it.
    int place = -1;
    /// Beta of the orbit at a level before (nondimensional), which Ipopt starts from and `nearest` stays near; may be
    /// empty.
    std::vector<double> before;
};

/// What came of it: a pattern record (place -1) or an answer.
struct WorkResult {
    long pattern = 0;
    int place = -1;
    std::optional<PatternRecord> record;
    std::optional<OrbitAnswer> answer;
};

/// Does units of one scene, reusing its solvers; keeps the last pattern's problem at hand. The
/// result of a unit does not depend on the units done before.
class SweepWorker {
public:
    /// How a certificate is written into one line.
    using CertificateText = std::function<std::string(const Certificate&)>;
    /// With a text every orbit is certified.
    SweepWorker(const Scene& scene, const OrbitSolverOptions& options, CertificateText certificate_text = {});
    [[nodiscard]] WorkResult run(const WorkUnit& unit);
    /// Several in their order. A verdict brings with it the answers for levels outside the pattern's interval, which
    /// are known with it: up to 1024 in all.
    [[nodiscard]] std::vector<WorkResult> run(const std::vector<WorkUnit>& units);

private:
    const Scene& scene_;
    std::vector<Pattern> patterns_;
    OrbitSolver solver_;
    CertificateText certificate_text_;
    long held_ = -1;
    PatternProblem problem_;
};

/// Adds a record to the counts; `asked` is false for the least-energy orbit, which counts only
/// when it failed or its replay is the worst.
void count(SweepSummary& summary, const PatternRecord& record, bool all_kinds);
void count(SweepSummary& summary, const OrbitAnswer& answer, bool asked);

}  // namespace nsma
