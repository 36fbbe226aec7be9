#include "nsma/program/conic_bound.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>

namespace nsma {
namespace {

constexpr double over_relaxation = 1.6;
constexpr int check_every = 20;
constexpr int stall_every = 200;
constexpr double stall_tolerance = 0.02;
// Within this of the target the splitting method is slow rather than stuck: it is let run.
constexpr double close_gap = 1e-3;
constexpr std::size_t product_trials = 16;  // multipliers nu tried, each one eigenvalue

// The program in homogeneous form over the unit sphere: minimise x' C x.
struct Homogeneous {
    Eigen::MatrixXd cost;
    Eigen::VectorXd contact;     // a; size 0 without COND2
    double contact_square = 0;   // e^2
    Eigen::MatrixXd generators;  // V: V x >= 0
    bool valid = false;
};

Homogeneous homogenise(const Program& program) {
    Homogeneous form;
    const auto n = program.variables();
    if (program.sphere_variables != n || program.equalities.rows() > 1) return form;
    if (program.inequality_values.size() > 0 && !program.inequality_values.isZero()) return form;
    form.cost = 0.5 * Eigen::MatrixXd(program.hessian);
    const bool linear = !program.gradient.isZero();
    if (program.equalities.rows() == 1) {
        form.contact = Eigen::MatrixXd(program.equalities).row(0).transpose();
        const double e = program.equality_values[0];
        form.contact_square = e * e;
        if (linear) {
            if (e == 0) return form;
            form.cost += (program.gradient * form.contact.transpose() +
                          form.contact * program.gradient.transpose()) / (2.0 * e);
        }
    } else if (linear) {
        return form;
    }
    // The constant rides on the sphere.
    form.cost.diagonal().array() += program.constant;

    std::vector<Eigen::Index> bounded;
    for (Eigen::Index j = 0; j < n; ++j) {
        if (program.upper[j] < no_bound) return form;
        if (program.lower[j] == 0) bounded.push_back(j);
    }
    const auto count = program.inequalities.rows();
    form.generators = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(bounded.size()) + count, n);
    for (std::size_t k = 0; k < bounded.size(); ++k) {
        form.generators(static_cast<Eigen::Index>(k), bounded[k]) = 1.0;
    }
    form.generators.bottomRows(count) = -Eigen::MatrixXd(program.inequalities);
    form.valid = true;
    return form;
}

// In the eigenvectors of V'V, where the linear system of each step is a division by elements; traces and semidefinite
// matrices look the same there.
class Splitting {
public:
    explicit Splitting(const Homogeneous& form) : contact_square_(form.contact_square), n_(form.cost.rows()), spectrum_(n_) {
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> gram(form.generators.transpose() * form.generators);
        basis_ = gram.eigenvectors();
        cost_ = basis_.transpose() * form.cost * basis_;
        generators_ = form.generators * basis_;
        const Eigen::VectorXd values = gram.eigenvalues().cwiseMax(0.0);
        weights_ = (1.0 + (values * values.transpose()).array()).inverse().matrix();
        if (form.contact.size() > 0) contact_ = basis_.transpose() * form.contact;
        contact_matrix_ = form.contact.size() > 0 ? Eigen::MatrixXd(contact_ * contact_.transpose())
                                                  : Eigen::MatrixXd::Zero(n_, n_);
        solved_contact_ = contact_matrix_.cwiseProduct(weights_);
        solved_cost_ = cost_.cwiseProduct(weights_);
        const auto p = form.generators.rows();
        psd_ = Eigen::MatrixXd::Identity(n_, n_) / static_cast<double>(n_);
        nonnegative_ = (generators_ * psd_ * generators_.transpose()).cwiseMax(0.0);
        psd_dual_ = Eigen::MatrixXd::Zero(n_, n_);
        nonnegative_dual_ = Eigen::MatrixXd::Zero(p, p);
        rho_ = std::max(form.cost.norm(), 1e-12);
    }

