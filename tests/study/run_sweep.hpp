#pragma once

#include <functional>

#include "nsma/search/orbit_solver.hpp"
#include "nsma/study/records.hpp"
#include "nsma/study/scene.hpp"

namespace nsma {

/// Receives the records of a study as they come.
class SweepSink {
public:
    virtual ~SweepSink() = default;
    virtual void pattern(const PatternRecord& record) = 0;
    /// The least-energy orbit of an admissible pattern (level absent), then one answer a level.
    virtual void answer(const OrbitAnswer& answer) = 0;
    /// Work done so far out of all; total may shrink or grow while a sweep runs.
    virtual void progress(long done, long total) = 0;
};

/// Energy-level sweep: every pattern of the scene and, where it is admissible, its least-energy
/// orbit and every level. Records go to the sink as they come; a failure is a record.
/// `nearest` follows each pattern from level to level (continuation); `min-energy` and
/// `max-energy` have one answer a pattern and no level.
/// `keep_going` is asked before each solve; once false the sweep ends and says so.
[[nodiscard]] SweepSummary sweep(const Scene& scene, const OrbitSolverOptions& options, SweepSink& sink,
                                 const std::function<bool()>& keep_going);

}  // namespace nsma
