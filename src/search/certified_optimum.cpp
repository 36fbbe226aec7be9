#include "nsma/search/certified_optimum.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "simplex_optimum.hpp"

namespace nsma {
namespace {

constexpr int orbit_bits = 34;       // of an orbit in units of its sum; its energy errs by about 2^-33
constexpr int most_bits = 39;        // that a checker reads
constexpr int multiplier_bits = 44;  // of a multiplier: the bound errs by its square
constexpr int value_bits = 60;

Integer floor_of(const Rational& value) {
    Integer whole = numerator(value) / denominator(value);
    if (value < 0 && whole * denominator(value) != numerator(value)) --whole;
    return whole;
}

/// The greatest multiple of 2^-bits that is not above.
Rational rounded_down(const Rational& value, int bits) {
    const Integer scale = Integer(1) << bits;
    return Rational(floor_of(value * scale)) / scale;
}

// A value with so many bits behind its first one.
Rational relative_down(const Rational& value, int bits) {
    if (value == 0) return value;
    const int exponent = std::ilogb(std::abs(to_double(value)));
    return rounded_down(value, std::max(bits - exponent, 0));
}

/// In floating point what check() does exactly: whether a multiplier is at most that of the best orbit on k columns in
/// a row, whose |y|^2 is `ratio` times the square of its sum. `cone`: whether it is below every eigenvalue.
class Window {
public:
    Window(int k, double closure, double ratio, bool cone) : k_(k), closure_(closure), ratio_(ratio), cone_(cone) {}

    [[nodiscard]] bool low_enough(double mu) const {
        const Half alike = solve(mu, true);
        const Half opposite = solve(mu, false);
        if (opposite.negative > 0) return false;
        if (cone_) return alike.negative == 0;
        return alike.negative <= 1 && (alike.sum < 0) == (alike.negative == 1) &&
               alike.square <= ratio_ * alike.sum * alike.sum;
    }

    /// The greatest that is low enough.
    [[nodiscard]] std::optional<double> multiplier() const {
        double lo = -1;
        while (!low_enough(lo)) {
            lo *= 2;
            if (lo < -1e9) return std::nullopt;
        }
        double hi = 2;
        for (int i = 0; i < 200 && hi - lo > 1e-16 * std::abs(lo); ++i) {
            const double middle = 0.5 * (lo + hi);
            (low_enough(middle) ? lo : hi) = middle;
        }
        return lo;
    }

private:
    struct Half {
        int negative = 0;
        double sum = 0, square = 0;
    };

    [[nodiscard]] Half solve(double mu, bool alike) const {
        const double side = alike ? -1 : 1;
        const bool centre = alike && k_ % 2 == 1;
        std::vector<double> diagonal(static_cast<std::size_t>(k_ / 2), 1 - mu);
        if (centre) diagonal.push_back((1 - mu) / 2);
        Half result;
        const std::size_t n = diagonal.size();
        if (n == 0) return result;
        diagonal.front() += (k_ > 1 ? side : -1) * closure_ / 2;
        if (k_ % 2 == 0) diagonal.back() += side / 2;
        std::vector<double> right(n, 1.0);
        if (centre) right.back() = 0.5;
        for (std::size_t j = 0; j < n; ++j) {
            if (j > 0) {
                diagonal[j] -= 0.25 / diagonal[j - 1];
                right[j] += 0.5 * right[j - 1] / diagonal[j - 1];
            }
            result.negative += diagonal[j] < 0 ? 1 : 0;
        }
        for (std::size_t j = n; j-- > 0;) {
            if (j + 1 < n) right[j] += 0.5 * right[j + 1];
            right[j] /= diagonal[j];
            const int times = centre && j + 1 == n ? 1 : 2;
            result.sum += times * right[j];
            result.square += times * right[j] * right[j];
        }
        return result;
    }

    int k_;
    double closure_, ratio_;
    bool cone_;
};

class Certifier {
public:
    Certifier(const PatternProblem& problem, Objective objective, const Rational& energy)
        : problem_(problem), reduction_(problem.set.reduction), certificate_(problem.proof.certificate) {
        optimum_.objective = objective == Objective::least_shock ? Optimum::Of::least_shock : Optimum::Of::least_force;
        optimum_.energy = energy;
        gamma_ = simplex_optimum(problem.kernel, problem.set, objective, to_double(energy), {});
        round_orbit();
    }

