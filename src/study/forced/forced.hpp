#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "nsma/orbit/pattern.hpp"
#include "nsma/study/scene.hpp"

namespace nsma {

/// What kind of motion a driven bar settled to.
enum class ForcedKind {
    contact_free,     ///< periodic without contact
    periodic,         ///< returns after `periods` periods of the force within 0.1 %, with contact
    nearly_periodic,  ///< within 5 %: what a laboratory would call periodic
    quasi_periodic,   ///< does not return; neighbouring motions stay neighbours
    chaotic,          ///< does not return; neighbouring motions part
    transient         ///< energy still grows or falls
};
inline constexpr std::array forced_kinds{ForcedKind::contact_free,   ForcedKind::periodic, ForcedKind::nearly_periodic,
                                         ForcedKind::quasi_periodic, ForcedKind::chaotic,  ForcedKind::transient};
[[nodiscard]] std::string_view name(ForcedKind kind);  ///< "contact-free", "periodic", ...

/// One frequency of a sweep. Energies in the energy unit of the bar, per period of the force unless said otherwise.
struct ForcedPoint {
    bool up = true;        ///< of the sweep to higher frequencies
    int place = 0;         ///< of its frequency in Forcing::frequencies
    double frequency = 0;  ///< omega/omega_1
    ForcedKind kind = ForcedKind::transient;
    int periods = 0;        ///< of the force until the motion returns; 0: it does not
    double defect = 0;      ///< greatest difference of the tip after that many periods (of none: one), over its range
    double divergence = 0;  ///< growth of a small difference of motions in the periods recorded, by natural logarithm
    double energy_mean = 0;
    double energy_max = 0;
    double tip_least = 0;     ///< [m]
    double tip_greatest = 0;  ///< [m]
    double peak_force = 0;    ///< of the wall [N], >= 0
    double work = 0;          ///< of the force
    double loss = 0;          ///< to the damping
    double landing = 0;       ///< to the wall where the tip lands within a step, >= 0
    double balance = 0;       ///< |work - loss - landing - growth| of all recorded periods over work + loss: rounding
    double growth = 0;        ///< of the bar's energy
    double contact_phases = 0;
    /// Poincare section: tip [m] and its velocity [m/s] at the beginning of each period of the force that was recorded.
    std::vector<std::array<double, 2>> section;
    std::vector<double> waves;  ///< b_n at the end [m/s], size 2N, the next to arrive first
    double phase = 0;           ///< of the force then, in periods, in [0, 1)
};

/// Where the modes alone say that a response along them ends: the work that the force can do at its best phase equals
/// what the damping takes. Of the least-energy orbits of mode k on the scene's mesh.
struct BalancePoint {
    int mode = 1;
    double frequency = 0;  ///< omega/omega_1
    double energy = 0;     ///< in energy units, of the orbit
    double ratio = 0;      ///< most work over loss, a period
};
/// Every orbit of the modes whose frequency lies within the sweep, by mode and frequency.
[[nodiscard]] std::vector<BalancePoint> balance_points(const Scene& scene);
/// The frequencies at which that ratio falls through 1 as the energy rises, between neighbours on the mesh; by mode.
[[nodiscard]] std::vector<BalancePoint> predicted_jumps(const std::vector<BalancePoint>& points);
/// An end of a range of frequencies in which the response depends on the direction of the sweep.
struct Jump {
    bool up = true;   ///< the sweep that jumps there
    double from = 0;  ///< omega/omega_1: it lies between these two
    double to = 0;
    bool rises = false;  ///< to more energy
};
/// The jumps of two sweeps: where their greatest energies part by more than a fifth, that of the one as much from one
/// frequency to the next, and its motion has settled on both sides. None of one sweep alone.
[[nodiscard]] std::vector<Jump> jumps(const std::vector<ForcedPoint>& points);

/// Sweeps the frequency of the force up and down. Sweeps, and of points from rest all points, are independent: they are
/// done by so many threads as the machine has, and come in the order up, down. `known`: points of an earlier run, with
/// which each sweep goes on. `done` is told each point, by one thread at a time. Ends early when a stop was asked.
/// Throws std::invalid_argument where the scene has no forcing, and what `done` throws.
[[nodiscard]] std::vector<ForcedPoint> forced_response(const Scene& scene, const std::vector<ForcedPoint>& known,
                                                       const std::function<void(const ForcedPoint&)>& done);

}  // namespace nsma
