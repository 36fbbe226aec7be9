#pragma once

namespace nsma {

/// Limits of one call of Ipopt or NLopt.
struct SolverOptions {
    double tolerance = 1e-8;   ///< relative stopping tolerance handed to the library; polish does the rest
    int max_iterations = 150;  ///< Ipopt iterations; NLopt evaluations are 10 times this
    double time_limit = 10.0;  ///< seconds a call
};

}  // namespace nsma
