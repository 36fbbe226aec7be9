#pragma once

#include <functional>

#include "nsma/orbit/sieve.hpp"
#include "nsma/search/pattern_problem.hpp"
#include "nsma/study/records.hpp"
#include "nsma/study/scene.hpp"

namespace nsma {

/// Verdict and energy interval of one pattern for a gap of the given sign.
[[nodiscard]] PatternRecord pattern_record(const PatternProblem& problem, int gap_sign, double seconds);

/// What stands behind the verdicts of a scan.
enum class ScanMethod {
    certified,  ///< closed form with an exact certificate of every pattern
    integers    ///< the sieve alone
};

/// Scans every pattern of the scene in its order, trivial ones included, and hands each record
/// on as it comes. `keep_going` is asked before each pattern.
void scan(const Scene& scene, const std::function<void(const PatternRecord&)>& record,
          const std::function<bool()>& keep_going, ScanMethod method = ScanMethod::certified);

}  // namespace nsma
