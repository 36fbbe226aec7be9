#pragma once

#include <Eigen/Core>

#include "nsma/wave/state.hpp"

namespace nsma {

/// What an engineer would reach for first: linear finite elements with lumped mass and a time
/// step, as references of the accuracy study. They march the same unilateral contact problem.
enum class FiniteElementScheme {
    central_penalty,  ///< central differences; the wall is a spring that only pushes
    moreau_jean       ///< implicit theta scheme; impact law and complementarity at the tip
};

struct FiniteElementOptions {
    FiniteElementScheme scheme = FiniteElementScheme::moreau_jean;
    int elements = 20;         ///< >= 1, of equal length h
    double courant = 0.9;      ///< c dt/h, > 0; central differences are stable up to 1 in free motion
    double penalty = 1.0;      ///< wall stiffness in units Y S/h, > 0; stable to c dt/h = 0.91 at 1, 0.42 at 10
    double restitution = 0.0;  ///< Newton's e in [0, 1]
};

/// A bar of finite elements that marches from a state of the wave method.
/// Source: Acary and Brogliato, Numerical Methods for Nonsmooth Dynamical Systems, 2008,
/// chapter 10, for the Moreau-Jean step; velocities hold at whole steps.
class FiniteElementBar {
public:
    /// Displacements of Q at the nodes, exact; velocities averaged over each node's share of the
    /// mass, so that momentum is kept. `duration` [s] is cut into a whole number of steps.
    /// Throws std::invalid_argument on a bad bar or state.
    FiniteElementBar(const Bar& bar, const Mesh& mesh, const State& state, double duration,
                     const FiniteElementOptions& options = {});

    void step();

    [[nodiscard]] int steps() const { return steps_; }                                    ///< time steps in `duration`
    [[nodiscard]] double time_step() const { return time_step_; }                         ///< [s]
    [[nodiscard]] double tip() const { return displacement_[displacement_.size() - 1]; }  ///< [m]
    [[nodiscard]] bool in_contact() const { return contact_; }  ///< the wall pushed in the last step
    [[nodiscard]] double energy() const;                        ///< [J], the penalty spring included
    /// Nodes 1..n from the fixed end.
    [[nodiscard]] const Eigen::VectorXd& displacement() const { return displacement_; }  ///< [m]
    [[nodiscard]] Eigen::VectorXd velocity() const;                                      ///< [m/s]
    /// Energy [J] that displacements and velocities of the nodes would have, without a wall.
    [[nodiscard]] double energy_of(const Eigen::VectorXd& displacement, const Eigen::VectorXd& velocity) const;

private:
    [[nodiscard]] Eigen::VectorXd elastic_force(const Eigen::VectorXd& displacement) const;
    [[nodiscard]] Eigen::VectorXd acceleration() const;
    void factorise();
    [[nodiscard]] Eigen::VectorXd solve(Eigen::VectorXd right) const;

    FiniteElementOptions options_;
    double gap_ = 0;
    double stiffness_ = 0;  // Y S/h
    double time_step_ = 0;
    int steps_ = 0;
    bool contact_ = false;
    Eigen::VectorXd mass_, displacement_;
    Eigen::VectorXd velocity_;       // central differences: half a step late
    Eigen::VectorXd pivot_, ratio_;  // of the tridiagonal matrix M + theta^2 dt^2 K
    Eigen::VectorXd tip_response_;   // its inverse times the tip's unit vector
};

}  // namespace nsma
