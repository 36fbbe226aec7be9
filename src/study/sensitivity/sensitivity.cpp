#include "nsma/study/sensitivity/sensitivity.hpp"

#include <algorithm>
#include <cmath>

#include "nsma/orbit/backbone.hpp"
#include "price/relaxed_solver.hpp"
#include "price/tied_optima.hpp"

namespace nsma {
namespace {

struct Study {
    std::string name;
    Relaxation unit;  // 1 for each condition relaxed
};

const std::array<Study, 6>& studies() {
    static const std::array<Study, 6> all{{{"penetration", {1, 0, 0}},
                                           {"band", {0, 1, 0}},
                                           {"adhesion", {0, 0, 1}},
                                           {"penetration+band", {1, 1, 0}},
                                           {"penetration+adhesion", {1, 0, 1}},
                                           {"band+adhesion", {0, 1, 1}}}};
    return all;
}

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
    Sensitivity(const Scene& scene, const SensitivityRequest& request, SensitivitySink& sink,
                const std::function<bool()>& keep_going)
        : scene_(scene),
          request_(request),
          sink_(sink),
          keep_going_(keep_going),
          solver_(request.solver),
          gap_sign_(scene.bar.gap_sign()) {}

    SensitivitySummary run() {
        const std::vector<Pattern> patterns =
            request_.pattern ? std::vector<Pattern>{*request_.pattern} : patterns_of(scene_);
        total_ = static_cast<long>(patterns.size());
        for (const Pattern& pattern : patterns) {
            if (!keep_going_()) {
                summary_.interrupted = true;
                break;
            }
            visit(pattern);
            sink_.progress(++done_, total_);
        }
        return summary_;
    }

private:
    void visit(const Pattern& pattern) {
        ++summary_.patterns;
        PatternOptions options;
        options.prove = false;
        const PatternProblem problem = pattern_problem(pattern, gap_sign_, options);
        if (problem.verdict == Verdict::failed) ++summary_.failed;
        sink_.ablation(ablation_record(problem.kernel, gap_sign_));
        if (problem.verdict == Verdict::trivial || problem.verdict == Verdict::failed) return;
        const RelaxedSet set = relaxed_set(problem.kernel, gap_sign_);
        const bool admissible = problem.verdict == Verdict::admissible;
        if (admissible) ++summary_.admissible;
        if (admissible && !request_.pattern && !is_solved(scene_.all_kinds, problem.kind)) {
            ++summary_.left;
            return;
        }
        if (admissible) {
            optima(problem);
            if (gap_sign_ != 0) {
                IntervalRecord record = interval_record(set);
                compare_frequency(record, gap_sign_);
                if (record.frequency_by_gap_difference) {
                    summary_.worst_frequency =
                        std::max(summary_.worst_frequency,
                                 std::abs(*record.frequency_by_gap_difference / *record.frequency_by_gap - 1));
                }
                sink_.interval(record);
            }
        }
        if (gap_sign_ != 0) curves(set, admissible);
    }

    // Every level asked. Relaxation curves are drawn at the middle one solved.
    void optima(const PatternProblem& problem) {
        solved_.clear();
        solved_levels_.clear();
        std::vector<std::optional<double>> levels;
        const bool extreme = is_extreme(scene_.objective);
        if (gap_sign_ != 0) levels.emplace_back();
        if (request_.pattern) {
            if (request_.level) levels = {request_.level};
        } else if (!extreme) {
            levels.insert(levels.end(), scene_.levels.begin(), scene_.levels.end());
        }
        OrbitRequest wanted;
        Eigen::VectorXd before;  // window of the orbit before, which `nearest` stays near, as in a sweep
        for (const auto& level : levels) {
            if (!keep_going_()) break;
            wanted.level = level;
            wanted.objective =
                level || scene_.objective == Objective::max_energy ? scene_.objective : Objective::min_energy;
            wanted.reference = wanted.objective == Objective::nearest ? before : Eigen::VectorXd();
            const OrbitAnswer answer = solver_.solve(scene_.bar, problem, wanted);
            if (answer.verdict == Verdict::failed) ++summary_.failed;
            if (!answer.orbit) continue;
            if (level) {
                solved_.push_back(answer.orbit->beta);
                solved_levels_.push_back(*level);
            }
            OptimumRecord record = optimum_record(*answer.orbit, gap_sign_, scene_.objective, level, answer.reference);
            record.global = proved_best(answer);
            if (level && scene_.objective == Objective::nearest) before = reference_window(*answer.orbit);
            count(record);
            sink_.optimum(record);
        }
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

    void curves(const RelaxedSet& set, bool admissible) {
        std::optional<double> level;
        std::vector<Eigen::VectorXd> optima;  // the best orbit without a relaxation, and those that tie with it
        if (!solved_.empty() && admissible && scene_.objective != Objective::nearest) {
            const std::size_t middle = solved_.size() / 2;
            level = solved_levels_[middle];
            optima = tied_optima(set, scene_.objective, solved_[middle]).others;
            optima.push_back(solved_[middle]);
        }
        for (const Study& study : studies()) {
            std::vector<Eigen::VectorXd> near = optima;
            for (const double amount : request_.amounts) {
                if (!keep_going_()) return;
                CurveRecord record;
                record.pattern = set.kernel.pattern;
                record.relaxed = study.name;
                record.amount = amount;
                const Relaxation relaxation{amount * study.unit.penetration, amount * study.unit.band,
                                            amount * study.unit.adhesion};
                const Shift shift = set.shift(relaxation);
                // Of patterns that no orbit meets at zero only their number is of interest.
                const RelaxedInterval interval = relaxed_interval(set, shift, admissible);
                record.failed = interval.failed;
                record.admissible = !interval.failed && !interval.empty;
                if (record.admissible) record.least = interval.least;
                record.unbounded = interval.unbounded;
                if (record.admissible && admissible && !interval.unbounded) record.greatest = interval.greatest;
                if (record.admissible && admissible && level) {
                    record.level = level;
                    RelaxedRequest wanted;
                    wanted.objective = scene_.objective;
                    wanted.level = level;
                    wanted.shift = shift;
                    wanted.near = near;
                    wanted.starts = 4;
                    const RelaxedOptimum best = relaxed_optimum(set, interval, wanted);
                    if (best.status == RelaxedOptimum::Status::optimal) {
                        record.objective = best.objective;
                        near = optima;
                        near.push_back(best.beta);
                    }
                }
                sink_.curve(record);
            }
        }
    }

    const Scene& scene_;
    const SensitivityRequest& request_;
    SensitivitySink& sink_;
    const std::function<bool()>& keep_going_;
    OrbitSolver solver_;
    int gap_sign_;
    std::vector<Eigen::VectorXd> solved_;  // beta, of the pattern in hand
    std::vector<double> solved_levels_;
    SensitivitySummary summary_;
    long done_ = 0;
    long total_ = 0;
};

}  // namespace

SensitivitySummary sensitivity(const Scene& scene, const SensitivityRequest& request, SensitivitySink& sink,
                               const std::function<bool()>& keep_going) {
    return Sensitivity(scene, request, sink, keep_going).run();
}

}  // namespace nsma
