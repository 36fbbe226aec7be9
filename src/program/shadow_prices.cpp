#include "nsma/program/shadow_prices.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

#include "nsma/program/least_squares.hpp"
#include "nsma/program/linear_program.hpp"
#include "nsma/program/polish.hpp"
#include "nsma/program/relaxed_solver.hpp"

namespace nsma {
namespace {

// The two sides of a derivative that agree to this are one number.
constexpr double side_tolerance = 1e-8;
// Rates of the scaled unknowns are sought within this box; one that reaches it has no end.
constexpr double direction_box = 1e4;
// A level this close to the least energy, relative, is the least energy: a few roundings.
constexpr double end_tolerance = 1e-12;

struct Side {
    enum class Status { finite, infeasible, root, refused } status = Status::refused;
    double value = 0;  // slope, or coefficient of sqrt(t)
    std::string reason;
};

Side refused(std::string reason) { return {Side::Status::refused, 0, std::move(reason)}; }

Slope from_sides(const Side& right, const Side& left) {
    Slope slope;
    const auto note = [&](const char* where, const Side& side) {
        if (side.status == Side::Status::finite) return;
        if (!slope.reason.empty()) slope.reason += "; ";
        slope.reason += where;
        slope.reason += side.status == Side::Status::root ? "infinite slope, a square root of the step" : side.reason;
    };
    note("right: ", right);
    note("left: ", left);
    if (right.status == Side::Status::refused && left.status == Side::Status::refused) return slope;
    slope.kind = Slope::Kind::one_sided;
    if (right.status == Side::Status::finite) slope.right = right.value;
    if (right.status == Side::Status::root) slope.right_root = right.value;
    if (left.status == Side::Status::finite) slope.left = -left.value;
    if (left.status == Side::Status::root) slope.left_root = left.value;
    if (slope.right && slope.left &&
        std::abs(*slope.right - *slope.left) <=
            side_tolerance * (std::abs(*slope.right) + std::abs(*slope.left)) + 1e-12) {
        slope.kind = Slope::Kind::two_sided;
        slope.left = slope.right;
    } else if (slope.reason.empty()) {
        slope.reason = "the multipliers are not unique: the sides differ";
    }
    return slope;
}

Shift negated(const Shift& shift) {
    Shift result = shift;
    result.gap = -shift.gap;
    result.level = -shift.level;
    result.contact = -shift.contact;
    result.rows = -shift.rows;
    return result;
}

}  // namespace

// One optimum: its active set, its multipliers where there are any, and its critical cone.
struct OptimumSensitivity::Analysis {
    Analysis(const RelaxedSet& relaxed, Objective asked, std::optional<double> wanted,
             const Eigen::VectorXd& start, const Options& chosen, const Eigen::VectorXd& reference)
        : set(relaxed), objective(asked), options(chosen) {
        const bool extreme = objective == Objective::min_energy || objective == Objective::max_energy;
        if (extreme == wanted.has_value()) {
            throw std::invalid_argument(std::string("level: expected ") + (extreme ? "none" : "one") +
                                        " for objective " + std::string(name(objective)));
        }
        if (start.size() != set.dimension()) {
            throw std::invalid_argument("beta: expected size " + std::to_string(set.dimension()) +
                                        ", got " + std::to_string(start.size()));
        }
        level = wanted.value_or(set.energy(start));
        form = relaxed_program(set, objective, level, {}, reference);
        bool feasible = true;
        x = form.point(start);
        has_sphere = form.program.sphere_variables > 0;
        if (!settled()) {
            const Polished polished = polish(form.program, x);
            x = polished.x;
            feasible = polished.feasible;
        }
        beta = form.beta(x);
        value = form.program.objective(x) * form.objective_unit;
        gradient = form.program.objective_gradient(x);
        gradient_scale = 1.0 + gradient.norm();
        sphere = Eigen::VectorXd::Zero(x.size());
        if (has_sphere) sphere.head(form.orbit_variables) = 2.0 * x.head(form.orbit_variables);
        if (!feasible) {
            refusal = "the point is not admissible to rounding";
            return;
        }
        find_active();
        if (refusal.empty()) find_multipliers();
    }

