#include "nsma/study/sensitivity/sensitivity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "nsma/orbit/backbone.hpp"
#include "nsma/numerics/interruption.hpp"
#include "nsma/search/pattern_problem.hpp"
#include "price/relaxed_solver.hpp"
#include "price/tied_optima.hpp"

namespace nsma {
namespace {

// What is relaxed along a curve, alone and in pairs: 1 for each condition.
constexpr std::array<std::pair<const char*, Relaxation>, 6> studies{{{"penetration", {1, 0, 0}},
                                                                     {"band", {0, 1, 0}},
                                                                     {"adhesion", {0, 0, 1}},
                                                                     {"penetration+band", {1, 1, 0}},
                                                                     {"penetration+adhesion", {1, 0, 1}},
                                                                     {"band+adhesion", {0, 1, 1}}}};

// omega against s = sqrt(E_g/E) from two stored neighbours of the mode: T is linear in s.
void compare_frequency(IntervalRecord& record, int gap_sign) {
    if (!record.mode || !record.frequency_by_gap) return;
    const auto patterns = mode_patterns(*record.mode, record.pattern.cells, gap_sign);
    const auto here = std::find(patterns.begin(), patterns.end(), record.pattern);
    if (here == patterns.end() || patterns.size() < 2) return;
    const Pattern& before = here == patterns.begin() ? *here : *(here - 1);
    const Pattern& after = here + 1 == patterns.end() ? *here : *(here + 1);
    const auto inverse_root = [&](const Pattern& pattern) {
        return 1.0 / std::sqrt(relaxed_interval(relaxed_set(exact_kernel(pattern), gap_sign), {}, false).least);
    };
    const double slope = (after.period_ratio() - before.period_ratio()) / (inverse_root(after) - inverse_root(before));
    record.frequency_by_gap_difference = -slope / (std::sqrt(record.least) * record.pattern.period_ratio());
    record.frequency_by_energy_difference = -0.5 * *record.frequency_by_gap_difference;
}

class Sensitivity {
public:
    Sensitivity(const Scene& scene, const SensitivityRequest& request, const std::function<bool()>& keep_going)
        : scene_(scene),
          request_(request),
          keep_going_(keep_going),
          solver_(request.solver),
          gap_sign_(scene.bar.gap_sign()) {}

    SensitivityRecords run(const std::function<void(long, long)>& progress) {
        const std::vector<Pattern> patterns =
            request_.pattern ? std::vector<Pattern>{*request_.pattern} : patterns_of(scene_);
        try {
            for (const Pattern& pattern : patterns) {
                go_on();
                visit(pattern);
                if (progress) progress(summary_.patterns, static_cast<long>(patterns.size()));
            }
        } catch (const Interrupted&) {
            summary_.interrupted = true;
        }
        return std::move(records_);
    }

private:
    void go_on() const {
        if (!keep_going_()) throw Interrupted();
    }

    void visit(const Pattern& pattern) {
        ++summary_.patterns;
        PatternOptions options;
        options.prove = false;
        const PatternProblem problem = pattern_problem(pattern, gap_sign_, options);
        if (problem.verdict == Verdict::failed) {
            ++summary_.failed;
            return;
        }
        records_.ablations.push_back(ablation_record(problem.kernel, gap_sign_));
        if (problem.verdict == Verdict::trivial) return;
        const RelaxedSet set = relaxed_set(problem.kernel, gap_sign_);
        if (problem.verdict != Verdict::admissible) {
            if (gap_sign_ != 0) curves(set, false, {});
            return;
        }
        ++summary_.admissible;
        if (!request_.pattern && !is_solved(scene_.all_kinds, problem.kind)) {
            ++summary_.left;
            return;
        }
        const std::vector<OptimumRecord> found = optima(problem);
        records_.optima.insert(records_.optima.end(), found.begin(), found.end());
        if (gap_sign_ == 0) return;
        interval(set);
        curves(set, true, found);
    }

