#pragma once

#include <vector>

#include "nsma/wave/state.hpp"

namespace nsma {

/// The whole bar as a queue of 2N wave amplitudes b_n [m/s]: b_n = (v_N - sigma_N/z)/2 is the
/// wave that reaches the contact end at step n. It returns 2N steps later as -b_n from a free
/// end, as +b_n from the wall and as b_n - v* from a tip of velocity v*, so a step costs O(1) and wave values are never
/// rounded. Equivalent to the matrices of [1] Eq. (1)-(3).
class WaveQueue {
public:
    /// Queue of the state Q at step 0. Throws std::invalid_argument on a wrong size or NaN.
    WaveQueue(const Bar& bar, const Mesh& mesh, const State& state);

    [[nodiscard]] double arriving() const { return waves_[head_]; }  ///< b_n [m/s]

    /// Displacement of the contact end [m]: -dt times the sum of the queue, kept by O(1)
    /// updates and resummed every 2N steps so that it cannot drift.
    [[nodiscard]] double tip() const { return tip_; }

    /// Contact force [N] that the wall would exert in this step, -2 z S b_n; < 0 is compression.
    [[nodiscard]] double contact_force() const { return force_per_wave_ * waves_[head_]; }

    [[nodiscard]] double tip_after_free_step() const { return tip_ + time_step_ * (2.0 * waves_[head_]); }

    /// One step in which the tip has this velocity v* [m/s]: the wave comes back as b_n - v*.
    void step(double tip_velocity);
    void step_free() { step(2.0 * waves_[head_]); }
    void step_contact() { step(0.0); }

    /// Every velocity times this factor, stresses as they are: O(N). The energy that takes [J].
    double damp(double factor);

    [[nodiscard]] State state() const;    ///< Q at the present step, size 2N
    [[nodiscard]] double energy() const;  ///< [J], rho S dx times the sum of b^2
    [[nodiscard]] int window() const { return static_cast<int>(waves_.size()); }
    /// b_{n+k} of the present step n, k = 0..2N-1, [m/s].
    [[nodiscard]] double wave(int k) const;

private:
    void advance();

    Bar bar_;
    Mesh mesh_;
    std::vector<double> waves_;
    std::size_t head_ = 0;
    double tip_ = 0.0;
    double time_step_ = 0.0;
    double force_per_wave_ = 0.0;  // -2 z S
};

/// The state whose waves b_0..b_{2N-1} [m/s] these are, the next to arrive first.
[[nodiscard]] State state_of_waves(const Bar& bar, const std::vector<double>& waves);

}  // namespace nsma
