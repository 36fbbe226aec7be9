#pragma once

#include <string>

#include "chart.hpp"
#include "nsma/wave/bar.hpp"

namespace nsma {

/// How times and lengths are shown: in SI units with a prefix; of the unit bar in units of tau and |d|.
struct Units {
    ScaledUnit time, length;  ///< factors from seconds and metres
    std::string time_label, tip_label;
};
/// For times up to `duration` (in units of tau) and tip displacements up to `largest_tip` [m].
[[nodiscard]] Units units_of(const Bar& bar, double duration, double largest_tip);

}  // namespace nsma
