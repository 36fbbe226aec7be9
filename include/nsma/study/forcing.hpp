#pragma once

#include <vector>

namespace nsma {

/// A cosine on the tip whose frequency is swept: the plain data of a scene's [forcing], already checked.
struct Forcing {
    double amplitude = 0;             ///< F [N], > 0 toward the wall
    std::vector<double> frequencies;  ///< omega/omega_1, increasing, all > 0
    bool up = true;                   ///< sweep from the least to the greatest
    bool down = true;                 ///< and back, from rest again
    int settle = 200;                 ///< periods of each point before it is looked at, >= 0
    int record = 200;                 ///< periods over which it is, >= 2
    bool from_rest = false;           ///< each point begins at rest; else with the state of the point before
};

}  // namespace nsma
