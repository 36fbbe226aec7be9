#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "nsma/program/answer.hpp"
#include "nsma/program/reduction.hpp"

namespace nsma {

/// The admissible set P = {COND1, COND2, COND3} of a pattern: a convex polytope (a cone for a
/// closed gap) over the reduced variables gamma, and its attainable energies.
struct AdmissibleSet {
    enum class Status { empty, nonempty, failed };
    /// Known in closed form: a simplex (every reduced variable has a sign and no COND1 row is left) or a chain (none has
    /// one; partial sums between 0 and the gap). `general` is left to the linear program.
    enum class Shape { simplex, chain, general };

    Reduction reduction;
    Status status = Status::failed;
    Shape shape = Shape::general;
    std::string reason;  ///< one line: what decided
    /// Nonempty, gap != 0: the point of least energy, exact to rounding; size n.
    Eigen::VectorXd least;
    /// Nonempty: vertices found (directions scaled to unit norm for a closed gap), the greatest
    /// energy first.
    std::vector<Eigen::VectorXd> vertices;
    /// A direction along which P is unbounded (for a closed gap: an admissible one); empty size when there is none.
    Eigen::VectorXd ray;
    /// Active set of the projection that decided: kept rows with a positive multiplier, and
    /// bounded columns held at zero. What prove() repeats in fractions.
    std::vector<int> projection_rows;
    std::vector<int> projection_zeros;
    /// Dimension of the smallest flat known to hold P: n minus the rank of COND2.
    int flat_dimension = 0;

    [[nodiscard]] bool unbounded() const { return ray.size() > 0; }
    /// E/E_unit of a reduced point.
    [[nodiscard]] double energy(const Eigen::VectorXd& gamma) const;
    [[nodiscard]] EnergyInterval interval() const;
};

struct AdmissibleOptions {
    /// Search vertices for the greatest energy; otherwise only emptiness and the least energy.
    bool greatest = true;
    /// Sets of a known shape without a linear program; otherwise as `general`, which tests compare with.
    bool closed_form = true;
};

/// Decides a simplex and a chain in closed form. Otherwise emptiness by linear program (CLP) and, independently, by projecting COND2's row on
/// the cone of COND1 and COND3 (least norm), which also gives E_min: with rho the projection,
/// the least-energy point is delta rho/|rho|^2. The two must agree, else the status is `failed`.
[[nodiscard]] AdmissibleSet admissible_set(Reduction reduction,
                                           const AdmissibleOptions& options = {});

}  // namespace nsma
