#pragma once

#include "numerics/solver.hpp"

namespace nsma {

/// A call of NLopt in a child process that is killed `limit` seconds (rounded up) after it began, for methods that can
/// ignore their own limits. A killed child, or none, gives NaN and the status "KILLED"; seconds are CPU seconds of the
/// child.
[[nodiscard]] SolverOutcome solve_guarded(NloptMethod method, const Program& program, const Eigen::VectorXd& start,
                                          const SolverOptions& options, double limit);

}  // namespace nsma
