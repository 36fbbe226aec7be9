#pragma once

#include "wave_queue.hpp"
#include "nsma/wave/damping.hpp"

namespace nsma {

/// A bar whose contact end is driven by a force and meets the wall: the queue of waves with
/// `b_{n+2N} = b_n - v*_n`, where the tip has the velocity v* that force, dashpot and the arriving wave give it,
/// v* = (2 b_n + f/z)/(1 + zeta), or less where that would take it into the wall. So it lands within a step, and stays
/// while it is pressed. Forces are constant over a step; then all but distributed damping is exact.
class DrivenBar {
public:
    /// Throws std::invalid_argument on a bad bar, mesh or state, a tip inside the wall, or a damping that is negative
    /// or not finite.
    DrivenBar(const Bar& bar, const Mesh& mesh, const State& state, const Damping& damping);

    /// What a step did. Energies [J]; the energy of the bar grows by work - loss + landing.
    struct Step {
        double tip_velocity = 0;  ///< v* [m/s]
        double wall_force = 0;    ///< of the wall on the bar [N], <= 0
        double work = 0;          ///< of the force
        double loss = 0;          ///< to the dashpot, or in the cells
        double landing = 0;       ///< of the wall while the tip still moves, <= 0
    };
    /// One step with a force on the tip [N], > 0 toward the wall.
    Step step(double force);

    [[nodiscard]] double tip() const { return queue_.tip(); }  ///< displacement at the start of the next step [m]
    [[nodiscard]] double energy() const { return queue_.energy(); }
    [[nodiscard]] const WaveQueue& queue() const { return queue_; }

private:
    WaveQueue queue_;
    double gap_, touch_, time_step_, area_, impedance_;
    double dashpot_ = 0;    // zeta
    double half_step_ = 1;  // factor of velocities over half a step
};

/// The bar at rest: without stress, or of a negative gap pressed against the wall.
[[nodiscard]] State rest_state(const Bar& bar, const Mesh& mesh);

}  // namespace nsma