    // Ends of the energy interval are points of their own: rounding of the level must not move
    // them along the sphere, by its square root.
    [[nodiscard]] bool settled() {
        if (!has_sphere) return false;
        const RelaxedInterval interval = relaxed_interval(set, {}, false);
        if (!interval.failed && !interval.empty && std::abs(level - interval.least) <= end_tolerance * level) {
            x = form.point(interval.least_point);
            return true;
        }
        if (form.program.violation(x) > options.active) return false;
        find_active();
        const bool vertex = refusal.empty() && flat.cols() == 0;
        refusal.clear();
        active.clear();
        return vertex;
    }

    void find_active() {
        const Eigen::VectorXd slack = form.program.inequality_values - form.program.inequalities * x;
        for (Eigen::Index i = 0; i < slack.size(); ++i) {
            if (slack[i] <= options.active) {
                active.push_back(i);
            } else if (slack[i] < options.inactive) {
                refusal = "a row is neither clearly active nor clearly inactive";
            }
        }
        const auto n = x.size();
        const auto equalities = form.program.equalities.rows();
        linear.resize(equalities + static_cast<Eigen::Index>(active.size()), n);
        linear.topRows(equalities) = Eigen::MatrixXd(form.program.equalities);
        for (std::size_t k = 0; k < active.size(); ++k) {
            linear.row(equalities + static_cast<Eigen::Index>(k)) =
                Eigen::RowVectorXd(form.program.inequalities.row(active[k]));
        }
        flat = Eigen::MatrixXd::Identity(n, n);
        if (linear.rows() > 0) {
            const Eigen::JacobiSVD<Eigen::MatrixXd> svd(linear, Eigen::ComputeFullV);
            Eigen::Index rank = 0;
            for (const double singular : svd.singularValues()) {
                if (singular > options.inactive) {
                    ++rank;
                } else if (singular > options.active) {
                    refusal = "the active rows are neither clearly dependent nor independent";
                }
            }
            independent = rank == linear.rows();
            flat = svd.matrixV().rightCols(n - rank);
        }
        if (!has_sphere || sphere.size() == 0) return;
        along = flat * (flat.transpose() * sphere);
        const double share = along.norm() / sphere.norm();
        transversal = share > options.inactive;
        if (!transversal && share > options.active) {
            refusal = "the level is neither clearly tangent to the active rows nor across them";
        }
    }

