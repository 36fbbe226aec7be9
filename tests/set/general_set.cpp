// The admissible set by linear programs and least norm, which ask nothing of its shape.
#include "general_set.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include <Eigen/QR>

#include "numerics/least_squares.hpp"
#include "numerics/linear_program.hpp"

namespace oracle {

using namespace nsma;

namespace {

// A projection shorter than this, relative to the projected row, is zero. The data are small
// integers, so a true projection is many orders longer; rounding leaves about 1e-15.
constexpr double projection_tolerance = 1e-9;
// LP optima over unit boxes are zero or at least of the order of one over the row entries.
constexpr double direction_tolerance = 1e-7;
// Rows this close to equality at a vertex of CLP (tolerance 1e-9) are taken as its active set.
constexpr double vertex_tolerance = 1e-7;
constexpr int climb_limit = 50;
// Above this many variables only the coordinate directions of a sample are climbed.
constexpr Eigen::Index full_climb_limit = 64;

// The kept rows of COND1 (<= 0) and, last, COND2 (contact_row . gamma = contact) as a linear program over gamma, whose
// bounds the caller sets.
LinearProgram conditions_program(const Reduction& reduction, double contact) {
    const auto count = reduction.rows.rows();
    LinearProgram program;
    program.rows.resize(count + 1, reduction.variables());
    program.rows.topRows(count) = reduction.rows.cast<double>();
    program.rows.row(count) = reduction.contact_row.cast<double>().transpose();
    program.row_lower = Eigen::VectorXd::Constant(count + 1, -no_bound);
    program.row_upper = Eigen::VectorXd::Zero(count + 1);
    program.row_lower[count] = contact;
    program.row_upper[count] = contact;
    return program;
}

using Bounds = std::vector<std::uint8_t>;  // 1: gamma_j >= 0

LinearProgram cone_program(const Reduction& reduction, const Bounds& bounded, double level, double box) {
    const auto n = static_cast<Eigen::Index>(reduction.variables());
    LinearProgram program = conditions_program(reduction, level);
    program.lower = Eigen::VectorXd::Zero(n);
    program.upper = Eigen::VectorXd::Constant(n, box);
    for (Eigen::Index j = 0; j < n; ++j) {
        if (bounded[static_cast<std::size_t>(j)] == 0) program.lower[j] = -box;
    }
    return program;
}

// Moves a vertex of CLP onto its active set exactly (least change), so that only rounding is left.
Eigen::VectorXd sharpened(const Reduction& reduction, const Bounds& bounded, const Eigen::VectorXd& vertex) {
    const double scale = std::max(vertex.cwiseAbs().maxCoeff(), 1e-300);
    const double tolerance = vertex_tolerance * scale;
    std::vector<Eigen::Index> free_columns;
    for (Eigen::Index j = 0; j < vertex.size(); ++j) {
        const bool at_zero = bounded[static_cast<std::size_t>(j)] != 0 && std::abs(vertex[j]) <= tolerance;
        if (!at_zero) free_columns.push_back(j);
    }
    std::vector<Eigen::Index> active;
    const Eigen::VectorXd slack = reduction.rows.cast<double>() * vertex;
    for (Eigen::Index i = 0; i < slack.size(); ++i) {
        if (slack[i] >= -tolerance) active.push_back(i);
    }
    const auto k = static_cast<Eigen::Index>(free_columns.size());
    Eigen::MatrixXd system(static_cast<Eigen::Index>(active.size()) + 1, k);
    for (Eigen::Index j = 0; j < k; ++j) {
        const auto column = free_columns[static_cast<std::size_t>(j)];
        for (std::size_t i = 0; i < active.size(); ++i) {
            system(static_cast<Eigen::Index>(i), j) = reduction.rows(active[i], column);
        }
        system(system.rows() - 1, j) = reduction.contact_row[column];
    }
    Eigen::VectorXd target = Eigen::VectorXd::Zero(system.rows());
    target[target.size() - 1] = reduction.gap_sign;
    Eigen::VectorXd point = vertex(free_columns);
    if (k > 0) {
        const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition(system);
        for (int pass = 0; pass < 2; ++pass) {
            point += decomposition.solve(target - system * point);
        }
    }
    Eigen::VectorXd result = Eigen::VectorXd::Zero(vertex.size());
    result(free_columns) = point;
    for (Eigen::Index j = 0; j < result.size(); ++j) {
        if (bounded[static_cast<std::size_t>(j)] != 0) result[j] = std::max(result[j], 0.0);
    }
    return result;
}

// A nonzero element of {rows gamma <= 0, contact_row gamma = 0, bounds}, or an empty vector.
Eigen::VectorXd cone_direction(const Reduction& reduction, const Bounds& bounded) {
    const auto n = static_cast<Eigen::Index>(reduction.variables());
    const bool free_variables = std::count(bounded.begin(), bounded.end(), std::uint8_t{0}) > 0;
    const bool one_sided = (reduction.contact_row.array() > 0).all() || (reduction.contact_row.array() < 0).all();
    if (!free_variables && one_sided) return {};
    Reduction homogeneous = reduction;
    homogeneous.gap_sign = 0;
    LinearSolver solver(cone_program(homogeneous, bounded, 0.0, 1.0));
    const auto direction = [&](const Eigen::VectorXd& cost) -> Eigen::VectorXd {
        const LinearSolution solution = solver.minimise(cost);
        if (solution.status != LinearStatus::optimal || solution.value > -direction_tolerance) return {};
        return sharpened(homogeneous, bounded, solution.x);
    };
    Eigen::VectorXd cost = Eigen::VectorXd::Zero(n);
    for (Eigen::Index j = 0; j < n; ++j) {
        if (bounded[static_cast<std::size_t>(j)] != 0) cost[j] = -1;
    }
    Eigen::VectorXd found = direction(cost);
    for (Eigen::Index j = 0; j < n && found.size() == 0; ++j) {
        if (bounded[static_cast<std::size_t>(j)] != 0) continue;
        for (const double side : {-1.0, 1.0}) {
            if (found.size() > 0) break;
            cost = Eigen::VectorXd::Zero(n);
            cost[j] = side;
            found = direction(cost);
        }
    }
    return found;
}

struct Projection {
    Eigen::VectorXd rho;
    bool converged = false;
};

// Projection of delta * contact_row on the cone {rows gamma <= 0, gamma_bounded >= 0}: what is
// left of it after nonnegative least squares over the cone's normals.
Projection project_contact_row(const Reduction& reduction, const Bounds& bounded) {
    const auto n = static_cast<Eigen::Index>(reduction.variables());
    std::vector<Eigen::Index> with_sign;
    for (Eigen::Index j = 0; j < n; ++j) {
        if (bounded[static_cast<std::size_t>(j)] != 0) with_sign.push_back(j);
    }
    const auto count = reduction.rows.rows();
    Eigen::MatrixXd normals = Eigen::MatrixXd::Zero(n, count + static_cast<Eigen::Index>(with_sign.size()));
    normals.leftCols(count) = reduction.rows.cast<double>().transpose();
    for (std::size_t k = 0; k < with_sign.size(); ++k) {
        normals(with_sign[k], count + static_cast<Eigen::Index>(k)) = -1.0;
    }
    const Eigen::VectorXd target = reduction.gap_sign * reduction.contact_row.cast<double>();
    NonnegativeSolution solution = nonnegative_least_squares(normals, target);
    Projection projection{std::move(solution.residual), solution.converged};
    for (const int k : solution.support) {
        if (k < count) continue;
        projection.rho[with_sign[static_cast<std::size_t>(k - count)]] = 0.0;  // exactly, not to rounding
    }
    return projection;
}

// Climbs |gamma|^2 over P by linear programs: each step maximises the linearisation, which for a
// convex function ends at a vertex no neighbour of which is better.
class Climber {
public:
    Climber(const AdmissibleSet& set, const Bounds& bounded, LinearSolver& solver)
        : set_(set), bounded_(bounded), solver_(solver) {}

