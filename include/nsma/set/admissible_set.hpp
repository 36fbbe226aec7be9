#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "nsma/set/energy_interval.hpp"
#include "nsma/set/reduction.hpp"

namespace nsma {

/// The admissible set P = {COND1, COND2, COND3} of a pattern: a convex polytope (a cone for a
/// closed gap) over the reduced variables gamma, and its attainable energies.
struct AdmissibleSet {
    enum class Status { empty, nonempty, failed };
    /// One contact phase leaves a simplex (every reduced variable has a sign and no COND1 row is left) or a chain (none
    /// has one; partial sums between 0 and the gap). `none`: no variable is left, or COND3 alone forbids all.
    enum class Shape { none, simplex, chain };

    Reduction reduction;
    Status status = Status::failed;
    Shape shape = Shape::none;
    std::string reason;  ///< one line: what decided
    /// Nonempty, gap != 0: the point of least energy, exact to rounding; size n.
    Eigen::VectorXd least;
    /// Nonempty: all vertices of the greatest energy first, then of a chain some others (for a closed gap the
    /// directions of unit norm).
    std::vector<Eigen::VectorXd> vertices;
    /// A direction along which P is unbounded (for a closed gap: an admissible one); empty size when there is none.
    Eigen::VectorXd ray;
    /// Dimension of the smallest flat known to hold P: n minus the rank of COND2.
    int flat_dimension = 0;

    [[nodiscard]] bool unbounded() const { return ray.size() > 0; }
    /// E/E_unit of a reduced point.
    [[nodiscard]] double energy(const Eigen::VectorXd& gamma) const;
    [[nodiscard]] EnergyInterval interval() const;
};

/// Decides emptiness, E_min and the greatest energy in closed form. The status is `failed` for a shape that one contact
/// phase does not leave.
[[nodiscard]] AdmissibleSet admissible_set(Reduction reduction);

}  // namespace nsma
