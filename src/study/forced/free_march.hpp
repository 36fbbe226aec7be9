#pragma once

#include <vector>

#include "nsma/wave/bar.hpp"
#include "nsma/wave/damping.hpp"
#include "nsma/wave/state.hpp"

namespace nsma {

/// A flight and the contact after it, in steps.
struct FlightAndContact {
    int free = 0;
    int contact = 0;
};

/// What a bar did that was let go.
struct FreeMarch {
    /// Every flight that was seen from its first step with all of the contact after it. At the wall a step without
    /// motion is contact, pressed or not.
    std::vector<FlightAndContact> cycles;
    double energy_start = 0;  ///< [J]
    double energy_end = 0;
    double loss = 0;       ///< to the damping [J]
    double landing = 0;    ///< to the wall where the tip landed within a step [J]
    double tip_least = 0;  ///< [m]
    double tip_greatest = 0;
    double peak_force = 0;  ///< [N]
};

/// Marches a state of the bar without a force. Throws std::invalid_argument on a bad argument.
[[nodiscard]] FreeMarch free_march(const Bar& bar, const Mesh& mesh, const State& state, const Damping& damping,
                                   long steps);

/// A state with a random difference of this share of its energy norm (seed fixed), its tip no nearer to the wall.
[[nodiscard]] State perturbed(const Bar& bar, const State& state, double share);

}  // namespace nsma
