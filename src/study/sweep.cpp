#include "nsma/study/sweep.hpp"

#include <algorithm>
#include <chrono>

#include "nsma/study/scan.hpp"

namespace nsma {
namespace {

bool extreme(Objective objective) {
    return objective == Objective::min_energy || objective == Objective::max_energy;
}

void count(SweepSummary& summary, const PatternRecord& record) {
    ++summary.patterns;
    if (!record.proved) ++summary.unproved;
    const auto& interval = record.interval;
    if (record.verdict == Verdict::admissible && record.gap_sign != 0 && !interval.unbounded &&
        interval.greatest_exact.empty()) {
        ++summary.open_bounds;
    }
    switch (record.verdict) {
        case Verdict::trivial: ++summary.trivial; break;
        case Verdict::inadmissible: ++summary.inadmissible; break;
        case Verdict::admissible: ++summary.admissible; break;
        default: ++summary.failed_patterns; break;
    }
}

// The least-energy orbit counts only when it failed or its replay is the worst.
void count(SweepSummary& summary, const OrbitAnswer& answer, bool asked) {
    if (asked) ++summary.levels;
    const bool solved = answer.verdict == Verdict::admissible;
    if (solved) {
        summary.worst_violation = std::max(summary.worst_violation, answer.replay->violations.worst());
    }
    if (answer.verdict == Verdict::failed) ++summary.failed;
    if (!asked) return;
    if (answer.verdict == Verdict::below) ++summary.below;
    if (answer.verdict == Verdict::above) ++summary.above;
    if (answer.verdict == Verdict::undecided) ++summary.undecided;
    if (!solved) return;
    ++summary.solved;
    if (answer.optimality && answer.optimality->global) {
        ++summary.global;
    } else {
        const bool bounded = answer.optimality && answer.optimality->lower_bound;
        summary.worst_gap = std::max(summary.worst_gap, bounded ? answer.optimality->gap : 1.0);
    }
    switch (answer.agreement) {
        case Agreement::not_needed: ++summary.closed_form; break;
        case Agreement::agree: ++summary.agreed; break;
        case Agreement::different_optimum: ++summary.disagreed; break;
        case Agreement::one_failed: ++summary.one_failed; break;
        case Agreement::both_failed: ++summary.failed; break;
        case Agreement::single: break;
    }
}

class Sweep {
public:
    Sweep(const Scene& scene, const OrbitSolverOptions& options, SweepSink& sink,
          const std::function<bool()>& keep_going)
        : scene_(scene), solver_(options), sink_(sink), keep_going_(keep_going),
          levels_per_pattern_(extreme(scene.objective) ? 1 : static_cast<long>(scene.levels.size())) {}

    SweepSummary run() {
        const auto begin = std::chrono::steady_clock::now();
        const auto patterns = patterns_of(scene_);
        // A pattern counts as one piece of work until it is known to be admissible.
        total_ = static_cast<long>(patterns.size());
        for (const auto& pattern : patterns) {
            if (!go_on()) break;
            visit(pattern);
        }
        summary_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        return summary_;
    }

private:
    bool go_on() {
        if (!summary_.interrupted && !keep_going_()) summary_.interrupted = true;
        return !summary_.interrupted;
    }

    void step() { sink_.progress(++done_, total_); }

    void visit(const Pattern& pattern) {
        const auto begin = std::chrono::steady_clock::now();
        const PatternProblem problem = pattern_problem(pattern, scene_.bar.gap_sign());
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
        const PatternRecord record = pattern_record(problem, scene_.bar.gap_sign(), elapsed.count());
        count(summary_, record);
        sink_.pattern(record);
        if (problem.verdict == Verdict::admissible) {
            total_ += levels_per_pattern_;
            answer_levels(problem);
        }
        step();
    }

    void answer_levels(const PatternProblem& problem) {
        OrbitRequest request;
        request.objective = scene_.objective;
        if (extreme(scene_.objective)) {
            if (go_on()) solve(problem, request, true);
            return;
        }
        if (scene_.bar.gap_sign() != 0) {
            if (!go_on()) return;
            OrbitRequest least;
            least.objective = scene_.objective;
            solve(problem, least, false);
        }
        for (const double level : scene_.levels) {
            if (!go_on()) return;
            request.level = level;
            const OrbitAnswer answer = solve(problem, request, true);
            if (scene_.objective == Objective::nearest && answer.orbit) {
                request.reference = reference_window(*answer.orbit);
            }
        }
    }

    OrbitAnswer solve(const PatternProblem& problem, const OrbitRequest& request, bool asked) {
        OrbitAnswer answer = solver_.solve(scene_.bar, problem, request);
        count(summary_, answer, asked);
        sink_.answer(answer);
        if (asked) step();
        return answer;
    }

    const Scene& scene_;
    OrbitSolver solver_;
    SweepSink& sink_;
    const std::function<bool()>& keep_going_;
    long levels_per_pattern_;
    SweepSummary summary_;
    long done_ = 0;
    long total_ = 0;
};

}  // namespace

SweepSummary sweep(const Scene& scene, const OrbitSolverOptions& options, SweepSink& sink,
                   const std::function<bool()>& keep_going) {
    return Sweep(scene, options, sink, keep_going).run();
}

}  // namespace nsma