    // Multipliers of the linear rows by nonnegative least squares once the sphere's is known.
    void find_multipliers() {
        mu = 0;
        if (has_sphere && transversal) {
            mu = -along.dot(gradient) / along.dot(sphere);
        }
        const bool tangent = has_sphere && !transversal;
        const auto equalities = form.program.equalities.rows();
        const Eigen::VectorXd balance = gradient + mu * sphere;
        if (independent && !tangent) {
            const Eigen::VectorXd solved =
                linear.rows() > 0 ? Eigen::VectorXd(linear.transpose().colPivHouseholderQr().solve(-balance))
                                  : Eigen::VectorXd();
            nu = solved.head(equalities);
            y = solved.tail(solved.size() - equalities);
            unique = true;
        } else {
            // Any multipliers: equalities and, where tangent, the sphere from both sides.
            const Eigen::Index smooth = equalities + (tangent ? 1 : 0);
            Eigen::MatrixXd columns(x.size(), linear.rows() - equalities + 2 * smooth);
            const Eigen::MatrixXd normals = linear.bottomRows(linear.rows() - equalities).transpose();
            columns.leftCols(normals.cols()) = normals;
            for (Eigen::Index k = 0; k < smooth; ++k) {
                const Eigen::VectorXd row = k < equalities ? Eigen::VectorXd(linear.row(k).transpose()) : sphere;
                columns.col(normals.cols() + 2 * k) = row;
                columns.col(normals.cols() + 2 * k + 1) = -row;
            }
            const NonnegativeSolution solution = nonnegative_least_squares(columns, -balance);
            y = solution.y.head(normals.cols());
            nu.resize(equalities);
            for (Eigen::Index k = 0; k < smooth; ++k) {
                const double both = solution.y[normals.cols() + 2 * k] - solution.y[normals.cols() + 2 * k + 1];
                (k < equalities ? nu[k] : mu) = both;
            }
        }
        Eigen::VectorXd residual = gradient + mu * sphere;
        if (linear.rows() > 0) {
            Eigen::VectorXd all(linear.rows());
            all << nu, y;
            residual += linear.transpose() * all;
        }
        kkt = residual.norm() / gradient_scale;
        stationary = kkt <= options.active;
        for (const double multiplier : y) {
            if (multiplier < -options.active * gradient_scale) stationary = false;
        }
        if (!stationary && !tangent && objective != Objective::max_energy) {
            refusal = "the point is not stationary";
        }
        // The rows that hold the optimum, for second order.
        positive = stationary && smallest_multiplier() > options.inactive * gradient_scale;
        if (has_sphere && !transversal) return;
        const Eigen::MatrixXd tangents = tangent_basis();
        if (tangents.cols() == 0) {
            isolated = true;
            return;
        }
        const Eigen::MatrixXd curvature = tangents.transpose() * lagrangian() * tangents;
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(curvature, Eigen::EigenvaluesOnly);
        isolated = spectrum.eigenvalues()[0] > options.inactive;
    }

    // The greatest smallest multiplier of an active row, over all multipliers of the point.
    [[nodiscard]] double smallest_multiplier() const {
        if (y.size() == 0) return no_bound;
        if (unique) return y.minCoeff();
        const auto n = x.size();
        const auto equalities = nu.size();
        const auto count = y.size();
        LinearProgram program;  // unknowns: nu, y, their smallest
        program.rows = Eigen::MatrixXd::Zero(n + count, linear.rows() + 1);
        program.rows.topLeftCorner(n, linear.rows()) = linear.transpose();
        program.rows.block(n, equalities, count, count).setIdentity();
        program.rows.bottomRightCorner(count, 1).setConstant(-1.0);
        program.row_lower = Eigen::VectorXd::Zero(n + count);
        program.row_lower.head(n) = program.row_lower.head(n) - (gradient + mu * sphere);
        program.row_upper = program.row_lower;
        program.row_upper.tail(count).setConstant(no_bound);
        program.lower = Eigen::VectorXd::Constant(linear.rows() + 1, -no_bound);
        program.upper = Eigen::VectorXd::Constant(linear.rows() + 1, no_bound);
        program.upper[linear.rows()] = gradient_scale;
        Eigen::VectorXd cost = Eigen::VectorXd::Zero(linear.rows() + 1);
        cost[linear.rows()] = -1.0;
        const LinearSolution solution = LinearSolver(program).minimise(cost);
        return solution.status == LinearStatus::optimal ? -solution.value : 0.0;
    }

    [[nodiscard]] Eigen::MatrixXd lagrangian() const {
        Eigen::MatrixXd hessian(form.program.hessian);
        hessian.diagonal().head(form.orbit_variables).array() += 2.0 * mu * (has_sphere ? 1.0 : 0.0);
        return hessian;
    }

    // Orthonormal basis of the directions within the active rows and the sphere.
    [[nodiscard]] Eigen::MatrixXd tangent_basis() const {
        if (!has_sphere || flat.cols() == 0) return flat;
        const Eigen::VectorXd normal = (flat.transpose() * sphere).normalized();
        const Eigen::HouseholderQR<Eigen::MatrixXd> qr(normal);
        const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(flat.cols(), flat.cols());
        return flat * q.rightCols(flat.cols() - 1);
    }

