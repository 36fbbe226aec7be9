#include "nsma/study/scan.hpp"

#include <chrono>

namespace nsma {

PatternRecord pattern_record(const PatternProblem& problem, int gap_sign, double seconds) {
    PatternRecord record;
    record.pattern = problem.kernel.pattern;
    record.gap_sign = gap_sign;
    record.kernel_dimension = problem.kernel.dimension();
    record.verdict = problem.verdict;
    record.kind = problem.kind;
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

namespace {

// The argument of a finding, one line.
std::string_view argument(Finding finding) {
    switch (finding) {
        case Finding::trivial: return "the kernel is trivial";
        case Finding::sign_conflict: return "COND3 bounds every amplitude from both sides";
        case Finding::wrong_side: return "COND3 keeps the tip on one side: COND2 cannot hold";
        case Finding::penetrates: return "COND1 is violated by every motion that COND3 allows";
        case Finding::admissible: break;
    }
    return "";
}

PatternRecord sieved_record(const Pattern& pattern, int gap_sign, const Sieved& sieved) {
    PatternRecord record;
    record.pattern = pattern;
    record.gap_sign = gap_sign;
    record.kernel_dimension = sieved.kernel_dimension;
    record.reason = argument(sieved.finding);
    if (sieved.finding != Finding::admissible) {
        record.verdict = sieved.finding == Finding::trivial ? Verdict::trivial : Verdict::inadmissible;
        return record;
    }
    record.verdict = Verdict::admissible;
    record.kind = pattern_kind(pattern);
    record.interval.unbounded = sieved.unbounded;
    record.interval.least = sieved.energy_least;
    if (!sieved.unbounded) record.interval.greatest = sieved.energy_greatest;
    return record;
}

}  // namespace

void scan(const Scene& scene, const std::function<void(const PatternRecord&)>& record,
          const std::function<bool()>& keep_going, ScanMethod method) {
    const int gap_sign = scene.bar.gap_sign();
    Sieve sieve(scene.mesh.cells, gap_sign);
    for (const auto& pattern : patterns_of(scene)) {
        if (!keep_going()) return;
        const auto begin = std::chrono::steady_clock::now();
        PatternRecord found;
        if (method == ScanMethod::certified) {
            found = pattern_record(pattern_problem(pattern, gap_sign), gap_sign, 0.0);
        } else {
            found = sieved_record(pattern, gap_sign, sieve(pattern.free_steps, pattern.contact_steps));
        }
        found.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        record(found);
    }
}

}  // namespace nsma
