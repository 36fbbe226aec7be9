#include "nsma/study/scan.hpp"

#include <chrono>

namespace nsma {

PatternRecord pattern_record(const PatternProblem& problem, int gap_sign, double seconds) {
    PatternRecord record;
    record.pattern = problem.kernel.pattern;
    record.gap_sign = gap_sign;
    record.kernel_dimension = problem.kernel.dimension();
    record.verdict = problem.verdict;
    record.interval = problem.interval;
    record.proved = problem.proof.verdict_proved;
    record.reason = problem.set.reason;
    if (!problem.proof.unproved.empty()) {
        if (!record.reason.empty()) record.reason += "; ";
        record.reason += "unproved: " + problem.proof.unproved;
    }
    record.seconds = seconds;
    return record;
}

void scan(const Scene& scene, const std::function<void(const PatternRecord&)>& record,
          const std::function<bool()>& keep_going) {
    const int gap_sign = scene.bar.gap_sign();
    for (const auto& pattern : patterns_of(scene)) {
        if (!keep_going()) return;
        const auto begin = std::chrono::steady_clock::now();
        const PatternProblem problem = pattern_problem(pattern, gap_sign);
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
        record(pattern_record(problem, gap_sign, elapsed.count()));
    }
}

}  // namespace nsma
