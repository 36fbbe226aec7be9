#pragma once

#include <string>

#include "nsma/search/answer.hpp"

namespace nsma {

/// The answer as one JSON object (fields: data/README.md): what `nsma orbit --json` prints, and
/// with `with_seconds = false` and `indent = -1` a line of a sweep's orbits.jsonl, which is then
/// the same in every run. Numbers in full precision; null where there is no value, never NaN.
/// `alpha` in m/s, `tip_displacement` in units of |d| (metres for a closed gap),
/// `contact_force` in N.
[[nodiscard]] std::string orbit_json(const OrbitAnswer& answer, const Bar& bar, bool with_seconds = true,
                                     int indent = 2);

}  // namespace nsma
