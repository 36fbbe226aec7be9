#pragma once

#include <functional>

#include "accuracy_records.hpp"
#include "nsma/study/scene.hpp"

namespace nsma {

/// The first-mode pattern with m = g = gcd(2N, n_T) free amplitudes: n_T/2N = 8/5 for a gap > 0
/// and 7/5 for a gap < 0, where E_min/E_g = 25 and E_max = m E_min for every m. Needs an even m.
/// Source: theory of the nonsmooth modes, backbone.hpp. Throws std::invalid_argument.
[[nodiscard]] Pattern accuracy_pattern(int size, int gap_sign);

/// Speed against accuracy: every method on the same work, in one run. Programs, kernels and
/// marching against exact references, then the maps of where each method fails. Bar, gap and
/// objective are the scene's; times are CPU times of this process, so that other work on the
/// machine does not count. `quick`: small sizes, few repeats, seconds instead of minutes. `add` receives the records
/// as they come. `go_on` is called between pieces of work with those done and all known so far; false is returned
/// when it ended the study. Throws std::invalid_argument for a closed gap or an extreme objective.
bool accuracy(const Scene& scene, bool quick, const std::function<void(const AccuracyRecord&)>& add,
              const std::function<bool(long done, long total)>& go_on);

}  // namespace nsma
