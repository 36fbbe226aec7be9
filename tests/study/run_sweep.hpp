#pragma once

#include <functional>

#include "nsma/search/orbit_solver.hpp"
#include "nsma/study/records.hpp"
#include "nsma/study/scene.hpp"

namespace nsma {

/// Energy-level sweep: every pattern of the scene and, where it is admissible, its least-energy
/// orbit and every level. Records go to the sink as they come; a failure is a record.
/// `nearest` follows each pattern from level to level (continuation); `min-energy` and
/// `max-energy` have one answer a pattern and no level.
/// `keep_going` is asked before each solve; once false the sweep ends and says so.
[[nodiscard]] SweepSummary sweep(const Scene& scene, const OrbitSolverOptions& options, SweepSink& sink,
                                 const std::function<bool()>& keep_going);

}  // namespace nsma
