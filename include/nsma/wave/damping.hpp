#pragma once

namespace nsma {

/// What takes energy from the bar.
struct Damping {
    /// Where it acts.
    enum class Kind {
        none,        ///< nowhere
        tip,         ///< a dashpot at the contact end, `value` times z S: the motion stays exact
        distributed  ///< in every cell, C = `value` M with `value` in 1/s: of second order in dt, O(N) a step
    };
    Kind kind = Kind::none;  ///< one of them
    double value = 0;        ///< >= 0
};

}  // namespace nsma