    OptimumProof run() {
        const auto columns = static_cast<int>(gamma_.size());
        if (optimum_.objective == Optimum::Of::least_force) {
            const double peak = gamma_.maxCoeff() * 2 * problem_.kernel.pattern.cells;
            for (const double slack : {1e-14, 1e-12, 1e-10, 1e-8}) {
                optimum_.bound = relative_down(exact(peak * (1 - slack)), value_bits);
                if (proves()) return found();
            }
        } else {
            const auto covered = static_cast<int>((gamma_.array() > 1e-9 * gamma_.maxCoeff()).count());
            for (const int k : {covered, covered + 1, covered - 1}) {
                if (k >= 1 && k <= columns && try_window(k)) return found();
            }
        }
        return {std::nullopt, 0, reason_};
    }

private:
    // A point of the set near gamma: whole multiples of a small unit, of a gap those of its share of COND2's sum.
    void round_orbit() {
        const bool closed = reduction_.gap_sign == 0;
        const double whole = closed ? 1.0 : gamma_.sum();
        const int bits = closed ? most_bits - std::max(std::ilogb(gamma_.maxCoeff()) + 1, 0) : orbit_bits;
        if (bits < 0) return;  // beyond what a checker reads
        const Integer scale = Integer(1) << bits;
        std::vector<Integer> parts;
        Integer left = scale;
        for (const double value : gamma_) {
            parts.emplace_back(std::llround(std::ldexp(value / whole, bits)));
            left -= parts.back();
        }
        if (!closed) *std::max_element(parts.begin(), parts.end()) += left;
        Rational unit = reduction_.flip;
        if (!closed) unit *= Rational(reduction_.gap_sign) / reduction_.contact_row[0];
        unit /= scale;
        for (std::size_t j = 0; j < parts.size(); ++j) {
            if (parts[j] == 0) continue;
            Rational value = unit;
            value *= parts[j];
            optimum_.orbit.emplace_back(static_cast<int>(j), value);
        }
    }

    bool try_window(int k) {
        const auto columns = static_cast<int>(gamma_.size());
        const double closure = k == columns ? shock_closure(problem_.kernel, reduction_) : 0.0;
        const double sum = gamma_.sum();
        const auto mu = Window(k, closure, gamma_.squaredNorm() / (sum * sum), reduction_.gap_sign == 0).multiplier();
        if (!mu) {
            reason_ = "optimum: no multiplier for a window of " + std::to_string(k) + " columns";
            return false;
        }
        optimum_.window = k;
        for (const double slack : {1e-13, 1e-11, 1e-9, 1e-7}) {
            optimum_.multiplier = rounded_down(exact(*mu - slack * std::max(1.0, std::abs(*mu))), multiplier_bits);
            if (proves()) return true;
        }
        return false;
    }

    // Whether what there is proves something; then the claims follow, rounded to their own disadvantage.
    bool proves() {
        certificate_.optimum = optimum_;
        const OptimumFacts facts = optimum_facts(certificate_);
        reason_ = facts.reason;
        if (!facts.reason.empty()) return false;
        optimum_.energy_error = -relative_down(-abs(facts.energy - optimum_.energy) / optimum_.energy, value_bits);
        optimum_.value = -relative_down(-facts.value, value_bits);
        optimum_.bound = relative_down(facts.bound, value_bits);
        certificate_.optimum = optimum_;
        const CheckResult result = check(certificate_);
        reason_ = result.reason;
        return result.valid;
    }

    OptimumProof found() {
        OptimumProof proof;
        if (optimum_.value > 0) proof.gap = std::abs(to_double((optimum_.value - optimum_.bound) / optimum_.value));
        proof.certificate = std::move(certificate_);
        return proof;
    }

    const PatternProblem& problem_;
    const Reduction& reduction_;
    Certificate certificate_;
    Optimum optimum_;
    Eigen::VectorXd gamma_;
    std::string reason_;
};

}  // namespace

OptimumProof certified_optimum(const PatternProblem& problem, Objective objective, const Rational& energy) {
    if (objective != Objective::least_shock && objective != Objective::least_force)
        throw std::invalid_argument("objective: expected least-shock or least-force, got " +
                                    std::string(name(objective)));
    const auto no = [](std::string reason) { return OptimumProof{std::nullopt, 0, std::move(reason)}; };
    if (!problem.proof.verdict_proved) return no(problem.proof.unproved);
    if (problem.kind != PatternKind::contact) return no("optimum: expected a contact motion");
    const Certificate& certificate = problem.proof.certificate;
    const bool inside = energy > 0 && (!certificate.energy_least || energy >= *certificate.energy_least) &&
                        (!certificate.energy_bound || energy <= *certificate.energy_bound);
    if (!inside) return no("optimum: no orbit of this pattern has that energy");
    return Certifier(problem, objective, energy).run();
}

}  // namespace nsma
