#pragma once

#include <map>
#include <string_view>

#include "study/sweep/record_fields.hpp"

namespace nsma {

/// What tables and JSON show of a record: its fields and what follows from them for a bar, by the names and in the
/// units of data/README.md. Energy ratios E/E_g have no value for a closed gap, fractions none without a proof.
using NamedValues = std::map<std::string_view, FieldValue>;
[[nodiscard]] NamedValues named_values(const Bar& bar, const PatternRecord& record);
[[nodiscard]] NamedValues named_values(const Bar& bar, const OrbitAnswer& answer);

/// The best run of the solver whose name begins with `solver` ("ipopt" or "nlopt"), or null.
[[nodiscard]] const SolverRun* best_run(const OrbitAnswer& answer, std::string_view solver);

}  // namespace nsma
