#pragma once

#include <vector>

#include <Eigen/Core>

#include "nsma/orbit/conditions.hpp"

namespace nsma {

/// One inequality of COND1 or COND3 over beta, as a parametric row. Steps of equal rows share
/// one: they are relaxed together.
struct ConditionRow {
    /// No penetration in flight (COND1), no tension in contact (COND3).
    enum class Condition { cond1, cond3 };
    Condition condition = Condition::cond1;  ///< which it is
    std::vector<int> steps;                  ///< n of every step with this row, increasing
};

/// Change of the right-hand sides, nondimensional: lengths in u, forces in Y S u/L, energies in
/// the energy unit of the bar.
struct Shift {
    double gap = 0;        ///< of the signed gap: moves COND1 and COND2
    double level = 0;      ///< of the energy
    double contact = 0;    ///< of the place of contact alone: x_0 = gap + contact
    double band = 0;       ///< half width >= 0: |x_0 - gap - contact| <= band
    Eigen::VectorXd rows;  ///< of each inequality (> 0 relaxes); empty: none
};

/// Uniform relaxation of the conditions, all >= 0.
struct Relaxation {
    double penetration = 0;  ///< COND1: x_n <= d + penetration, in units of u
    double band = 0;         ///< COND2: |x_n - d| <= band, in units of u
    double adhesion = 0;     ///< COND3: lambda_n <= adhesion, in units of Y S u/L
};

/// COND1-3 of one pattern with every right-hand side a parameter. No presolve: its arguments
/// rest on exact zeros that a relaxation lifts.
///   rows beta <= limits,   contact . beta = delta + gap + contact shift (or within a band)
/// COND1 rows are those of 0 < n < r that differ from COND2's row (where the tip rests at the
/// wall COND2 has the word); a COND3 row is the tension lambda_n = -2N eps_n beta.
/// Source: [1] COND1-3.
struct RelaxedSet {
    Kernel kernel;                        ///< of the pattern
    int gap_sign = 1;                     ///< delta
    double energy_factor = 0;             ///< E/E_unit = energy_factor |beta|^2
    Eigen::MatrixXd rows;                 ///< R x m
    std::vector<ConditionRow> condition;  ///< size R, COND1 rows first
    Eigen::VectorXd contact;              ///< size m: COND2's row x_0

    [[nodiscard]] int dimension() const { return kernel.dimension(); }  ///< m
    /// E/E_unit of beta (size m).
    [[nodiscard]] double energy(const Eigen::VectorXd& beta) const { return energy_factor * beta.squaredNorm(); }
    /// Right-hand sides of `rows` under the shift: delta + gap or 0, plus the shift of each row.
    [[nodiscard]] Eigen::VectorXd limits(const Shift& shift) const;  ///< size R
    /// The same relaxation of every row of a condition, as a shift.
    [[nodiscard]] Shift shift(const Relaxation& relaxation) const;
};

/// Throws std::invalid_argument on a trivial kernel or a gap sign other than -1, 0, 1.
[[nodiscard]] RelaxedSet relaxed_set(const Kernel& kernel, int gap_sign);

}  // namespace nsma
