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
    /// Whether any orbit meets COND1-3 (of a closed gap: any but rest).
    enum class Status { empty, nonempty };
    /// One contact phase leaves a simplex (gamma >= 0, contact_row = c (1, .., 1), no COND1 row) or a chain (no bounds,
    /// contact_row = -c (1, .., 1), partial sums P_k between -delta/c and 0). `none`: no variable is left, or COND3
    /// alone forbids all.
    enum class Shape { none, simplex, chain };

    Reduction reduction;            ///< the set as integer rows over gamma
    Status status = Status::empty;  ///< empty or not
    Shape shape = Shape::none;      ///< which polytope it is
    std::string reason;             ///< one line: what decided
    /// Nonempty, gap != 0: the point of least energy, exact to rounding; size n.
    Eigen::VectorXd least;
    /// Nonempty: delta e_j/c of a simplex; of a chain, whose vertices have every P_k either 0 or -delta/c, all of the
    /// greatest energy first, then some others (for a closed gap the directions of unit norm).
    std::vector<Eigen::VectorXd> vertices;
    /// A direction along which P is unbounded (for a closed gap: an admissible one); empty size when there is none.
    Eigen::VectorXd ray;

    [[nodiscard]] bool unbounded() const { return ray.size() > 0; }  ///< no greatest energy
    /// E/E_unit of a reduced point.
    [[nodiscard]] double energy(const Eigen::VectorXd& gamma) const;
    /// The attainable energies in floating point, without exact fractions.
    [[nodiscard]] EnergyInterval interval() const;
};

/// Decides emptiness, E_min and the greatest energy in closed form.
[[nodiscard]] AdmissibleSet admissible_set(Reduction reduction);

}  // namespace nsma
