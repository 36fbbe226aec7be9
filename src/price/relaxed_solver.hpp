#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "relaxed_program.hpp"
#include "nsma/price/relaxed_set.hpp"

namespace nsma {

/// Whether any motion but rest meets the relaxed conditions, by linear programs (CLP); an infinite relaxation drops a
/// condition.
[[nodiscard]] bool attainable(const RelaxedSet& set, const Shift& shift);

/// Attainable energies of a relaxed set, in the energy unit.
struct RelaxedInterval {
    bool failed = false;          ///< a linear or quadratic program did not end
    bool empty = false;           ///< no orbit meets the relaxed conditions
    double least = 0;             ///< E_min, a convex quadratic program
    Eigen::VectorXd least_point;  ///< beta
    bool unbounded = false;
    double greatest = 0;                    ///< greatest energy found at a vertex; when bounded
    std::vector<Eigen::VectorXd> vertices;  ///< beta, the greatest energy first
    Eigen::VectorXd ray;                    ///< beta; unbounded only
};

/// Linear programs (CLP) decide emptiness and unboundedness and climb to vertices; the least
/// energy is polished. `greatest = false` leaves the vertices out. Nonempty for a closed gap
/// means: more than rest.
[[nodiscard]] RelaxedInterval relaxed_interval(const RelaxedSet& set, const Shift& shift = {}, bool greatest = true);

/// Best orbit of a relaxed program.
struct RelaxedOptimum {
    Eigen::VectorXd beta;
    double objective = 0;  ///< as reported by objective_of_waves
};

struct RelaxedRequest {
    Objective objective = Objective::least_shock;  ///< none of the energy itself
    double level = 0;                              ///< E/E_unit before the shift, > 0
    Shift shift;
    /// Points near which to search first, admissible or not; then vertices and mixtures.
    std::vector<Eigen::VectorXd> near;
    int starts = 0;  ///< mixtures tried beside `near`
};

/// Feasible start by linear programs and segments, then polish(); the best of all starts, absent where none led to an
/// optimum. `interval` must be that of the same shift, with vertices. Throws std::invalid_argument on an objective that
/// is the energy or a level that is not > 0.
[[nodiscard]] std::optional<RelaxedOptimum> relaxed_optimum(const RelaxedSet& set, const RelaxedInterval& interval,
                                                            const RelaxedRequest& request);

}  // namespace nsma
