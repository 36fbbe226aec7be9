#include "relaxed_solver.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "tied_optima.hpp"
#include "nsma/numerics/interruption.hpp"
#include "numerics/boundary.hpp"
#include "numerics/linear_program.hpp"
#include "numerics/polish.hpp"
#include "set/level_points.hpp"

namespace nsma {
namespace {

// CLP works to 1e-9, rows are scaled to order one: a vertex may be this far from its rows.
constexpr double activity = 1e-7;
// The rays and nonzero points sought lie in a unit box over small integer rows.
constexpr double direction_tolerance = 1e-7;
constexpr int climb_limit = 50;
// Energies of vertices and lengths of steps differ by rounding only.
constexpr double energy_rounding = 1e-12;

// The linear rows of a program without bounds on its unknowns, over x = plus - minus with both
// >= 0: CLP has called points optimal that were not, or cycled, where every unknown was free.
class LinearPart {
public:
    /// `box`: bound of plus and minus.
    explicit LinearPart(const Program& program, double box = no_bound) : solver_(split(program, box)) {}

    LinearSolution minimise(const Eigen::VectorXd& cost) {
        const auto n = cost.size();
        Eigen::VectorXd both(2 * n);
        both << cost, -cost;
        LinearSolution solution = solver_.minimise(both);
        if (solution.status == LinearStatus::optimal) {
            solution.x = Eigen::VectorXd(solution.x.head(n) - solution.x.tail(n));
        }
        return solution;
    }

private:
    static LinearProgram split(const Program& program, double box) {
        const auto n = program.variables();
        const auto inequalities = program.inequalities.rows();
        const auto equalities = program.equalities.rows();
        Eigen::MatrixXd rows(inequalities + equalities, n);
        rows << Eigen::MatrixXd(program.inequalities), Eigen::MatrixXd(program.equalities);
        LinearProgram result;
        result.rows.resize(rows.rows(), 2 * n);
        result.rows << rows, -rows;
        result.row_upper.resize(rows.rows());
        result.row_upper << program.inequality_values, program.equality_values;
        result.row_lower = Eigen::VectorXd::Constant(rows.rows(), -no_bound);
        result.row_lower.tail(equalities) = program.equality_values;
        result.lower = Eigen::VectorXd::Zero(2 * n);
        result.upper = Eigen::VectorXd::Constant(2 * n, box);
        return result;
    }

    LinearSolver solver_;
};

// Moves a point onto the rows near it, so that only rounding is left: with the widest tolerance whose rows do meet in
// a point of the set, since rows a small relaxation apart are not one vertex.
Eigen::VectorXd sharpened(const Program& program, const Eigen::VectorXd& x) {
    const Boundary boundary(program);
    const double size = 1.0 + x.cwiseAbs().maxCoeff();
    for (const double tolerance : {activity, 1e-2 * activity}) {
        Eigen::VectorXd moved = boundary.project(boundary.active(x, tolerance * size), x);
        if (program.violation(moved) <= PolishOptions{}.feasibility * size) return moved;
    }
    return x;
}

// A point of the rows other than rest, which meets them; empty when there is none.
Eigen::VectorXd other_than_rest(const Program& program) {
    const auto n = program.variables();
    LinearPart solver(program, 1.0);
    for (Eigen::Index j = 0; j < n; ++j) {
        for (const double side : {-1.0, 1.0}) {
            const LinearSolution solution = solver.minimise(side * Eigen::VectorXd::Unit(n, j));
            if (solution.status == LinearStatus::optimal && solution.value <= -direction_tolerance) return solution.x;
        }
    }
    return {};
}

// A direction in which the set has no end, in beta; empty when there is none.
Eigen::VectorXd recession(const RelaxedProgram& form) {
    Program cone = form.program;
    cone.inequality_values.setZero();
    cone.equality_values.setZero();
    Eigen::VectorXd direction = other_than_rest(cone);
    if (direction.size() == 0) return direction;
    // Active rows of the box are no part of the cone: only the cone's are sharpened.
    return form.beta(sharpened(cone, direction)).normalized();
}

// Vertices reached by climbing the energy along linear programs from points known and from fixed directions, the
// greatest energy first.
class Climber {
public:
    explicit Climber(const RelaxedProgram& form) : form_(form), solver_(form.program) {}

    [[nodiscard]] std::vector<Eigen::VectorXd> vertices(const std::vector<Eigen::VectorXd>& known) {
        const auto n = form_.program.variables();
        for (const auto& from : known) {
            if (from.squaredNorm() > 0) climb(from);
        }
        for (Eigen::Index j = 0; j < n; ++j) {
            for (const double side : {1.0, -1.0}) climb(side * Eigen::VectorXd::Unit(n, j));
        }
        for (const int period : {1, 2, 3, 4}) {
            for (const double side : {1.0, -1.0}) {
                climb(Eigen::VectorXd::NullaryExpr(
                    n, [&](Eigen::Index j) { return (j / period) % 2 == 0 ? side : -side; }));
            }
        }
        std::stable_sort(found_.begin(), found_.end(), [](const auto& a, const auto& b) {
            return a.squaredNorm() > b.squaredNorm() * (1 + energy_rounding);
        });
        for (auto& x : found_) x *= form_.scale;
        return std::move(found_);
    }

private:
    void climb(Eigen::VectorXd direction) {
        double best = -1;
        for (int step = 0; step < climb_limit; ++step) {
            stop_point();
            const LinearSolution solution = solver_.minimise(-direction);
            if (solution.status != LinearStatus::optimal) return;
            direction = sharpened(form_.program, solution.x);
            const double value = direction.squaredNorm();
            if (value <= best * (1 + energy_rounding)) return;
            best = value;
            keep(direction);
        }
    }

