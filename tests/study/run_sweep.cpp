#include "run_sweep.hpp"

#include <chrono>

#include "study/sweep/sweep_queue.hpp"

namespace nsma {

SweepSummary sweep(const Scene& scene, const OrbitSolverOptions& options, SweepSink& sink,
                   const std::function<bool()>& keep_going) {
    const auto begin = std::chrono::steady_clock::now();
    SweepSummary summary;
    SweepQueue queue(scene, options, SweepQueue::Order::scene);
    SweepWorker worker(scene, options);
    while (!queue.finished()) {
        if (!keep_going()) {
            summary.interrupted = true;
            break;
        }
        const WorkResult result = worker.run(queue.next(0).at(0));  // one at a time: the scene's order
        const long before = queue.work_done();
        queue.done(result);
        if (result.record) {
            count(summary, *result.record, scene.all_kinds);
            sink.pattern(*result.record);
        }
        if (result.answer) {
            count(summary, *result.answer, result.place > 0);
            sink.answer(*result.answer);
        }
        if (queue.work_done() > before) sink.progress(queue.work_done(), queue.work_total());
    }
    summary.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return summary;
}

}  // namespace nsma
