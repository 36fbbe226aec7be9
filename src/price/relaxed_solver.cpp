#include "relaxed_solver.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "numerics/decompositions.hpp"
#include "numerics/linear_program.hpp"
#include "nsma/set/admissible_set.hpp"
#include "search/orbit_program.hpp"

namespace nsma {
namespace {

// CLP works to 1e-9, rows are scaled to order one: a vertex may be this far from its rows.
constexpr double activity = 1e-7;
// The rays and nonzero points sought lie in a unit box over small integer rows.
constexpr double direction_tolerance = 1e-7;
constexpr int climb_limit = 50;
// Vertices of one energy differ by the rounding of sums of small integers.
constexpr double tie_tolerance = 1e-12;

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

// Moves a point onto the rows within `tolerance`, so that only rounding is left.
Eigen::VectorXd onto_rows(const Program& program, Eigen::VectorXd x, double tolerance) {
    const Eigen::VectorXd slack = program.inequality_values - program.inequalities * x;
    std::vector<Eigen::Index> active;
    for (Eigen::Index i = 0; i < slack.size(); ++i) {
        if (slack[i] <= tolerance) active.push_back(i);
    }
    const auto equalities = program.equalities.rows();
    Eigen::MatrixXd system(equalities + static_cast<Eigen::Index>(active.size()), x.size());
    Eigen::VectorXd target(system.rows());
    system.topRows(equalities) = Eigen::MatrixXd(program.equalities);
    target.head(equalities) = program.equality_values;
    for (std::size_t k = 0; k < active.size(); ++k) {
        const auto at = equalities + static_cast<Eigen::Index>(k);
        system.row(at) = Eigen::RowVectorXd(program.inequalities.row(active[k]));
        target[at] = program.inequality_values[active[k]];
    }
    if (system.rows() == 0) return x;
    return x + MinimumNorm(system).refined(target - system * x);
}

// The same with the widest tolerance whose rows do meet in a point of the set: rows a small
// relaxation apart are not one vertex.
Eigen::VectorXd sharpened(const Program& program, const Eigen::VectorXd& x) {
    const double size = 1.0 + x.cwiseAbs().maxCoeff();
    for (const double tolerance : {activity, 1e-2 * activity}) {
        Eigen::VectorXd moved = onto_rows(program, x, tolerance * size);
        if (program.violation(moved) <= PolishOptions{}.feasibility * size) return moved;
    }
    return x;
}

// A nonzero direction within the homogeneous rows, in beta; empty when there is none.
Eigen::VectorXd recession(const RelaxedProgram& form) {
    Program cone = form.program;
    cone.inequality_values.setZero();
    cone.equality_values.setZero();
    const auto n = cone.variables();
    LinearPart solver(cone, 1.0);
    for (Eigen::Index j = 0; j < n; ++j) {
        for (const double side : {-1.0, 1.0}) {
            Eigen::VectorXd cost = Eigen::VectorXd::Zero(n);
            cost[j] = side;
            const LinearSolution solution = solver.minimise(cost);
            if (solution.status != LinearStatus::optimal || solution.value > -direction_tolerance) continue;
            // Active rows of the box are no part of the cone: only the cone's are sharpened.
            return form.beta(sharpened(cone, solution.x)).normalized();
        }
    }
    return {};
}

// Vertices reached by climbing the energy along linear programs from fixed directions.
class Climber {
public:
    explicit Climber(const RelaxedProgram& form) : form_(form), solver_(form.program) {}

    void climb(Eigen::VectorXd direction) {
        double best = -1;
        for (int step = 0; step < climb_limit; ++step) {
            const LinearSolution solution = solver_.minimise(-direction);
            if (solution.status != LinearStatus::optimal) return;
            Eigen::VectorXd vertex = sharpened(form_.program, solution.x);
            const double value = vertex.squaredNorm();
            if (value <= best * (1 + 1e-12)) return;
            best = value;
            direction = vertex;
            keep(std::move(vertex));
        }
    }

