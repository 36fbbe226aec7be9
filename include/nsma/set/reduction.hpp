#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "nsma/orbit/conditions.hpp"

namespace nsma {

/// What presolve took away, counted by the argument that took it.
struct RemovalCounts {
    int dead_classes = 0;        ///< classes whose signs do not close up (zero in the kernel)
    int sign_conflicts = 0;      ///< live classes that COND3 bounds from both sides
    int forced_zero = 0;         ///< columns that a COND1 row of nonnegative terms forces to zero
    int contact_duplicates = 0;  ///< COND2 rows equal to the one kept (p + 1, with row 0)
    int force_rows = 0;          ///< COND3 rows turned into bounds
    int silent_rows = 0;         ///< COND1 rows equal to the row before (nothing arrived)
    int implied_rows = 0;        ///< COND1 rows that the bounds or COND2 imply
    int duplicate_rows = 0;      ///< COND1 rows equal to an earlier kept row
    int dominated_rows = 0;      ///< COND1 rows implied by one other kept row: none with one contact phase
};

/// A column fixed to zero because the COND1 row of this step has only nonnegative terms.
struct ForcedZero {
    int column = 0;  ///< column of beta
    int step = 0;    ///< n of the row sum_{k<n} eps_k beta <= 0
};

/// The admissible set of a pattern, reduced by arguments in integers: over gamma = flip beta,
///   contact_row . gamma = delta,   rows . gamma <= 0,   gamma >= 0 where it is bounded.
/// A COND1 row x_n <= delta minus COND2 is twice the partial sum of eps_k beta over k < n.
/// The signs eps of every live class are the same, round by round of g steps, each a step after those of the class
/// before (see Sieve). So COND3 says the same of every column; a COND1 row that forces one to zero forces all in turn;
/// and one that does not holds by the bounds. Without bounds eps alternates from round to round, and the rows are the
/// partial sums P_k = gamma_1 + .. + gamma_k of the first round, P_k <= 0 for k = 1..n, and the rest of them in the
/// second, P_n - P_k <= 0 for k = 1..n-1.
struct Reduction {
    int gap_sign = 1;                ///< delta
    double energy_factor = 0;        ///< E/E_unit = energy_factor |gamma|^2
    int kernel_dimension = 0;        ///< m, the size of beta
    int flip = 1;                    ///< +1 or -1
    bool bounded = false;            ///< gamma >= 0: every class has a contact step; else none has one
    Eigen::VectorXi contact_row;     ///< all entries alike; size n = m, or 0 where every column is zero
    Eigen::MatrixXi rows;            ///< kept COND1 rows, R x n
    std::vector<int> row_step;       ///< n of each kept row, 1 <= n < r
    RemovalCounts removed;           ///< by argument
    std::vector<ForcedZero> forced;  ///< in the order they were found
    /// Nonempty: the set is empty by an argument in integers (for a closed gap: only rest).
    std::string empty_because;

    [[nodiscard]] int variables() const { return static_cast<int>(contact_row.size()); }  ///< n
    /// beta (size m) of a reduced point gamma (size n).
    [[nodiscard]] Eigen::VectorXd beta(const Eigen::VectorXd& gamma) const;
    /// gamma (size n) of beta (size m): the inverse of beta().
    [[nodiscard]] Eigen::VectorXd gamma(const Eigen::VectorXd& beta) const;
};

/// Reduces COND1-3 of a pattern. O(n_T) plus the kept rows.
[[nodiscard]] Reduction reduce(const Conditions& conditions);

}  // namespace nsma
