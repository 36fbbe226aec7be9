#pragma once

#include <vector>

#include <Eigen/Core>

#include "program.hpp"

namespace nsma {

/// An inequality or a bound of a program, a.x <= b.
struct Row {
    enum class Kind { inequality, lower, upper };
    Kind kind;
    Eigen::Index index;
};

/// The feasible set as rows a.x <= b, equalities apart, and the moves along its boundary.
class Boundary {
public:
    /// The program must outlive this object.
    explicit Boundary(const Program& program) : program_(program), equalities_(program.equalities) {}

    [[nodiscard]] const Program& program() const { return program_; }
    [[nodiscard]] const Eigen::MatrixXd& equalities() const { return equalities_; }

    [[nodiscard]] double slack(const Row& row, const Eigen::VectorXd& x) const;               ///< b - a.x
    [[nodiscard]] double along(const Row& row, const Eigen::VectorXd& direction) const;       ///< a.direction
    [[nodiscard]] std::vector<Row> active(const Eigen::VectorXd& x, double tolerance) const;  ///< slack <= tolerance
    [[nodiscard]] Eigen::MatrixXd normals(const std::vector<Row>& rows) const;                ///< a, one a row

    /// Orthonormal basis of the directions in which the equalities and `rows` keep their values.
    [[nodiscard]] Eigen::MatrixXd directions(const std::vector<Row>& rows) const;
    /// Nearest point of the flat on which `rows` and the equalities hold exactly.
    [[nodiscard]] Eigen::VectorXd project(const std::vector<Row>& rows, Eigen::VectorXd x) const;
    /// Moves x back to the sphere within x + span(basis); false where the flat misses it.
    [[nodiscard]] bool retract(const Eigen::MatrixXd& basis, Eigen::VectorXd& x) const;
    /// x with everything off the sphere set to zero: the gradient of the sphere is twice this.
    [[nodiscard]] Eigen::VectorXd on_sphere(Eigen::VectorXd x) const;
    /// Largest t <= 1 for which no row is crossed along x + t direction; the blocking row joins `blocking` if t < 1.
    double step_to_boundary(const Eigen::VectorXd& x, const Eigen::VectorXd& direction, double tolerance,
                            std::vector<Row>& blocking) const;

private:
    // Equalities above the inequalities among `rows`, on the unknowns that no bound among them holds.
    struct Flat {
        std::vector<Eigen::Index> free;
        Eigen::MatrixXd system;
    };
    [[nodiscard]] Flat flat_of(const std::vector<Row>& rows) const;

    template <typename Visit>
    void for_each_row(const Visit& visit) const;

    const Program& program_;
    Eigen::MatrixXd equalities_;
};

}  // namespace nsma
