#pragma once

#include <optional>

#include "nsma/orbit/motion_label.hpp"

namespace nsma {

/// What kind of orbit it is: the same motion can carry several labels (r, p).
struct Classification {
    int minimal_period_steps = 0;  ///< smallest divisor of n_T that is a period of b
    int silent_contact_steps = 0;  ///< contact steps with lambda = 0
    int wall_touches = 0;          ///< n = 1..r-1 with x_n = d: touches in free flight
    bool forceless = false;        ///< every contact step is silent
    bool full_support = false;     ///< every live amplitude is nonzero
    double tolerance = 0.0;        ///< the relative tolerance used
    std::optional<MotionLabel>
        same_motion_as;  ///< its least label, where that is another pattern or shift; its reversal alone is none
};

/// Zero means below `tolerance` relative to the largest amplitude (waves and forces) or, for
/// touches, to the displacement scale of replay().
[[nodiscard]] Classification classify(const Orbit& orbit, double tolerance = 1e-9);

}  // namespace nsma
