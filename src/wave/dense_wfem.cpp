#include "dense_wfem.hpp"

#include <stdexcept>

#include <fmt/format.h>

namespace nsma::dense {

namespace {

using Eigen::MatrixXd;

/// Interface values sigma* and v* as rows over the state, interfaces 0 (fixed end) to N
/// (contact end), then the update of the cells between them.
MatrixXd step_matrix(const Bar& bar, const Mesh& mesh, bool contact) {
    validate(bar);
    validate(mesh);
    const int cells = mesh.cells;
    const double z = bar.impedance();
    const auto stress = [](int cell) { return cell; };                 // column of sigma_{cell+1}
    const auto velocity = [cells](int cell) { return cells + cell; };  // column of v_{cell+1}

    MatrixXd interface_stress = MatrixXd::Zero(cells + 1, mesh.window());
    MatrixXd interface_velocity = MatrixXd::Zero(cells + 1, mesh.window());
    interface_stress(0, stress(0)) = 1.0;  // fixed end: v* = 0, sigma* = sigma_1 + z v_1
    interface_stress(0, velocity(0)) = z;
    for (int i = 1; i < cells; ++i) {
        interface_stress(i, stress(i - 1)) = 0.5;
        interface_stress(i, stress(i)) = 0.5;
        interface_stress(i, velocity(i - 1)) = -0.5 * z;
        interface_stress(i, velocity(i)) = 0.5 * z;
        interface_velocity(i, velocity(i - 1)) = 0.5;
        interface_velocity(i, velocity(i)) = 0.5;
        interface_velocity(i, stress(i - 1)) = -0.5 / z;
        interface_velocity(i, stress(i)) = 0.5 / z;
    }
    if (contact) {  // v* = 0, sigma* = sigma_N - z v_N
        interface_stress(cells, stress(cells - 1)) = 1.0;
        interface_stress(cells, velocity(cells - 1)) = -z;
    } else {  // sigma* = 0, v* = v_N - sigma_N/z
        interface_velocity(cells, velocity(cells - 1)) = 1.0;
        interface_velocity(cells, stress(cells - 1)) = -1.0 / z;
    }

    MatrixXd step = MatrixXd::Identity(mesh.window(), mesh.window());
    step.topRows(cells) += z * (interface_velocity.bottomRows(cells) - interface_velocity.topRows(cells));
    step.bottomRows(cells) += (interface_stress.bottomRows(cells) - interface_stress.topRows(cells)) / z;
    return step;
}

/// base^exponent by squaring.
MatrixXd power(MatrixXd base, int exponent) {
    MatrixXd result = MatrixXd::Identity(base.rows(), base.cols());
    while (exponent > 0) {
        if (exponent % 2 == 1) {
            result = result * base;
        }
        exponent /= 2;
        if (exponent > 0) {
            base = base * base;
        }
    }
    return result;
}

}  // namespace

Eigen::MatrixXd free_step_matrix(const Bar& bar, const Mesh& mesh) { return step_matrix(bar, mesh, false); }

Eigen::MatrixXd contact_step_matrix(const Bar& bar, const Mesh& mesh) { return step_matrix(bar, mesh, true); }

Eigen::MatrixXd periodicity_matrix(const Bar& bar, const Mesh& mesh, int free_steps, int contact_steps) {
    if (free_steps < 1) {
        throw std::invalid_argument(fmt::format("free_steps: expected at least 1, got {}", free_steps));
    }
    if (contact_steps < 1) {
        throw std::invalid_argument(fmt::format("contact_steps: expected at least 1, got {}", contact_steps));
    }
    const MatrixXd flight = power(free_step_matrix(bar, mesh), free_steps);
    const MatrixXd contact = power(contact_step_matrix(bar, mesh), contact_steps);
    return contact * flight - MatrixXd::Identity(mesh.window(), mesh.window());
}

void cell_step(const Bar& bar, const Mesh& mesh, bool contact, State& state) {
    validate(mesh, state);
    const int cells = mesh.cells;
    const double z = bar.impedance();
    auto stress = state.head(cells);
    auto velocity = state.tail(cells);

    double left_stress = stress[0] + z * velocity[0];  // fixed end
    double left_velocity = 0.0;
    for (int i = 0; i < cells; ++i) {
        double right_stress = 0.0;
        double right_velocity = 0.0;
        if (i + 1 < cells) {
            right_stress = 0.5 * (stress[i] + stress[i + 1]) + 0.5 * z * (velocity[i + 1] - velocity[i]);
            right_velocity = 0.5 * (velocity[i] + velocity[i + 1]) + 0.5 * (stress[i + 1] - stress[i]) / z;
        } else if (contact) {
            right_stress = stress[i] - z * velocity[i];
        } else {
            right_velocity = velocity[i] - stress[i] / z;
        }
        velocity[i] += (right_stress - left_stress) / z;
        stress[i] += z * (right_velocity - left_velocity);
        left_stress = right_stress;
        left_velocity = right_velocity;
    }
}

}  // namespace nsma::dense