    void iterate() {
        difference_ = nonnegative_ - nonnegative_dual_;
        half_.noalias() = difference_ * generators_;
        z_ = psd_ - psd_dual_;
        z_.noalias() += generators_.transpose() * half_;
        z_ = z_.cwiseProduct(weights_) - solved_cost_ / rho_;
        fit_equalities();
        z_ -= (nu_ / rho_) * solved_contact_;
        z_.diagonal() -= (mu_ / rho_) * weights_.diagonal();
        half_.noalias() = generators_ * z_;
        lifted_.noalias() = half_ * generators_.transpose();

        shifted_ = over_relaxation * z_ + (1 - over_relaxation) * psd_ + psd_dual_;
        last_psd_.swap(psd_);
        project();
        psd_dual_ = shifted_ - psd_;
        double primal = (z_ - psd_).squaredNorm();
        double dual = (psd_ - last_psd_).squaredNorm();
        for (Eigen::Index k = 0; k < lifted_.size(); ++k) {
            double& kept = nonnegative_.data()[k];
            double& multiplier = nonnegative_dual_.data()[k];
            const double last = kept;
            const double lifted = lifted_.data()[k];
            const double sum = over_relaxation * lifted + (1 - over_relaxation) * last + multiplier;
            kept = std::max(sum, 0.0);
            multiplier = sum - kept;
            primal += (lifted - kept) * (lifted - kept);
            dual += (kept - last) * (kept - last);
        }
        primal_ = std::sqrt(primal);
        dual_ = std::sqrt(dual);
    }

    // Keeps primal and dual residuals of one size; scaled multipliers follow.
    void balance() {
        double factor = 1.0;
        if (primal_ > 5.0 * dual_) factor = 1.7;
        if (dual_ > 5.0 * primal_) factor = 1.0 / 1.7;
        rho_ *= factor;
        psd_dual_ /= factor;
        nonnegative_dual_ /= factor;
    }

    // Mean of the relaxed solution, of which Z is the moment matrix; needs COND2.
    [[nodiscard]] Eigen::VectorXd mean() const {
        return basis_ * (psd_ * contact_) / std::sqrt(contact_square_);
    }

    // Where to cut: with COND2 the relaxed solution is a moment matrix whose mean is Z a/e; the
    // unknown of largest variance is cut at its mean. Without it, the largest unsigned unknown is
    // cut at zero. The normal h of the cut h . x = 0; size 0 when nothing is left to cut.
    [[nodiscard]] Eigen::VectorXd cut(const std::vector<Eigen::Index>& unsigned_unknowns) const {
        Eigen::VectorXd normal = Eigen::VectorXd::Zero(n_);
        const Eigen::MatrixXd moments = basis_ * psd_ * basis_.transpose();
        if (contact_square_ > 0) {
            const Eigen::VectorXd mean = basis_ * (psd_ * contact_) / contact_square_;  // over a . x
            Eigen::Index widest = 0;
            (moments.diagonal() - mean.cwiseAbs2() * contact_square_).maxCoeff(&widest);
            normal[widest] = 1.0;
            normal -= mean[widest] * (basis_ * contact_);
            return normal.normalized();
        }
        if (unsigned_unknowns.empty()) return {};
        normal[*std::max_element(unsigned_unknowns.begin(), unsigned_unknowns.end(), [&](auto i, auto j) {
            return moments(i, i) < moments(j, j);
        })] = 1.0;
        return normal;
    }