    void climb(Eigen::VectorXd direction) {
        double best = -1;
        for (int step = 0; step < climb_limit; ++step) {
            const LinearSolution solution = solver_.minimise(-direction);
            if (solution.status != LinearStatus::optimal) return;
            Eigen::VectorXd vertex = sharpened(set_.reduction, bounded_, solution.x);
            const double value = vertex.squaredNorm();
            if (value <= best * (1 + 1e-12)) break;
            best = value;
            direction = vertex;
            keep(std::move(vertex));
        }
    }

    std::vector<Eigen::VectorXd> take() {
        std::stable_sort(found_.begin(), found_.end(),
                         [](const auto& a, const auto& b) { return a.squaredNorm() > b.squaredNorm() * (1 + 1e-12); });
        return std::move(found_);
    }

private:
    void keep(Eigen::VectorXd vertex) {
        for (const auto& known : found_) {
            if ((known - vertex).norm() <= 1e-9 * (1e-300 + vertex.norm())) return;
        }
        found_.push_back(std::move(vertex));
    }

    const AdmissibleSet& set_;
    const Bounds& bounded_;
    LinearSolver& solver_;
    std::vector<Eigen::VectorXd> found_;
};

// Extreme points (extreme directions of the box-cut cone for a closed gap) in fixed directions.
void find_vertices(AdmissibleSet& set, const Bounds& bounded, LinearSolver& solver) {
    const auto n = static_cast<Eigen::Index>(set.reduction.variables());
    Climber climber(set, bounded, solver);
    if (set.least.size() > 0) climber.climb(set.least);
    const Eigen::Index stride = std::max<Eigen::Index>(1, n / full_climb_limit);
    for (Eigen::Index j = 0; j < n; j += stride) {
        Eigen::VectorXd direction = Eigen::VectorXd::Zero(n);
        direction[j] = 1;
        climber.climb(direction);
        if (bounded[static_cast<std::size_t>(j)] != 0) continue;
        direction[j] = -1;
        climber.climb(direction);
    }
    // Free variables can alternate in sign from class to class: no coordinate direction shows it.
    for (const int period : {1, 2, 3, 4}) {
        for (int shift = 0; shift < period; ++shift) {
            Eigen::VectorXd direction(n);
            for (Eigen::Index j = 0; j < n; ++j) {
                const bool positive = bounded[static_cast<std::size_t>(j)] != 0 || (j + shift) / period % 2 == 0;
                direction[j] = positive ? 1.0 : -1.0;
            }
            climber.climb(direction);
            climber.climb(-direction);
        }
    }
    set.vertices = climber.take();
}

void decide_closed_gap(AdmissibleSet& set, const Bounds& bounded) {
    set.ray = cone_direction(set.reduction, bounded);
    if (set.ray.size() == 0) {
        set.status = AdmissibleSet::Status::empty;
        set.reason = "linear program: only rest meets COND1-3 at a closed gap";
        return;
    }
    set.status = AdmissibleSet::Status::nonempty;
    set.ray.normalize();
    set.vertices = {set.ray};
    LinearSolver solver(cone_program(set.reduction, bounded, 0.0, 1.0));
    find_vertices(set, bounded, solver);
    for (auto& vertex : set.vertices) {
        if (vertex.norm() > 0) vertex.normalize();
    }
    std::erase_if(set.vertices, [](const auto& vertex) { return vertex.norm() < 0.5; });
    if (set.vertices.empty()) set.vertices = {set.ray};
}

}  // namespace

nsma::AdmissibleSet general_set(nsma::Reduction reduction, Bounds bounded) {
    if (bounded.empty()) bounded.assign(static_cast<std::size_t>(reduction.variables()), reduction.bounded ? 1 : 0);
    AdmissibleSet set;
    set.reduction = std::move(reduction);
    const Reduction& data = set.reduction;
    if (!data.empty_because.empty()) {
        set.status = AdmissibleSet::Status::empty;
        set.reason = data.empty_because;
        return set;
    }
    if (data.gap_sign == 0) {
        decide_closed_gap(set, bounded);
        return set;
    }

    const Eigen::VectorXd target = data.contact_row.cast<double>();
    const Projection projection = project_contact_row(data, bounded);
    const bool projected_empty = projection.rho.norm() <= projection_tolerance * target.norm();
    LinearSolver solver(cone_program(data, bounded, data.gap_sign, no_bound));
    const LinearSolution feasible = solver.minimise(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(data.variables())));
    const bool linear_empty = feasible.status == LinearStatus::infeasible;
    if (!projection.converged) throw std::runtime_error("the least-norm projection did not converge");
    if (linear_empty != projected_empty || (!linear_empty && feasible.status != LinearStatus::optimal)) {
        throw std::runtime_error("the linear program and the least-norm projection disagree on emptiness");
    }
    if (projected_empty) {
        set.status = AdmissibleSet::Status::empty;
        set.reason = "linear program: COND1-3 exclude one another";
        return set;
    }
    set.status = AdmissibleSet::Status::nonempty;
    set.least = projection.rho / projection.rho.squaredNorm();
    // One exact scaling onto COND2, so that only rounding of a single product is left.
    set.least *= data.gap_sign / target.dot(set.least);
    set.ray = cone_direction(data, bounded);
    if (set.unbounded()) {
        set.ray.normalize();
        LinearSolver boxed(cone_program(data, bounded, data.gap_sign, 100.0 * set.least.norm()));
        find_vertices(set, bounded, boxed);
    } else {
        find_vertices(set, bounded, solver);
    }
    return set;
}

}  // namespace oracle
