#pragma once

#include <functional>
#include <vector>

#include "accuracy_records.hpp"
#include "nsma/study/scene.hpp"

namespace nsma {

struct AccuracyOptions {
    bool quick = false;  ///< small sizes, few repeats: seconds instead of minutes
};

/// What the study runs on, by size; a closed gap has no such patterns.
struct AccuracySizes {
    std::vector<int> programs;  ///< m of the first-mode programs
    std::vector<int> maps;      ///< m of the level map
    std::vector<int> cells;     ///< N of marching, finite elements likewise
    std::vector<int> kernels;   ///< m of the kernels, N = 5 m/2
    std::vector<int> periods;   ///< of the drift study
    int drift_cells = 20;
    int repeats = 5;  ///< timed runs of the same work
    int starts = 3;   ///< starts of each program
};
[[nodiscard]] AccuracySizes accuracy_sizes(const AccuracyOptions& options);

/// The first-mode pattern with m = g = gcd(2N, n_T) free amplitudes: n_T/2N = 8/5 for a gap > 0
/// and 7/5 for a gap < 0, where E_min/E_g = 25 and E_max = m E_min for every m. Needs an even m.
/// Source: theory of the nonsmooth modes, backbone.hpp. Throws std::invalid_argument.
[[nodiscard]] Pattern accuracy_pattern(int size, int gap_sign);

/// Speed against accuracy: every method on the same work, in one run. Programs, kernels and
/// marching against exact references, then the maps of where each method fails. Bar, gap and
/// objective are the scene's; times are CPU times of this process, so that other work on the
/// machine does not count. `keep_going` is asked between pieces of work; false is returned when
/// it ended the study. Throws std::invalid_argument for a closed gap or an extreme objective.
bool accuracy(const Scene& scene, const AccuracyOptions& options, AccuracySink& sink,
              const std::function<bool()>& keep_going);

}  // namespace nsma
