#include "free_march.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "wave/driven_bar.hpp"
#include "nsma/numerics/interruption.hpp"

namespace nsma {
namespace {

constexpr long steps_between_looks = 1024;

// In displacement units: this near the wall, and moving no more than this in a step, is contact.
constexpr double contact_tolerance = 1e-9;

}  // namespace

FreeMarch free_march(const Bar& bar, const Mesh& mesh, const State& state, const Damping& damping, long steps) {
    DrivenBar driven(bar, mesh, state, damping);
    const double near = contact_tolerance * bar.displacement_unit();
    const double step_time = mesh.time_step(bar);
    FreeMarch march;
    march.energy_start = driven.energy();
    march.tip_least = march.tip_greatest = driven.tip();
    FlightAndContact cycle;
    bool whole = false;  // the flight was seen from its first step
    bool contact = false;
    for (long n = 0; n < steps; ++n) {
        if (n % steps_between_looks == 0) stop_point();
        const double tip = driven.tip();
        const auto step = driven.step(0.0);
        const bool before = contact;
        contact =
            step.wall_force < 0 || (std::abs(bar.gap - tip) <= near && std::abs(step.tip_velocity) * step_time <= near);
        if (before && !contact) {
            if (whole) march.cycles.push_back(cycle);
            cycle = {};
            whole = true;
        }
        ++(contact ? cycle.contact : cycle.free);
        march.loss += step.loss;
        march.landing -= step.landing;
        march.tip_least = std::min(march.tip_least, driven.tip());
        march.tip_greatest = std::max(march.tip_greatest, driven.tip());
        march.peak_force = std::max(march.peak_force, -step.wall_force);
    }
    march.energy_end = driven.energy();
    return march;
}

State perturbed(const Bar& bar, const State& state, double share) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    // In velocities and stresses over z, whose squares the energy adds up.
    const Eigen::Index cells = state.size() / 2;
    const auto scaled = [&](State of, double factor) {
        of.head(cells) *= factor;
        return of;
    };
    State difference = State::NullaryExpr(state.size(), [&](Eigen::Index) { return normal(random); });
    difference *= share * scaled(state, 1 / bar.impedance()).norm() / difference.norm();
    difference = scaled(difference, bar.impedance());
    // Into the wall it must not be.
    const Mesh mesh{static_cast<int>(cells)};
    if (tip_displacement(bar, mesh, difference) > 0) difference = -difference;
    return state + difference;
}

}  // namespace nsma
