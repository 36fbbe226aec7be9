#pragma once

#include <optional>
#include <vector>

#include "nsma/orbit/orbit.hpp"

namespace nsma {

/// The least pattern, by n_T then r, whose COND1-3 a motion meets: its shortest period, with contact over the longest rest
/// at the wall that holds every step with force. One motion carries several labels (r, p) where it rests on the wall
/// without force or repeats itself within n_T; it, its time shifts and their reversals share one least label.
struct MotionLabel {
    int free_steps = 1;
    int contact_steps = 1;
    int shift_steps = 0;    ///< the motion that much later begins its free flight; in [0, r + p)
    bool reversed = false;  ///< its time reversal comes first in the order of wave values

    bool operator==(const MotionLabel&) const = default;
};

/// A motion as its least label shows it.
struct LabelledMotion {
    MotionLabel label;
    /// b_n dt/u from the shift on, reversed if the label says so; size r + p. The same under any label of the motion.
    std::vector<double> waves;
};

/// Zero and equal mean within `tolerance` of the largest wave, or of the displacement scale. Absent for rest.
[[nodiscard]] std::optional<LabelledMotion> least_label(const Orbit& orbit, double tolerance = 1e-9);

/// Whether two motions of one bar are the same up to a shift in time and a reversal.
[[nodiscard]] bool same_motion(const LabelledMotion& a, const LabelledMotion& b, double tolerance = 1e-9);

}  // namespace nsma