    // Rates of the scaled right-hand sides: equality, active rows, sphere.
    struct Rates {
        Eigen::VectorXd equality, rows;
        double sphere = 0;
        double band = 0;
    };
    [[nodiscard]] Rates rates(const Shift& direction) const {
        Rates result;
        const double contact = form.contact_norm > 0 ? 1.0 / (form.contact_norm * form.scale) : 0.0;
        result.equality = Eigen::VectorXd::Constant(form.program.equalities.rows(),
                                                    (direction.gap + direction.contact) * contact);
        result.band = direction.band * contact;
        Eigen::VectorXd all = Eigen::VectorXd::Zero(form.program.inequalities.rows());
        for (Eigen::Index i = 0; i < set.rows.rows(); ++i) {
            double rate = direction.rows.size() > 0 ? direction.rows[i] : 0.0;
            if (set.condition[static_cast<std::size_t>(i)].condition == ConditionRow::Condition::cond1) {
                rate += direction.gap;
            }
            all[i] = rate / (form.row_norm[i] * form.scale);
        }
        result.rows.resize(static_cast<Eigen::Index>(active.size()));
        for (std::size_t k = 0; k < active.size(); ++k) result.rows[static_cast<Eigen::Index>(k)] = all[active[k]];
        result.sphere = direction.level / level;
        return result;
    }

    // min gradient . d over the linearised constraints, for one side.
    [[nodiscard]] Side linear_side(const Rates& rate, const Eigen::VectorXd& cost, bool with_sphere) const {
        const auto n = x.size();
        const auto equalities = rate.equality.size();
        const Eigen::Index count = linear.rows() + (with_sphere ? 1 : 0);
        LinearProgram program;
        program.rows.resize(count, n);
        program.rows.topRows(linear.rows()) = linear;
        program.row_lower = Eigen::VectorXd::Constant(count, -no_bound);
        program.row_upper.resize(count);
        program.row_upper.head(equalities) = rate.equality.array() + rate.band;
        program.row_lower.head(equalities) = rate.equality.array() - rate.band;
        program.row_upper.segment(equalities, rate.rows.size()) = rate.rows;
        if (with_sphere) {
            program.rows.row(count - 1) = sphere.transpose();
            program.row_lower[count - 1] = program.row_upper[count - 1] = rate.sphere;
        }
        // CLP calls a point optimal that is not when every unknown is free: a wide box, and its
        // multipliers are checked.
        program.lower = Eigen::VectorXd::Constant(n, -direction_box);
        program.upper = Eigen::VectorXd::Constant(n, direction_box);
        const LinearSolution solution = LinearSolver(program).minimise(cost);
        if (solution.status == LinearStatus::infeasible) {
            return {Side::Status::infeasible, 0, "no orbit on this side"};
        }
        if (solution.status != LinearStatus::optimal) return refused("the linear program of the side has no end");
        const double unbalanced = (cost - program.rows.transpose() * solution.row_dual).norm();
        if (unbalanced > 1e-7 * (1.0 + cost.norm()) || solution.x.cwiseAbs().maxCoeff() > 0.5 * direction_box) {
            return refused("the linear program of the side has no end");
        }
        // Onto the rows tight at the solution, so that only rounding is left.
        Eigen::VectorXd d = solution.x;
        std::vector<Eigen::Index> tight;
        Eigen::VectorXd target(count);
        const Eigen::VectorXd values = program.rows * d;
        for (Eigen::Index i = 0; i < count; ++i) {
            const double tolerance = 1e-7 * (1.0 + d.norm());
            if (std::abs(values[i] - program.row_upper[i]) <= tolerance) {
                target[static_cast<Eigen::Index>(tight.size())] = program.row_upper[i];
                tight.push_back(i);
            } else if (std::abs(values[i] - program.row_lower[i]) <= tolerance) {
                target[static_cast<Eigen::Index>(tight.size())] = program.row_lower[i];
                tight.push_back(i);
            }
        }
        if (!tight.empty()) {
            const Eigen::MatrixXd system = program.rows(tight, Eigen::all);
            Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
            decomposition.setThreshold(1e-9);
            decomposition.compute(system);
            d += decomposition.solve(target.head(system.rows()) - system * d);
        }
        return {Side::Status::finite, cost.dot(d), {}};
    }

