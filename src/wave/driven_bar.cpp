#include "driven_bar.hpp"

#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace nsma {
namespace {

// In displacement units: this near the tip is at the wall. Far below every displacement, far above their rounding.
constexpr double touch_tolerance = 1e-11;
// A start this far inside the wall is at it, by rounding.
constexpr double rest_tolerance = 1e-9;

}  // namespace

DrivenBar::DrivenBar(const Bar& bar, const Mesh& mesh, const State& state, const Damping& damping)
    : queue_(bar, mesh, state),
      gap_(bar.gap),
      touch_(bar.gap == 0 ? 0.0 : touch_tolerance * bar.displacement_unit()),
      time_step_(mesh.time_step(bar)),
      area_(bar.area),
      impedance_(bar.impedance()) {
    if (!std::isfinite(damping.value) || damping.value < 0)
        throw std::invalid_argument(fmt::format("damping: expected a finite number >= 0, got {}", damping.value));
    const double beyond = queue_.tip() - gap_;
    if (beyond > rest_tolerance * bar.displacement_unit())
        throw std::invalid_argument(
            fmt::format("state: expected a tip that is not inside the wall, got one {:g} m beyond it", beyond));
    if (damping.kind == Damping::Kind::tip) dashpot_ = damping.value;
    if (damping.kind == Damping::Kind::distributed) half_step_ = std::exp(-0.5 * damping.value * time_step_);
}

DrivenBar::Step DrivenBar::step(double force) {
    Step step;
    if (half_step_ < 1) step.loss = queue_.damp(half_step_);
    const double pressure = force / area_;
    const double wave = queue_.arriving();
    double velocity = (2.0 * wave + pressure / impedance_) / (1.0 + dashpot_);
    const double room = gap_ - queue_.tip();
    if (time_step_ * velocity - room > touch_) {
        velocity = std::abs(room) <= touch_ ? 0.0 : room / time_step_;
        // What the end still lacks: stress - force + dashpot, with stress z (v* - 2 b).
        step.wall_force = area_ * (impedance_ * ((1.0 + dashpot_) * velocity - 2.0 * wave) - pressure);
    }
    step.tip_velocity = velocity;
    step.work = force * velocity * time_step_;
    step.loss += dashpot_ * impedance_ * area_ * velocity * velocity * time_step_;
    step.landing = step.wall_force * velocity * time_step_;
    queue_.step(velocity);
    if (half_step_ < 1) step.loss += queue_.damp(half_step_);
    return step;
}

State rest_state(const Bar& bar, const Mesh& mesh) {
    validate(mesh);
    State state = State::Zero(mesh.window());
    if (bar.gap < 0) state.head(mesh.cells).setConstant(bar.young_modulus * bar.gap / bar.length);
    return state;
}

}  // namespace nsma
