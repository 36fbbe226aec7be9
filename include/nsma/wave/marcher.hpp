#pragma once

#include <vector>

#include "nsma/wave/state.hpp"

namespace nsma {

/// Tolerances with which the marcher decides ties. Both are relative, so that no unit matters.
struct MarchOptions {
    /// The tip this near to the wall is at the wall, and a free step from farther away may end this
    /// far beyond it; relative to dt * sum|b|, a bound on every displacement of the motion.
    double touch_tolerance = 1e-9;
    /// A wave at the wall up to this is silent (no force): the phase keeps its name; relative to
    /// max|b|. Away from the wall contact ends beyond this tension.
    double silent_tolerance = 1e-9;
};

/// What a step was. `silent`: the tip is at the wall within tolerance and the wave that arrives
/// carries no force, so that "free" and "contact" are the same motion.
struct MarchedStep {
    double tip = 0.0;            ///< tip displacement at the start of the step [m]
    double contact_force = 0.0;  ///< [N], 0 in a free step; <= 0 is compression
    bool contact = false;        ///< the tip was held at the wall
    bool silent = false;         ///< no wave arrived at the wall
};

/// What the marcher saw over `periods` periods of `period_steps` steps.
struct MarchReport {
    std::vector<MarchedStep> first_period;  ///< period_steps entries
    int free_steps = 0;                     ///< seen in the first period
    int contact_steps = 0;                  ///< seen in the first period
    /// Times contact began in the first period, cyclically; 0 if it never ceases.
    int contact_phases = 0;
    double worst_penetration = 0.0;  ///< max of x - d over all steps, >= 0 [m]
    double worst_separation = 0.0;   ///< max of |x - d| over contact steps [m]
    double worst_tension = 0.0;      ///< max of lambda over contact steps, >= 0 [N]
    double largest_force = 0.0;      ///< max |lambda| [N]
    /// max over period ends of ||Q - Q0|| / ||Q0|| in the energy norm; 0 for Q0 = 0.
    double periodicity_defect = 0.0;
    double energy_drift = 0.0;  ///< max over period ends of |E - E0| / E0; 0 for Q0 = 0
    int periods = 0;            ///< marched
};

/// Marches the unilateral contact problem from Q0 with floating boundary conditions: contact
/// begins when a free step would penetrate the wall and ends when the contact force would be
/// tensile. At the wall (within the touch tolerance) a step is contact if it would end farther
/// beyond the wall than it starts from it; a silent step keeps the name of its phase and moves
/// likewise. Knows nothing of patterns, kernels or programs: it is the judge of their answers.
/// O(1) a step. Source: [1] p. 1 (floating boundary conditions). Throws std::invalid_argument on
/// a bad size, NaN, period_steps < 1, periods < 1 or a negative tolerance.
[[nodiscard]] MarchReport march(const Bar& bar, const Mesh& mesh, const State& initial_state, int period_steps,
                                int periods = 1, const MarchOptions& options = {});

}  // namespace nsma