    // Extent of a form over the tangent cone (and the sphere's tangent plane) within a unit box.
    [[nodiscard]] double cone_minimum(const Eigen::VectorXd& cost, bool with_sphere) const {
        const auto n = x.size();
        const auto equalities = form.program.equalities.rows();
        const Eigen::Index count = linear.rows() + (with_sphere ? 1 : 0);
        LinearProgram program;
        program.rows.resize(count, n);
        program.rows.topRows(linear.rows()) = linear;
        program.row_upper = Eigen::VectorXd::Zero(count);
        program.row_lower = Eigen::VectorXd::Constant(count, -no_bound);
        program.row_lower.head(equalities).setZero();
        if (with_sphere) {
            program.rows.row(count - 1) = sphere.transpose();
            program.row_lower[count - 1] = 0;
        }
        program.lower = Eigen::VectorXd::Constant(n, -1.0);
        program.upper = Eigen::VectorXd::Constant(n, 1.0);
        const LinearSolution solution = LinearSolver(program).minimise(cost);
        return solution.status == LinearStatus::optimal ? solution.value : -no_bound;
    }

    // Projection of -gradient on the tangent cone within the sphere's tangent plane.
    [[nodiscard]] Eigen::VectorXd critical_direction() const {
        const auto equalities = form.program.equalities.rows();
        const Eigen::MatrixXd normals = linear.bottomRows(linear.rows() - equalities);
        Eigen::MatrixXd smooth(equalities + 1, x.size());
        smooth.topRows(equalities) = linear.topRows(equalities);
        smooth.row(equalities) = sphere.transpose();
        const Eigen::JacobiSVD<Eigen::MatrixXd> svd(smooth, Eigen::ComputeFullV);
        Eigen::Index rank = 0;
        for (const double singular : svd.singularValues()) rank += singular > options.inactive ? 1 : 0;
        const Eigen::MatrixXd basis = svd.matrixV().rightCols(x.size() - rank);
        const NonnegativeSolution solution =
            nonnegative_least_squares((normals * basis).transpose(), -(basis.transpose() * gradient));
        return basis * solution.residual;
    }

    [[nodiscard]] bool critical_cone_is_zero() const {
        for (Eigen::Index j = 0; j < x.size(); ++j) {
            for (const double side : {1.0, -1.0}) {
                Eigen::VectorXd cost = Eigen::VectorXd::Zero(x.size());
                cost[j] = side;
                if (cone_minimum(cost, true) < -options.inactive) return false;
            }
        }
        return true;
    }

    // What kind of degeneracy the level is, decided once.
    enum class Place { across, vertex, end_point, root, second_order };
    [[nodiscard]] Place place() const {
        if (!has_sphere || transversal) return Place::across;
        const double down = cone_minimum(sphere, false);
        const double up = -cone_minimum(-sphere, false);
        if (down < -options.inactive && up > options.inactive) return Place::vertex;
        if (critical_direction().norm() > options.inactive * gradient_scale) return Place::root;
        return critical_cone_is_zero() ? Place::end_point : Place::second_order;
    }