    // At every level asked.
    [[nodiscard]] std::vector<OptimumRecord> optima(const PatternProblem& problem) {
        std::vector<std::optional<double>> levels;
        if (gap_sign_ != 0) levels.emplace_back();
        if (request_.pattern) {
            if (request_.level) levels = {request_.level};
        } else if (!is_extreme(scene_.objective)) {
            levels.insert(levels.end(), scene_.levels.begin(), scene_.levels.end());
        }
        std::vector<OptimumRecord> found;
        OrbitRequest wanted;
        Eigen::VectorXd before;  // window of the orbit before, which `nearest` stays near, as in a sweep
        for (const auto& level : levels) {
            go_on();
            wanted.level = level;
            wanted.objective =
                level || scene_.objective == Objective::max_energy ? scene_.objective : Objective::min_energy;
            wanted.reference = wanted.objective == Objective::nearest ? before : Eigen::VectorXd();
            const OrbitAnswer answer = solver_.solve(scene_.bar, problem, wanted);
            if (answer.verdict == Verdict::failed) ++summary_.failed;
            if (!answer.orbit) continue;
            found.push_back(optimum_record(*answer.orbit, gap_sign_, scene_.objective, level, answer.reference));
            found.back().global = proved_best(answer);
            if (level && scene_.objective == Objective::nearest) before = reference_window(*answer.orbit);
            count(found.back());
        }
        return found;
    }

    void count(const OptimumRecord& record) {
        ++summary_.optima;
        if (record.nondegenerate) ++summary_.nondegenerate;
        if (record.tied > 1) ++summary_.tied;
        if (!record.refusal.empty()) {
            ++summary_.refused;
            return;
        }
        if (record.euler_defect) summary_.worst_euler = std::max(summary_.worst_euler, *record.euler_defect);
        if (record.kkt_residual) summary_.worst_kkt = std::max(summary_.worst_kkt, *record.kkt_residual);
    }

    void interval(const RelaxedSet& set) {
        IntervalRecord record = interval_record(set);
        compare_frequency(record, gap_sign_);
        if (record.frequency_by_gap_difference) {
            const double off = std::abs(*record.frequency_by_gap_difference / *record.frequency_by_gap - 1);
            summary_.worst_frequency = std::max(summary_.worst_frequency, off);
        }
        records_.intervals.push_back(std::move(record));
    }

    // Relaxation curves; those of the objective at the middle level solved.
    void curves(const RelaxedSet& set, bool admissible, std::vector<OptimumRecord> solved) {
        std::erase_if(solved, [](const OptimumRecord& record) { return !record.level; });
        RelaxedRequest wanted;
        wanted.objective = scene_.objective;
        wanted.starts = 4;
        std::vector<Eigen::VectorXd> optima;  // the best orbit without a relaxation, and those that tie with it
        if (!solved.empty() && scene_.objective != Objective::nearest) {
            const OptimumRecord& middle = solved[solved.size() / 2];
            wanted.level = *middle.level;
            optima = tied_optima(set, scene_.objective, middle.orbit.beta).others;
            optima.push_back(middle.orbit.beta);
        }
        for (const auto& [relaxed, unit] : studies) {
            wanted.near = optima;
            for (const double amount : request_.amounts) {
                go_on();
                CurveRecord record;
                record.pattern = set.kernel.pattern;
                record.relaxed = relaxed;
                record.amount = amount;
                wanted.shift = set.shift({amount * unit.penetration, amount * unit.band, amount * unit.adhesion});
                // Of patterns that no orbit meets at zero only their number is of interest.
                const RelaxedInterval interval = relaxed_interval(set, wanted.shift, admissible);
                record.failed = interval.failed;
                record.admissible = !interval.failed && !interval.empty;
                record.unbounded = interval.unbounded;
                if (record.admissible) record.least = interval.least;
                if (record.admissible && admissible && !interval.unbounded) record.greatest = interval.greatest;
                if (record.admissible && !optima.empty()) {
                    record.level = wanted.level;
                    if (const auto best = relaxed_optimum(set, interval, wanted)) {
                        record.objective = best->objective;
                        wanted.near = optima;
                        wanted.near.push_back(best->beta);
                    }
                }
                records_.curves.push_back(std::move(record));
            }
        }
    }

    const Scene& scene_;
    const SensitivityRequest& request_;
    const std::function<bool()>& keep_going_;
    OrbitSolver solver_;
    int gap_sign_;
    SensitivityRecords records_;
    SensitivitySummary& summary_ = records_.summary;
};

}  // namespace

SensitivityRecords sensitivity(const Scene& scene, const SensitivityRequest& request,
                               const std::function<bool()>& keep_going,
                               const std::function<void(long, long)>& progress) {
    return Sensitivity(scene, request, keep_going).run(progress);
}

}  // namespace nsma
