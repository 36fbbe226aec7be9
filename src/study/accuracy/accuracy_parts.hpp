#pragma once

#include <vector>

#include "accuracy.hpp"

namespace nsma {

/// What the study runs on, by size; a closed gap has no such patterns.
struct AccuracySizes {
    std::vector<int> programs;  ///< m of the first-mode programs
    std::vector<int> maps;      ///< m of the level map
    std::vector<int> cells;     ///< N of marching, finite elements likewise
    std::vector<int> kernels;   ///< m of the kernels, N = 5 m/2
    std::vector<int> periods;   ///< of the drift study
    int drift_cells;
    int repeats;  ///< timed runs of the same work
    int starts;   ///< of each program
};

/// What the parts of the accuracy study share.
struct AccuracyRun {
    const Scene& scene;
    bool quick;
    AccuracySizes sizes;
    const std::function<void(const AccuracyRecord&)>& add;
    const std::function<bool(long done, long total)>& keep_going;
    long done = 0;   ///< pieces of work
    long total = 0;  ///< known so far
    bool ended = false;

    /// Before each piece of work: false once the study is to end.
    bool go_on() {
        ended = ended || !keep_going(done, total);
        return !ended;
    }
};

void study_programs(AccuracyRun& run);   ///< every method and setting on each size
void study_kernels(AccuracyRun& run);    ///< and the tolerances of the dense methods
void study_marching(AccuracyRun& run);   ///< one period, and the drift over many
void study_stability(AccuracyRun& run);  ///< the maps

}  // namespace nsma