    void keep(const Eigen::VectorXd& vertex) {
        for (const auto& known : found_) {
            if ((known - vertex).norm() <= 1e-9 * (1e-300 + vertex.norm())) return;
        }
        found_.push_back(vertex);
    }

    const RelaxedProgram& form_;
    LinearPart solver_;
    std::vector<Eigen::VectorXd> found_;
};

// A random point of the set.
Eigen::VectorXd mixture(const Eigen::VectorXd& base, const std::vector<Eigen::VectorXd>& vertices,
                        std::mt19937_64& generator) {
    Eigen::VectorXd sum = base;
    double total = 1.0;
    for (const auto& vertex : vertices) {
        const double weight = random_weight(generator);
        sum += weight * vertex;
        total += weight;
    }
    return sum / total;
}

}  // namespace

bool attainable(const RelaxedSet& set, const Shift& shift) {
    const Program program = relaxed_program(set, Objective::min_energy, set.energy_factor, shift).program;
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(program.variables());
    if (program.violation(rest) <= 0) return other_than_rest(program).size() > 0;
    return LinearPart(program).minimise(rest).status == LinearStatus::optimal;
}

RelaxedInterval relaxed_interval(const RelaxedSet& set, const Shift& shift, bool greatest) {
    RelaxedInterval result;
    const RelaxedProgram form = relaxed_program(set, Objective::min_energy, set.energy_factor, shift);
    const LinearSolution feasible = LinearPart(form.program).minimise(Eigen::VectorXd::Zero(form.program.variables()));
    result.empty = feasible.status == LinearStatus::infeasible;
    result.failed = !result.empty && feasible.status != LinearStatus::optimal;
    if (result.empty || result.failed) return result;
    const Polished least = polish(form.program, sharpened(form.program, feasible.x));
    result.failed = !least.feasible || !least.stationary;
    if (result.failed) return result;
    result.least_point = form.beta(least.x);
    result.least = set.energy(result.least_point);
    const bool rest = result.least <= 1e-18 * set.energy_factor;
    if (!greatest && !rest) return result;
    result.ray = recession(form);
    result.unbounded = result.ray.size() > 0;
    if (result.unbounded) return result;
    // Without a relaxation every vertex of the greatest energy is known; a relaxation may raise any of them.
    std::vector<Eigen::VectorXd> known{least.x};
    for (const auto& beta : vertices_of_greatest_energy(set.kernel, set.gap_sign)) known.push_back(beta / form.scale);
    result.vertices = Climber(form).vertices(known);
    if (result.vertices.empty()) result.vertices = {result.least_point};
    result.greatest = std::max(result.least, set.energy(result.vertices.front()));
    result.empty = rest && set.energy(result.vertices.front()) <= energy_rounding * set.energy_factor;
    return result;
}

std::optional<RelaxedOptimum> relaxed_optimum(const RelaxedSet& set, const RelaxedInterval& interval,
                                              const RelaxedRequest& request) {
    if (is_extreme(request.objective)) throw std::invalid_argument("objective: expected one at a level, got an energy");
    const RelaxedProgram form = relaxed_program(set, request.objective, request.level, request.shift);
    const double level = request.level + request.shift.level;
    if (interval.failed || interval.empty || level < interval.least) return std::nullopt;
    if (!interval.unbounded && level > interval.greatest) return std::nullopt;

    const Eigen::VectorXd base = interval.least_point / form.scale;
    const auto on_level = [&](const Eigen::VectorXd& x) {
        if (x.squaredNorm() >= 1) return crossing(base, x, 1.0);
        if (!interval.unbounded) return crossing(x, interval.vertices.front() / form.scale, 1.0);
        return crossing(x, Eigen::VectorXd(x + (1.0 + x.norm()) * interval.ray), 1.0);
    };
    std::optional<RelaxedOptimum> best;
    bool global = false;  // weak duality proves the best one
    const auto attempt = [&](const Eigen::VectorXd& x) {
        const Polished polished = polish(form.program, form.point(form.scale * on_level(x)));
        if (!polished.feasible || !polished.stationary) return;
        const double objective = polished.objective * form.objective_unit;
        if (best && objective >= best->objective) return;
        best = RelaxedOptimum{form.beta(polished.x), objective};
        global = polished.objective - polished.lower_bound <= 1e-6 * std::abs(polished.objective);
    };
    // Nearest point of the relaxed set to a given one: a convex program from an admissible start.
    Program nearest = relaxed_program(set, Objective::min_energy, level, request.shift).program;
    for (const auto& beta : request.near) {
        const Eigen::VectorXd wanted = beta / form.scale;
        if (nearest.violation(wanted) <= PolishOptions{}.activity) {
            attempt(wanted);
            continue;
        }
        nearest.gradient = -2.0 * wanted;
        const Polished closest = polish(nearest, base);
        if (closest.feasible) attempt(closest.x);
    }
    // From the outermost points, then between them: random ones alone miss optima, and rounding decides which.
    for (const auto& vertex : interval.vertices) {
        if (global) break;
        attempt(vertex / form.scale);
    }
    std::mt19937_64 generator(1);
    for (int k = 0; k < request.starts && !global; ++k) {
        stop_point();
        attempt(mixture(interval.least_point, interval.vertices, generator) / form.scale);
    }
    return best;
}

}  // namespace nsma
