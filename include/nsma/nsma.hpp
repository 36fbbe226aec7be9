#pragma once

// Every public header, for programs that use the library; the library itself includes what it needs.
#include "nsma/wave/bar.hpp"
#include "nsma/wave/marcher.hpp"
#include "nsma/wave/mesh.hpp"
#include "nsma/wave/state.hpp"
#include "nsma/orbit/backbone.hpp"
#include "nsma/orbit/classification.hpp"
#include "nsma/orbit/conditions.hpp"
#include "nsma/orbit/kernel.hpp"
#include "nsma/orbit/motion_label.hpp"
#include "nsma/orbit/orbit.hpp"
#include "nsma/orbit/pattern.hpp"
#include "nsma/orbit/pattern_kind.hpp"
#include "nsma/orbit/physical_values.hpp"
#include "nsma/orbit/replay.hpp"
#include "nsma/orbit/sieve.hpp"
#include "nsma/numerics/exact.hpp"
#include "nsma/numerics/interruption.hpp"
#include "nsma/numerics/solver_options.hpp"
#include "nsma/set/admissible_set.hpp"
#include "nsma/set/energy_interval.hpp"
#include "nsma/set/objective.hpp"
#include "nsma/set/reduction.hpp"
#include "nsma/check/certificate.hpp"
#include "nsma/proof/prove.hpp"
#include "nsma/search/answer.hpp"
#include "nsma/search/orbit_solver.hpp"
#include "nsma/search/pattern_problem.hpp"
#include "nsma/price/relaxed_set.hpp"
#include "nsma/price/shadow_prices.hpp"
#include "nsma/study/records.hpp"
#include "nsma/study/scan.hpp"
#include "nsma/study/scene.hpp"
#include "nsma/study/sensitivity/sensitivity.hpp"
#include "nsma/report/input_error.hpp"
#include "nsma/report/orbit_json.hpp"
#include "nsma/report/scene_file.hpp"

/// Nonsmooth modal analysis of a bar in unilateral contact: bars and their motions (wave), patterns and orbits (orbit),
/// admissible sets (set), proofs (check, proof), optima (search), shadow prices (price), studies (study) and scene
/// files (report). [1] is C. Yoong, A. Thorin, M. Legrand 2016, hal-01408111.
namespace nsma {}