    // Objective bound from the multipliers at hand: valid for any of them.
    [[nodiscard]] double bound() const {
        const Eigen::MatrixXd products = (-rho_) * nonnegative_dual_.cwiseMin(0.0);
        const Eigen::MatrixXd fixed = cost_ - generators_.transpose() * products * generators_;
        const auto value = [&](double nu) {
            const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(fixed + nu * contact_matrix_,
                                                                          Eigen::EigenvaluesOnly);
            const double scale = spectrum.eigenvalues().cwiseAbs().maxCoeff();
            const double rounding = 1e-13 * scale;  // of the change of basis and of the eigenvalues: some n eps, n <= 48
            return spectrum.eigenvalues()[0] - rounding - nu * contact_square_;
        };
        if (contact_.size() == 0) return value(0);
        // Concave in nu: a few steps of golden section about the multiplier found.
        const double width = 0.05 * std::abs(nu_) + 1e-3 * rho_;
        double lo = nu_ - width;
        double hi = nu_ + width;
        constexpr double golden = 0.6180339887498949;
        double a = hi - golden * (hi - lo);
        double b = lo + golden * (hi - lo);
        double at_a = value(a);
        double at_b = value(b);
        double best = std::max({value(nu_), at_a, at_b});
        for (int i = 0; i < 12; ++i) {
            if (at_a > at_b) {
                hi = b; b = a; at_b = at_a;
                a = hi - golden * (hi - lo);
                at_a = value(a);
                best = std::max(best, at_a);
            } else {
                lo = a; a = b; at_a = at_b;
                b = lo + golden * (hi - lo);
                at_b = value(b);
                best = std::max(best, at_b);
            }
        }
        return best;
    }

private:
    // The nearest semidefinite matrix, by whichever sign has fewer eigenvalues.
    void project() {
        spectrum_.compute(shifted_);
        const auto& values = spectrum_.eigenvalues();
        const Eigen::Index below = std::count_if(values.begin(), values.end(), [](double value) { return value < 0; });
        if (2 * below < n_) {
            scaled_ = spectrum_.eigenvectors().leftCols(below) * (-values.head(below)).cwiseSqrt().asDiagonal();
            psd_ = shifted_;
        } else {
            scaled_ = spectrum_.eigenvectors().rightCols(n_ - below) * values.tail(n_ - below).cwiseSqrt().asDiagonal();
            psd_.setZero(n_, n_);
        }
        psd_.noalias() += scaled_ * scaled_.transpose();
    }

    // Multipliers mu, nu with which trace Z = 1 and a' Z a = e^2.
    void fit_equalities() {
        const double trace = rho_ * (z_.trace() - 1.0);
        if (contact_.size() == 0) {
            mu_ = trace / weights_.trace();
            return;
        }
        const double contact = rho_ * (contact_.dot(z_ * contact_) - contact_square_);
        Eigen::Matrix2d system;
        system << weights_.trace(), solved_contact_.trace(), solved_contact_.trace(),
            solved_contact_.cwiseProduct(contact_matrix_).sum();
        const Eigen::Vector2d solution = system.inverse() * Eigen::Vector2d(trace, contact);
        mu_ = solution[0];
        nu_ = solution[1];
    }

    double contact_square_;
    Eigen::Index n_;
    Eigen::MatrixXd basis_, cost_, generators_, weights_, contact_matrix_;
    Eigen::VectorXd contact_;
    Eigen::MatrixXd solved_contact_, solved_cost_;
    Eigen::MatrixXd psd_, psd_dual_, nonnegative_, nonnegative_dual_;
    // Of one step, kept for their memory.
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum_;
    Eigen::MatrixXd difference_, half_, z_, lifted_, shifted_, last_psd_, scaled_;
    double rho_ = 1;
    double mu_ = 0;
    double nu_ = 0;
    double primal_ = 0;
    double dual_ = 0;
};

}  // namespace