    [[nodiscard]] std::vector<Eigen::VectorXd> take() {
        std::stable_sort(found_.begin(), found_.end(),
                         [](const auto& a, const auto& b) { return a.squaredNorm() > b.squaredNorm() * (1 + 1e-12); });
        for (auto& x : found_) x *= form_.scale;
        return std::move(found_);
    }

private:
    void keep(Eigen::VectorXd vertex) {
        for (const auto& known : found_) {
            if ((known - vertex).norm() <= 1e-9 * (1e-300 + vertex.norm())) return;
        }
        found_.push_back(std::move(vertex));
    }

    const RelaxedProgram& form_;
    LinearPart solver_;
    std::vector<Eigen::VectorXd> found_;
};

// `known`: where to climb from beside fixed directions.
std::vector<Eigen::VectorXd> climb_all(const RelaxedProgram& form, const std::vector<Eigen::VectorXd>& known) {
    const auto n = form.program.variables();
    Climber climber(form);
    for (const auto& from : known) {
        if (from.squaredNorm() > 0) climber.climb(from);
    }
    for (Eigen::Index j = 0; j < n; ++j) {
        for (const double side : {1.0, -1.0}) {
            Eigen::VectorXd direction = Eigen::VectorXd::Zero(n);
            direction[j] = side;
            climber.climb(direction);
        }
    }
    for (const int period : {1, 2, 3, 4}) {
        for (const double side : {1.0, -1.0}) {
            Eigen::VectorXd direction(n);
            for (Eigen::Index j = 0; j < n; ++j) direction[j] = (j / period) % 2 == 0 ? side : -side;
            climber.climb(direction);
        }
    }
    return climber.take();
}

// t in [0, 1] with |from + t (to - from)| = 1, from inside to outside.
Eigen::VectorXd crossing(const Eigen::VectorXd& from, const Eigen::VectorXd& to) {
    const Eigen::VectorXd direction = to - from;
    const double a = direction.squaredNorm();
    const double b = from.dot(direction);
    const double c = std::min(from.squaredNorm() - 1.0, 0.0);
    const double root = std::sqrt(std::max(b * b - a * c, 0.0));
    const double t = b > 0 ? -c / (b + root) : (root - b) / a;
    return from + std::min(t, 1.0) * direction;
}

}  // namespace

RelaxedInterval relaxed_interval(const RelaxedSet& set, const Shift& shift, bool greatest) {
    RelaxedInterval result;
    const RelaxedProgram form = relaxed_program(set, Objective::min_energy, set.energy_factor, shift);
    LinearPart solver(form.program);
    const LinearSolution feasible = solver.minimise(Eigen::VectorXd::Zero(form.program.variables()));
    if (feasible.status == LinearStatus::infeasible) {
        result.empty = true;
        return result;
    }
    if (feasible.status != LinearStatus::optimal) {
        result.failed = true;
        return result;
    }
    const Polished least = polish(form.program, sharpened(form.program, feasible.x));
    if (!least.feasible || !least.stationary) {
        result.failed = true;
        return result;
    }
    result.least_point = form.beta(least.x);
    result.least = set.energy(result.least_point);
    const bool rest = result.least <= 1e-18 * set.energy_factor;
    if (!greatest && !rest) return result;
    result.ray = recession(form);
    result.unbounded = result.ray.size() > 0;
    if (!result.unbounded) {
        // Without a relaxation every vertex of the greatest energy is known; a relaxation may raise any of them.
        std::vector<Eigen::VectorXd> known{least.x};
        const AdmissibleSet tight = admissible_set(reduce(conditions(set.kernel, set.gap_sign)));
        for (const auto& vertex : tight.vertices) {
            if (tight.energy(vertex) < tight.energy(tight.vertices.front()) * (1 - tie_tolerance)) break;
            known.push_back(tight.reduction.beta(vertex) / form.scale);
        }
        result.vertices = climb_all(form, known);
        if (result.vertices.empty()) result.vertices = {result.least_point};
        result.greatest = std::max(result.least, set.energy(result.vertices.front()));
        result.empty = rest && set.energy(result.vertices.front()) <= 1e-12 * set.energy_factor;
    }
    return result;
}

RelaxedOptimum relaxed_optimum(const RelaxedSet& set, const RelaxedInterval& interval, const RelaxedRequest& request) {
    using Status = RelaxedOptimum::Status;
    RelaxedOptimum result;
    if (interval.failed) return result;
    if (interval.empty) {
        result.status = Status::empty;
        return result;
    }
    if (request.objective == Objective::min_energy) {
        result = {Status::optimal, interval.least_point, interval.least, true};
        return result;
    }
    if (!request.level || request.objective == Objective::max_energy) {
        throw std::invalid_argument("level: expected one unless the objective is min-energy");
    }
    const double level = *request.level + request.shift.level;
    if (level < interval.least) {
        result.status = Status::below;
        return result;
    }
    if (!interval.unbounded && level > interval.greatest) {
        result.status = Status::above;
        return result;
    }
    const RelaxedProgram form =
        relaxed_program(set, request.objective, *request.level, request.shift, request.reference);
    const RelaxedProgram plain = relaxed_program(set, Objective::least_shock, *request.level, request.shift);
    const Eigen::VectorXd base = interval.least_point / form.scale;
    Eigen::VectorXd top = interval.unbounded ? base : Eigen::VectorXd(interval.vertices.front() / form.scale);
    const auto on_level = [&](const Eigen::VectorXd& x) {
        if (x.squaredNorm() >= 1) return crossing(base, x);
        if (!interval.unbounded) return crossing(x, top);
        return crossing(x, Eigen::VectorXd(x + (1.0 + x.norm()) * interval.ray));
    };
    const auto attempt = [&](const Eigen::VectorXd& x) {
        const Polished polished = polish(form.program, form.point(form.scale * on_level(x)));
        if (!polished.feasible || !polished.stationary) return;
        const double objective = polished.objective * form.objective_unit;
        if (result.status == Status::optimal && objective >= result.objective) return;
        result.status = Status::optimal;
        result.beta = form.beta(polished.x);
        result.objective = objective;
        result.global = polished.objective - polished.lower_bound <= 1e-6 * std::abs(polished.objective);
    };
    // Nearest point of the relaxed set to a given one: a convex program from an admissible start.
    Program nearest = plain.program;
    nearest.sphere_variables = 0;
    nearest.hessian.setZero();
    for (Eigen::Index j = 0; j < nearest.variables(); ++j) nearest.hessian.insert(j, j) = 2.0;
    nearest.hessian.makeCompressed();
    for (const auto& beta : request.near) {
        const Eigen::VectorXd wanted = beta / form.scale;
        nearest.gradient.setZero();
        if (nearest.violation(wanted) <= PolishOptions{}.activity) {
            attempt(wanted);
            continue;
        }
        nearest.gradient = -2.0 * wanted;
        const Polished closest = polish(nearest, base);
        if (closest.feasible) attempt(closest.x);
    }
    std::mt19937_64 generator(1);
    for (int k = 0; k < request.starts; ++k) {
        if (result.global) break;
        Eigen::VectorXd mixture = base;
        double total = 1.0;
        const auto add = [&](const Eigen::VectorXd& x) {
            const double uniform = (static_cast<double>(generator() >> 11) + 0.5) * 0x1.0p-53;
            const double weight = -std::log(uniform);
            mixture += weight * x;
            total += weight;
        };
        for (const auto& vertex : interval.vertices) add(vertex / form.scale);
        attempt(mixture / total);
    }
    return result;
}

}  // namespace nsma
