#pragma once

#include "nsma/wave/bar.hpp"

/// The unit bar with this gap.
inline nsma::Bar bar_with_gap(double gap) {
    nsma::Bar bar;
    bar.gap = gap;
    return bar;
}
