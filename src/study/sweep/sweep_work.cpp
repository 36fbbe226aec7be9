#include "sweep_work.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "orbit/index.hpp"
#include "nsma/search/certified_optimum.hpp"
#include "nsma/study/scan.hpp"

namespace nsma {
namespace {

// Levels that the verdicts of one message bring with them: it stays below a megabyte.
constexpr int most_brought = 1024;

}  // namespace

void count(SweepSummary& summary, const PatternRecord& record, bool all_kinds) {
    ++summary.patterns;
    if (record.kind) {
        ++summary.kinds[static_cast<std::size_t>(*record.kind)];
        if (!is_solved(all_kinds, record.kind)) ++summary.left;
    }
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

void count(SweepSummary& summary, const OrbitAnswer& answer, bool asked) {
    if (asked) ++summary.levels;
    const bool solved = answer.verdict == Verdict::admissible;
    if (solved) {
        summary.worst_violation = std::max(summary.worst_violation, answer.replay->violations.worst());
        if (const auto& proof = answer.exact_proof) {
            ++summary.certificates;
            summary.certificate_bytes += static_cast<std::int64_t>(proof->certificate.size()) + 1;
            summary.check_seconds += proof->check_seconds;
        }
    }
    if (answer.verdict == Verdict::failed) ++summary.failed;
    if (!asked) return;
    if (answer.verdict == Verdict::below) ++summary.below;
    if (answer.verdict == Verdict::above) ++summary.above;
    if (answer.verdict == Verdict::undecided) ++summary.undecided;
    if (!solved) return;
    ++summary.solved;
    if (proved_exactly(answer)) ++summary.proved_exactly;
    if (proved_best(answer)) {
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

SweepWorker::SweepWorker(const Scene& scene, const OrbitSolverOptions& options, CertificateText certificate_text)
    : scene_(scene), patterns_(patterns_of(scene)), solver_(options), certificate_text_(std::move(certificate_text)) {}

WorkResult SweepWorker::run(const WorkUnit& unit) {
    if (unit.pattern < 0 || index(unit.pattern) >= patterns_.size()) {
        throw std::invalid_argument("unit.pattern: expected 0.." + std::to_string(patterns_.size()) +
                                    " (excluded), got " + std::to_string(unit.pattern));
    }
    WorkResult result{unit.pattern, unit.place, std::nullopt, std::nullopt};
    if (unit.place < 0 || held_ != unit.pattern) {
        const auto begin = std::chrono::steady_clock::now();
        held_ = -1;
        problem_ = pattern_problem(patterns_[index(unit.pattern)], scene_.bar.gap_sign());
        held_ = unit.pattern;
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
        if (unit.place < 0) {
            result.record = pattern_record(problem_, scene_.bar.gap_sign(), elapsed.count());
            return result;
        }
    }
    OrbitRequest request;
    request.objective = scene_.objective;
    if (unit.place > 0 && !is_extreme(scene_.objective)) {
        request.level = scene_.levels.at(static_cast<std::size_t>(unit.place) - 1);
        if (!unit.before.empty()) {
            request.start =
                Eigen::Map<const Eigen::VectorXd>(unit.before.data(), static_cast<Eigen::Index>(unit.before.size()));
            if (scene_.objective == Objective::nearest) {
                request.reference = reference_window(make_orbit(scene_.bar, problem_.kernel, request.start));
            }
        }
    }
    OrbitAnswer& answer = result.answer.emplace(solver_.solve(scene_.bar, problem_, request));
    if (certificate_text_ && answer.orbit) {
        if (const OptimumProof proof = certified_optimum(problem_, answer); proof.certificate)
            answer.exact_proof = {proof.gap, proof.check_seconds, certificate_text_(*proof.certificate)};
    }
    return result;
}

std::vector<WorkResult> SweepWorker::run(const std::vector<WorkUnit>& units) {
    std::vector<WorkResult> results;
    int brought = 0;
    for (const WorkUnit& unit : units) {
        results.push_back(run(unit));
        if (unit.place >= 0 || !is_solved(scene_.all_kinds, problem_.kind) || is_extreme(scene_.objective)) continue;
        for (std::size_t level = 0; level < scene_.levels.size() && brought < most_brought; ++level) {
            if (!outside(problem_.interval, scene_.levels[level])) continue;
            results.push_back(run(WorkUnit{unit.pattern, static_cast<int>(level) + 1, {}}));
            ++brought;
        }
    }
    return results;
}

}  // namespace nsma
