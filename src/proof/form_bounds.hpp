#pragma once

#include <vector>

#include "nsma/set/admissible_set.hpp"
#include "set/known_set.hpp"
#include "nsma/check/certificate.hpp"

namespace nsma {

/// Exact bounds of linear forms over the admissible set, with their proofs in the terms of the
/// unreduced conditions.
class FormBounds {
public:
    /// The shape, simplex or chain, says how.
    FormBounds(const Kernel& kernel, const Reduction& reduction, AdmissibleSet::Shape shape);

    /// The least upper bound of form . gamma (integers, size n) with exact multipliers.
    [[nodiscard]] FormBound bound(const std::vector<Rational>& form) const;

    /// Adds multiples of the rows that forced columns to zero until the combination dominates
    /// `form` (over all columns of beta) on those columns too.
    void cover_forced(const std::vector<Rational>& form, RowCombination& combination) const;

    /// form over the columns of beta from a form over the reduced variables, and back to sparse.
    [[nodiscard]] std::vector<Rational> unreduced(const std::vector<Rational>& form) const;

private:
    [[nodiscard]] RowCombination simplex_bound(const std::vector<Rational>& form) const;
    [[nodiscard]] RowCombination chain_bound(const std::vector<Rational>& form) const;

    const Kernel& kernel_;
    const Reduction& reduction_;
    std::vector<int> contact_;      // w over all columns of beta
    std::vector<int> forced_flip_;  // flip of each forced zero, in order
    AdmissibleSet::Shape shape_;
    ChainRows chain_;  // of a chain
};

[[nodiscard]] RationalVector sparse(const std::vector<Rational>& dense);

/// Integer row sum_{k<step} eps_k e_{column(k)} over all columns of beta.
[[nodiscard]] std::vector<int> partial_sum_row(const Kernel& kernel, int step);

}  // namespace nsma
