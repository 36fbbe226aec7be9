#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "relaxed_program.hpp"
#include "numerics/polish.hpp"
#include "nsma/price/relaxed_set.hpp"

namespace nsma {

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
    enum class Status { optimal, empty, below, above, failed };
    Status status = Status::failed;
    Eigen::VectorXd beta;
    double objective = 0;  ///< as reported by objective_of_waves
    bool global = false;   ///< weak duality proves it within 1e-6
};

struct RelaxedRequest {
    Objective objective = Objective::least_shock;  ///< not max_energy
    std::optional<double> level;                   ///< E/E_unit before the shift
    Shift shift;
    Eigen::VectorXd reference;  ///< `nearest` only
    /// Points near which to search first, admissible or not; then vertices and mixtures.
    std::vector<Eigen::VectorXd> near;
    int starts = 0;  ///< mixtures tried beside `near`
};

/// Feasible start by linear programs and segments, then polish(); the best of all starts.
/// `interval` must be that of the same shift, with vertices when a level is asked.
[[nodiscard]] RelaxedOptimum relaxed_optimum(const RelaxedSet& set, const RelaxedInterval& interval,
                                             const RelaxedRequest& request);

}  // namespace nsma