    [[nodiscard]] Side side(const Shift& direction) const {
        if (!refusal.empty()) return refused(refusal);
        const Rates rate = rates(direction);
        if (objective == Objective::max_energy) {
            Side result = linear_side(rate, gradient, false);
            result.value *= form.objective_unit;
            return result;
        }
        if (unique && direction.band == 0) {
            if (!isolated && has_sphere) return refused("the optimum is not isolated");
            double value_rate = -y.dot(rate.rows) - mu * rate.sphere;
            if (nu.size() > 0) value_rate -= nu.dot(rate.equality);
            return {Side::Status::finite, value_rate * form.objective_unit, {}};
        }
        const Place where = place_.value_or(Place::across);
        if (where == Place::root) return root_side(direction);
        if (where == Place::second_order) return refused("an end of the energy interval with a flat critical cone");
        if (!isolated && where == Place::across && has_sphere) return refused("the optimum is not isolated");
        Side result = linear_side(rate, gradient, has_sphere);
        result.value *= form.objective_unit;
        return result;
    }

    // Least energy: within reach comes a ball of radius sqrt(excess) about the one point.
    [[nodiscard]] Side root_side(const Shift& direction) const {
        const Analysis least(set, Objective::min_energy, std::nullopt, beta, options, {});
        Shift linear_part = direction;
        linear_part.level = 0;
        const Side energy = least.side(linear_part);
        if (energy.status != Side::Status::finite) return energy;
        const double excess = (direction.level - energy.value) / level;
        if (excess < -options.inactive) return {Side::Status::infeasible, 0, "no orbit on this side"};
        if (excess <= options.inactive) return refused("the least energy moves with the level");
        return {Side::Status::root,
                -critical_direction().norm() * std::sqrt(excess) * form.objective_unit, {}};
    }

    void decide_place() {
        if (refusal.empty() && has_sphere && objective != Objective::max_energy) place_ = place();
    }

