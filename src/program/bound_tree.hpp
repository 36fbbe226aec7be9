#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "form_bounds.hpp"

namespace nsma {

/// Branch and bound for the greatest |gamma|^2 over the admissible set: boxes of the columns, over each of which the secant
/// of the square is bounded by a linear program, whose multipliers prove the bound.
class BoundTree {
public:
    /// `attained` gives the greatest |gamma|^2 known, `offer` is given points that may beat it.
    BoundTree(const Kernel& kernel, const Reduction& reduction, FormBounds& bounds, std::function<double()> attained,
              std::function<void(const Eigen::VectorXd&)> offer);

    /// The proof by a tree of at most `node_limit` nodes, best bound first; 1: the root alone. Absent where a column has
    /// no bound.
    [[nodiscard]] std::optional<GreatestProof> grow(int node_limit);

private:
    struct Node {
        int index = 0;
        double bound = 0;
        Eigen::VectorXd lower;
        Eigen::VectorXd upper;
        Eigen::VectorXd point;
        RowCombination leaf;
    };
    [[nodiscard]] std::size_t variables() const { return static_cast<std::size_t>(reduction_.variables()); }
    bool make_box();
    [[nodiscard]] LinearProgram relaxation_program() const;
    bool relax(LinearSolver& solver, Node& node);
    void exact_root(Node& root);

    const Kernel& kernel_;
    const Reduction& reduction_;
    FormBounds& bounds_;
    std::function<double()> attained_;
    std::function<void(const Eigen::VectorXd&)> offer_;
    std::vector<FormBound> box_;
    Eigen::VectorXd box_lower_;
    Eigen::VectorXd box_upper_;
};

}  // namespace nsma
