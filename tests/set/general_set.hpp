#pragma once

#include "nsma/set/admissible_set.hpp"

namespace oracle {

/// The set by another way than admissible_set(): emptiness by linear program (CLP) and, independently, by projecting
/// COND2's row on the cone of COND1 and COND3 (least norm), which also gives E_min; vertices by linear programs that
/// climb. Throws std::runtime_error where the two disagree. `bounded`: which variables have a sign, where not all or
/// none as the reduction says.
[[nodiscard]] nsma::AdmissibleSet general_set(nsma::Reduction reduction, std::vector<std::uint8_t> bounded = {});

}  // namespace oracle
