#include "bound_tree.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

#include "conditions_program.hpp"

namespace nsma {
namespace {

// Multipliers of inner leaves are rounded to this grid: any nonnegative ones prove a bound.
constexpr double multiplier_grid = 0x1.0p40;
// A relaxation this close to the attained value ends its branch.
constexpr double branch_tolerance = 1e-10;

}  // namespace

BoundTree::BoundTree(const Kernel& kernel, const Reduction& reduction, FormBounds& bounds, std::function<double()> attained,
                     std::function<void(const Eigen::VectorXd&)> offer)
    : kernel_(kernel), reduction_(reduction), bounds_(bounds), attained_(std::move(attained)), offer_(std::move(offer)) {}

// Best-first branch and bound on the box of the columns; each leaf keeps the multipliers of
// its relaxation, and the root those of the exact linear program.
std::optional<GreatestProof> BoundTree::grow(int node_limit) {
    if (!make_box()) return std::nullopt;
    GreatestProof candidate;
    candidate.box = box_;
    Node root;
    root.lower = box_lower_;
    root.upper = box_upper_;
    candidate.tree.emplace_back();
    LinearSolver solver(relaxation_program());
    if (!relax(solver, root)) return std::nullopt;
    exact_root(root);
    candidate.tree[0].leaf = root.leaf;
    if (node_limit <= 1) return candidate;

    const auto worse = [](const Node& a, const Node& b) {
        return a.bound != b.bound ? a.bound < b.bound : a.index > b.index;
    };
    std::priority_queue<Node, std::vector<Node>, decltype(worse)> open(worse);
    open.push(std::move(root));
    while (!open.empty() && static_cast<int>(candidate.tree.size()) + 2 <= node_limit) {
        if (open.top().bound <= attained_() * (1 + branch_tolerance)) break;
        const Node node = open.top();
        open.pop();
        // Where the secant is furthest above the square, the relaxation errs most.
        Eigen::Index split = 0;
        const Eigen::VectorXd error = (node.point - node.lower).cwiseProduct(node.upper - node.point);
        error.maxCoeff(&split);
        const double at = 0.5 * (node.lower[split] + node.upper[split]);
        const int low_index = static_cast<int>(candidate.tree.size());
        auto& parent = candidate.tree[static_cast<std::size_t>(node.index)];
        const int flip = reduction_.flip[static_cast<std::size_t>(split)];
        parent.split_column = reduction_.column[static_cast<std::size_t>(split)];
        parent.split_at = exact(flip * at);
        parent.low = flip > 0 ? low_index : low_index + 1;
        parent.high = flip > 0 ? low_index + 1 : low_index;
        parent.leaf = {};
        candidate.tree.emplace_back();
        candidate.tree.emplace_back();
        for (const int side : {0, 1}) {
            Node child{low_index + side, 0, node.lower, node.upper, {}, {}};
            (side == 0 ? child.upper : child.lower)[split] = at;
            if (!relax(solver, child)) {
                // Empty box: any multipliers; those of the parent still bound it.
                candidate.tree[static_cast<std::size_t>(child.index)].leaf = node.leaf;
                continue;
            }
            candidate.tree[static_cast<std::size_t>(child.index)].leaf = child.leaf;
            open.push(std::move(child));
        }
    }
    return candidate;
}

bool BoundTree::make_box() {
    if (!box_.empty()) return true;
    box_lower_ = Eigen::VectorXd::Zero(reduction_.variables());
    box_upper_ = box_lower_;
    for (std::size_t j = 0; j < variables(); ++j) {
        for (const int side : {1, -1}) {
            std::vector<Rational> form(variables());
            form[j] = side;
            auto bound = bounds_.bound(form);
            if (!bound) return false;
            const double value = to_double(bound->proof.contact * reduction_.gap_sign);
            (side > 0 ? box_upper_ : box_lower_)[static_cast<Eigen::Index>(j)] = side * value;
            box_.push_back(std::move(*bound));
        }
    }
    for (const auto& zero : reduction_.forced) {
        for (const int side : {1, -1}) {
            std::vector<Rational> full(static_cast<std::size_t>(kernel_.dimension()));
            full[static_cast<std::size_t>(zero.column)] = side;
            FormBound bound{sparse(full), {}};
            bounds_.cover_forced(full, bound.proof);
            box_.push_back(std::move(bound));
        }
    }
    return true;
}

LinearProgram BoundTree::relaxation_program() const {
    LinearProgram program = conditions_program(reduction_, reduction_.gap_sign);
    program.lower = box_lower_;
    program.upper = box_upper_;
    return program;
}

// Solves the relaxation of a node; false where its box holds no admissible point.
bool BoundTree::relax(LinearSolver& solver, Node& node) {
    for (Eigen::Index j = 0; j < node.lower.size(); ++j) {
        solver.set_bounds(j, node.lower[j], node.upper[j]);
    }
    const Eigen::VectorXd secant = node.lower + node.upper;
    const LinearSolution solution = solver.minimise(-secant);
    if (solution.status != LinearStatus::optimal) return false;
    node.bound = -solution.value - node.lower.dot(node.upper);
    node.point = solution.x;
    const auto count = reduction_.rows.rows();
    for (Eigen::Index i = 0; i < count; ++i) {
        const double y = std::round(std::max(-solution.row_dual[i], 0.0) * multiplier_grid) / multiplier_grid;
        if (y > 0) node.leaf.rows.emplace_back(reduction_.row_step[static_cast<std::size_t>(i)], exact(y));
    }
    node.leaf.contact = exact(std::round(-solution.row_dual[count] * multiplier_grid) / multiplier_grid);
    if (node.point.squaredNorm() > attained_() * (1 + branch_tolerance)) offer_(node.point);
    return true;
}

// The root's multipliers without rounding, so that a tight relaxation is an equality.
void BoundTree::exact_root(Node& root) {
    std::vector<Rational> secant(variables());
    for (std::size_t j = 0; j < variables(); ++j) {
        // Box bounds of column j stand at 2j (upper) and 2j + 1 (of the negative).
        const Rational upper = box_[2 * j].proof.contact * reduction_.gap_sign;
        const Rational lower = -box_[2 * j + 1].proof.contact * reduction_.gap_sign;
        secant[j] = upper + lower;
    }
    if (auto bound = bounds_.bound(secant)) root.leaf = std::move(bound->proof);
}

}  // namespace nsma