    const RelaxedSet& set;
    Objective objective;
    Options options;
    double level = 0;
    RelaxedProgram form;
    Eigen::VectorXd x, beta, gradient, sphere, along, nu, y;
    Eigen::MatrixXd linear, flat;
    std::vector<Eigen::Index> active;
    double value = 0, kkt = 0, gradient_scale = 1, mu = 0;
    bool has_sphere = false, transversal = false, independent = true, unique = false;
    bool stationary = false, positive = false, isolated = false;
    std::optional<Place> place_;
    std::string refusal;
};

OptimumSensitivity::OptimumSensitivity(const RelaxedSet& set, Objective objective,
                                       std::optional<double> level, const Eigen::VectorXd& beta,
                                       const Options& options, const Eigen::VectorXd& reference,
                                       const std::vector<Eigen::VectorXd>& ties) {
    const auto add = [&](const Eigen::VectorXd& point) {
        branches_.push_back(std::make_unique<Analysis>(set, objective, level, point, options, reference));
        branches_.back()->decide_place();
    };
    const auto known = [&](const Eigen::VectorXd& point) {
        return std::any_of(branches_.begin(), branches_.end(), [&](const auto& branch) {
            return (branch->beta - point).norm() <= options.inactive * point.norm();
        });
    };
    add(beta);
    std::vector<Eigen::VectorXd> others = ties;
    if (objective != Objective::nearest) {
        others.push_back(time_reversed(set.kernel, beta));
        for (const auto& tie : ties) others.push_back(time_reversed(set.kernel, tie));
    }
    for (const auto& other : others) {
        if (!known(other)) add(other);
    }
}

OptimumSensitivity::~OptimumSensitivity() = default;
OptimumSensitivity::OptimumSensitivity(OptimumSensitivity&&) noexcept = default;
OptimumSensitivity& OptimumSensitivity::operator=(OptimumSensitivity&&) noexcept = default;

const std::string& OptimumSensitivity::refusal() const { return branches_.front()->refusal; }
double OptimumSensitivity::value() const { return branches_.front()->value; }
const Eigen::VectorXd& OptimumSensitivity::beta() const { return branches_.front()->beta; }
bool OptimumSensitivity::tied() const { return branches_.size() > 1; }
double OptimumSensitivity::kkt_residual() const { return branches_.front()->kkt; }

bool OptimumSensitivity::nondegenerate() const {
    const Analysis& one = *branches_.front();
    return one.refusal.empty() && one.unique && one.positive && one.isolated;
}

std::vector<int> OptimumSensitivity::active_rows() const {
    const Analysis& one = *branches_.front();
    std::vector<int> rows;
    for (const auto i : one.active) {
        if (i < one.set.rows.rows()) rows.push_back(static_cast<int>(i));
    }
    return rows;
}

std::optional<double> OptimumSensitivity::euler_defect() const {
    const Analysis& one = *branches_.front();
    if (!one.refusal.empty() || !one.stationary || one.objective == Objective::nearest) return std::nullopt;
    const double degree = one.objective == Objective::least_force ? 1.0 : 2.0;
    Shift ray;
    ray.gap = one.set.gap_sign;
    if (one.has_sphere) ray.level = 2.0 * one.level;
    const auto rate = one.rates(ray);
    double slope = -one.y.dot(rate.rows) - one.mu * rate.sphere;
    if (one.nu.size() > 0) slope -= one.nu.dot(rate.equality);
    return std::abs(slope * one.form.objective_unit - degree * one.value) / std::abs(degree * one.value);
}

Slope OptimumSensitivity::slope(const Shift& direction) const {
    // The best branch on each side.
    const bool maximum = branches_.front()->objective == Objective::max_energy;
    const auto best = [&](const Shift& way) {
        Side result;
        bool first = true;
        for (const auto& branch : branches_) {
            const Side side = branch->side(way);
            if (side.status == Side::Status::refused) return side;
            const auto order = [](const Side& s) {
                return s.status == Side::Status::root ? 0 : s.status == Side::Status::finite ? 1 : 2;
            };
            const bool better = order(side) != order(result) ? order(side) < order(result)
                                : maximum                    ? side.value > result.value
                                                             : side.value < result.value;
            if (first || better) result = side;
            first = false;
        }
        return result;
    };
    const Side left = direction.band > 0 ? Side{Side::Status::infeasible, 0, "a band has no negative width"}
                                         : best(negated(direction));
    return from_sides(best(direction), left);
}

OrbitSlope OptimumSensitivity::orbit_slope(const Shift& direction) const {
    const Analysis& one = *branches_.front();
    OrbitSlope result;
    const auto refuse = [&](std::string reason) {
        result.reason = std::move(reason);
        return result;
    };
    if (!one.refusal.empty()) return refuse(one.refusal);
    if (direction.band != 0) return refuse("a band opens to one side only");
    if (one.has_sphere && !one.transversal) return refuse("the level is tangent to the active rows");
    if (!one.positive) return refuse("strict complementarity fails: an active row has no force");
    if (!one.isolated) return refuse("the optimum is not isolated");
    const auto rate = one.rates(direction);
    Eigen::VectorXd target(one.linear.rows());
    target << rate.equality, rate.rows;
    Eigen::VectorXd step = Eigen::VectorXd::Zero(one.x.size());
    if (target.size() > 0) {
        Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
        decomposition.setThreshold(one.options.inactive);
        decomposition.compute(one.linear);
        step = decomposition.solve(target);
        step += decomposition.solve(target - one.linear * step);
        if ((one.linear * step - target).norm() > one.options.active * (1.0 + target.norm())) {
            return refuse("the active rows part: they are dependent and relaxed apart");
        }
    }
    if (one.has_sphere) {
        step += one.along * ((rate.sphere - one.sphere.dot(step)) / one.along.dot(one.sphere));
    }
    const Eigen::MatrixXd tangents = one.tangent_basis();
    if (tangents.cols() > 0) {
        const Eigen::MatrixXd hessian = one.lagrangian();
        step -= tangents * (tangents.transpose() * hessian * tangents)
                               .ldlt()
                               .solve(tangents.transpose() * (hessian * step));
    }
    result.beta = one.form.scale * step.head(one.form.orbit_variables);
    return result;
}

}  // namespace nsma
