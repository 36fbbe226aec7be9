#pragma once

#include <vector>

#include "nsma/set/admissible_set.hpp"

namespace nsma {

/// The shape of P, read off the integers of its reduction in O(rows columns):
///   simplex  every gamma_j bounded, no row kept, contact_row = c (1, .., 1);
///   chain    every gamma_j free, contact_row = -c (1, .., 1), and the rows are the partial sums from either end:
///            with P_k = gamma_1 + .. + gamma_k, P_k <= 0 and P_n - P_k <= 0;
///   none     anything else.
[[nodiscard]] AdmissibleSet::Shape shape_of(const Reduction& reduction);

/// Index among the kept rows of each partial sum: of P_k at prefix[k], of P_n - P_k at suffix[k], -1 where there is
/// none; sizes n + 1; the sum of all is prefix[n]. Empty vectors where a row is no partial sum.
struct ChainRows {
    std::vector<int> prefix;
    std::vector<int> suffix;
};
[[nodiscard]] ChainRows chain_rows(const Reduction& reduction);

/// Decides a set of a known shape. A simplex has the vertices delta e_j/c. A chain has those with
/// every P_k either 0 or -delta/c, 2^(n-1) of them: kept are all of the greatest energy (steps of alternating sign, one
/// of them zero where n is even), up to seven columns every one, the single steps, and those whose P_k changes after
/// every 2, 3 or 4 columns.
void decide_in_closed_form(AdmissibleSet& set);

}  // namespace nsma
