#include "nsma/search/pattern_problem.hpp"

#include <string>
#include <utility>

namespace nsma {
namespace {

// The ends of the interval as the certificate proves them.
void take_proved_ends(const Proof& proof, EnergyInterval& interval) {
    const Certificate& certificate = proof.certificate;
    if (proof.verdict_proved && certificate.energy_least) {
        interval.least = to_double(*certificate.energy_least);
        interval.least_exact = to_string(*certificate.energy_least);
    }
    if (certificate.energy_attained) interval.greatest = to_double(*certificate.energy_attained);
    if (certificate.energy_bound) interval.bound = to_double(*certificate.energy_bound);
    if (certificate.energy_attained && proof.exact_greatest()) {
        interval.greatest_exact = to_string(*certificate.energy_attained);
    }
}

}  // namespace

PatternProblem pattern_problem(const Pattern& pattern, int gap_sign, const PatternOptions& options) {
    validate(pattern);
    PatternProblem problem;
    problem.kernel = exact_kernel(pattern);
    const Conditions limits = conditions(problem.kernel, gap_sign);
    const bool many = problem.kernel.dimension() > max_unknowns;
    const bool chain = many && limits.bound_of.front() == Conditions::Sign::free;
    Reduction reduction = chain ? Reduction() : reduce(limits);
    if (many && (chain || reduction.empty_because.empty())) {
        problem.verdict = Verdict::failed;
        problem.set.reason = "expected at most " + std::to_string(max_unknowns) + " unknowns, got " +
                             std::to_string(problem.kernel.dimension()) + "; scan --method integers gives the verdict";
        return problem;
    }
    problem.set = admissible_set(std::move(reduction));
    if (problem.kernel.dimension() == 0) {
        problem.verdict = Verdict::trivial;
    } else if (problem.set.status == AdmissibleSet::Status::empty) {
        problem.verdict = Verdict::inadmissible;
    } else {
        problem.verdict = Verdict::admissible;
        problem.kind = pattern_kind(pattern);
    }
    problem.interval = problem.set.interval();
    if (options.prove) {
        problem.proof = prove(problem.kernel, problem.set);
        take_proved_ends(problem.proof, problem.interval);
    }
    return problem;
}

}  // namespace nsma
