#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "nsma/orbit/orbit.hpp"

namespace nsma {

/// The least pattern, by n_T then r, whose COND1-3 a motion meets: its shortest period, with contact over the longest
/// rest at the wall that holds every step with force. One motion carries several labels (r, p) where it rests on the
/// wall without force or repeats itself within n_T; it, its time shifts and their reversals share one least label.
struct MotionLabel {
    int free_steps = 1;     ///< r of the least pattern
    int contact_steps = 1;  ///< p of the least pattern
    int shift_steps = 0;    ///< the motion that much later begins its free flight; in [0, r + p)
    bool reversed = false;  ///< its time reversal comes first in the order of wave values

    /// The same pattern, shift and direction of time.
    bool operator==(const MotionLabel&) const = default;
};

/// A motion as its least label shows it.
struct LabelledMotion {
    MotionLabel label;  ///< which pattern, from which step on
    /// b_n dt/u from the shift on, reversed if the label says so; size r + p. The same under any label of the motion.
    std::vector<double> waves;
};

/// The least label of a motion. Zero and equal mean within `tolerance` of the largest wave, or of the
/// displacement scale. Absent for rest.
[[nodiscard]] std::optional<LabelledMotion> least_label(const Orbit& orbit, double tolerance = 1e-9);

/// Numbers for the label and the waves, rounded to 1e-7 of the largest on two grids half a step apart: a motion shares
/// at least one of them with itself under any label, shift or reversal, and with no other that differs by more than
/// that.
[[nodiscard]] std::array<std::uint64_t, 2> fingerprints(const LabelledMotion& motion);

}  // namespace nsma