double product_bound(const Program& program) {
    const Homogeneous form = homogenise(program);
    if (!form.valid || form.contact.size() == 0) return -no_bound;
    const auto n = program.variables();
    // What is left after the products are off bends where one of them changes sign.
    std::vector<double> bends;
    for (Eigen::Index i = 0; i < n; ++i) {
        for (Eigen::Index j = 0; j < i; ++j) {
            const double product = form.contact[i] * form.contact[j];
            if (product != 0) bends.push_back(-form.cost(i, j) / product);
        }
    }
    std::sort(bends.begin(), bends.end());
    const double least_step = bends.empty() ? 0.0 : 1e-9 * (bends.back() - bends.front());
    bends.erase(std::unique(bends.begin(), bends.end(), [&](double a, double b) { return b - a <= least_step; }),
                bends.end());
    double best = -no_bound;
    const std::size_t trials = std::min(bends.size(), product_trials);
    for (std::size_t k = 0; k < trials; ++k) {
        const double nu = bends[trials == 1 ? 0 : k * (bends.size() - 1) / (trials - 1)];
        Eigen::MatrixXd rest = form.cost + nu * form.contact * form.contact.transpose();
        for (Eigen::Index i = 0; i < n; ++i) {
            for (Eigen::Index j = 0; j < n; ++j) {
                if (i != j && program.lower[i] == 0 && program.lower[j] == 0) rest(i, j) = std::min(rest(i, j), 0.0);
            }
        }
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(rest, Eigen::EigenvaluesOnly);
        const double rounding = 1e-14 * spectrum.eigenvalues().cwiseAbs().maxCoeff();
        best = std::max(best, spectrum.eigenvalues()[0] - rounding - nu * form.contact_square);
    }
    return best;
}

ConicBound conic_bound(const Program& program, double target, const ConicBoundOptions& options) {
    ConicBound result;
    const Homogeneous root_form = homogenise(program);
    if (!root_form.valid || program.variables() < 2) return result;
    const auto wanted = [&] { return target - options.target_tolerance * std::abs(target); };

    struct Node {
        double bound;
        int order;
        Homogeneous form;
        std::vector<Eigen::Index> unsigned_unknowns;
        Eigen::VectorXd cut;
    };
    const auto solve = [&](Node& node) {
        Splitting splitting(node.form);
        double last = -no_bound;
        for (int i = 0; i < options.max_iterations; i += check_every) {
            for (int k = 0; k < check_every; ++k) splitting.iterate();
            result.iterations += check_every;
            node.bound = std::max(node.bound, splitting.bound());
            if (node.bound >= wanted()) break;
            if (i > 0 && i % stall_every == 0) {
                // A relaxation that has settled short of the target needs a split, not steps.
                const bool close = target - node.bound <= close_gap * std::abs(target);
                if (!close && node.bound - last <= stall_tolerance * (target - node.bound)) break;
                last = node.bound;
            }
            splitting.balance();
        }
        ++result.nodes;
        if (options.improve && node.form.contact_square > 0) {
            const double sign = program.equality_values[0] > 0 ? 1.0 : -1.0;
            target = std::min(target, options.improve(sign * splitting.mean()));
        }
        node.cut = splitting.cut(node.unsigned_unknowns);
    };
    const auto later = [](const Node& a, const Node& b) {
        return a.bound != b.bound ? a.bound > b.bound : a.order > b.order;
    };
    std::vector<Node> open;
    open.push_back({-no_bound, 0, root_form, {}, {}});
    for (Eigen::Index j = 0; j < program.variables(); ++j) {
        if (program.lower[j] == -no_bound) open.front().unsigned_unknowns.push_back(j);
    }
    solve(open.front());
    double closed = no_bound;  // least bound of the leaves that cannot be split
    while (!open.empty() && open.front().bound < wanted() && result.nodes + 2 <= options.node_limit) {
        std::pop_heap(open.begin(), open.end(), later);
        const Node node = std::move(open.back());
        open.pop_back();
        if (node.cut.size() == 0) {
            closed = std::min(closed, node.bound);
            break;  // the worst bound cannot be improved any more
        }
        for (const double side : {1.0, -1.0}) {
            Node child{node.bound, result.nodes, node.form, node.unsigned_unknowns, {}};
            const auto rows = node.form.generators.rows();
            child.form.generators.conservativeResize(rows + 1, Eigen::NoChange);
            child.form.generators.row(rows) = side * node.cut.transpose();
            std::erase_if(child.unsigned_unknowns, [&](auto j) { return node.cut[j] == 1.0; });
            solve(child);
            open.push_back(std::move(child));
            std::push_heap(open.begin(), open.end(), later);
        }
    }
    result.value = open.empty() ? closed : std::min(closed, open.front().bound);
    return result;
}

}  // namespace nsma
