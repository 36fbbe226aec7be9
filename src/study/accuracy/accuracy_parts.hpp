#pragma once

#include <functional>

#include "accuracy.hpp"

namespace nsma {

/// What the parts of the accuracy study share.
class AccuracyRun {
public:
    AccuracyRun(const Scene& scene, const AccuracyOptions& options, AccuracySink& sink,
                const std::function<bool()>& keep_going)
        : scene(scene), quick(options.quick), sizes(accuracy_sizes(options)), sink(sink), keep_going_(keep_going) {}

    /// Before each piece of work: false once the study is to end.
    bool go_on() {
        if (!ended && !keep_going_()) ended = true;
        return !ended;
    }
    void expect(long pieces) { total_ += pieces; }
    void step() { sink.progress(++done_, total_); }

    const Scene& scene;
    bool quick;
    AccuracySizes sizes;
    AccuracySink& sink;
    bool ended = false;

private:
    const std::function<bool()>& keep_going_;
    long done_ = 0;
    long total_ = 0;
};

void study_programs(AccuracyRun& run);   ///< every method and setting on each size
void study_kernels(AccuracyRun& run);    ///< and the tolerances of the dense methods
void study_marching(AccuracyRun& run);   ///< one period, and the drift over many
void study_stability(AccuracyRun& run);  ///< the maps

}  // namespace nsma
