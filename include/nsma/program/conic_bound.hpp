#pragma once

#include <functional>

#include <Eigen/Core>

#include "nsma/program/program.hpp"

namespace nsma {

struct ConicBoundOptions {
    int max_iterations = 20'000;     ///< of one relaxation
    int node_limit = 32;             ///< relaxations in all
    double target_tolerance = 1e-7;  ///< stop once within this of the target, relative
    /// Offered the mean of each relaxed solution as a start; returns the best objective known,
    /// which becomes the target. Not called without COND2.
    std::function<double(const Eigen::VectorXd&)> improve;
};

struct ConicBound {
    double value = -no_bound;  ///< lower bound on the objective, in the program's scale
    int nodes = 0;             ///< relaxations solved
    int iterations = 0;        ///< of the splitting method, over all of them
};

/// Lower bound on a program whose inequalities are homogeneous: every constraint except the
/// sphere and COND2 is a cone x >= 0, -rows x >= 0, so products of its members are nonnegative
/// and  C + mu I + nu a a' - V' N V >= 0 (semidefinite), N >= 0  gives
/// objective >= -mu - nu e^2 for a . x = e. The multipliers come from the alternating direction
/// method on that relaxation (doubly nonnegative); any of them are valid, since mu is set from
/// the least eigenvalue found in the end. The set is then cut in two by planes, the worst
/// bound first, until the target is met or the node limit ends it.
/// `target`, the objective of a known point, only ends the search early. -infinity where the
/// program has no such form (a linear term without COND2, unknowns off the sphere).
/// Source: Wen, Goldfarb, Yin, Math. Prog. Comp. 2 (2010) 203-230 for the method.
[[nodiscard]] ConicBound conic_bound(const Program& program, double target,
                                     const ConicBoundOptions& options = {});

/// Lower bound of the same form without iterations, in the program's scale: N takes off every
/// positive product of two bounded unknowns, and mu and nu follow from an eigenvalue. Tight where
/// the best point lies on an edge of the bounds. -infinity as above.
[[nodiscard]] double product_bound(const Program& program);

}  // namespace nsma
