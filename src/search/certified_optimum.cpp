#include "nsma/search/certified_optimum.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
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
    [[nodiscard]] double multiplier() const {
        double lo = -1;
        // Where next to nothing is left to choose the multiplier has no lower end; whatever it is proves something.
        while (!low_enough(lo) && lo > -1e9) lo *= 2;
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
    Certifier(const PatternProblem& problem, const OrbitAnswer& answer)
        : problem_(problem),
          answer_(answer),
          reduction_(problem.set.reduction),
          closed_(reduction_.gap_sign == 0),
          certificate_(problem.proof.certificate) {
        optimum_.energy = decimal(*answer.level);
        const Eigen::VectorXd beta = answer.orbit->beta.cwiseAbs();
        sum_ = closed_ ? 1.0 : beta.sum();
        bits_ = closed_ ? most_bits - std::max(std::ilogb(beta.maxCoeff()) + 1, 0) : orbit_bits;
        optimum_.orbit = rounded(beta, true);
    }

    OptimumProof run() {
        if (bits_ >= 0) try_bounds();
        OptimumProof proof{std::nullopt, 0, check_seconds_, reason_};
        if (!reason_.empty()) return proof;
        proof.gap = relative_gap(optimum_);
        proof.certificate = std::move(certificate_);
        return proof;
    }

private:
    void try_bounds() {
        switch (answer_.objective) {
            case Objective::least_force: return bound_peak();
            case Objective::nearest: return bound_distance();
            default: return bound_shock();
        }
    }

    // A vector in whole multiples of a small unit, of a gap those of its share of COND2's sum, which a point has.
    [[nodiscard]] RationalVector rounded(const Eigen::VectorXd& y, bool point) const {
        if (bits_ < 0) return {};  // beyond what a checker reads
        const Integer scale = Integer(1) << bits_;
        std::vector<Integer> parts;
        Integer left = scale;
        for (const double value : y) {
            parts.emplace_back(std::llround(std::ldexp(value / sum_, bits_)));
            left -= parts.back();
        }
        if (!closed_ && point) *std::max_element(parts.begin(), parts.end()) += left;
        Rational unit = reduction_.flip;
        if (!closed_) unit *= Rational(reduction_.gap_sign) / reduction_.contact_row[0];
        unit /= scale;
        RationalVector entries;
        for (std::size_t j = 0; j < parts.size(); ++j) {
            if (parts[j] == 0) continue;
            Rational value = unit;
            value *= parts[j];
            entries.emplace_back(static_cast<int>(j), value);
        }
        return entries;
    }

    [[nodiscard]] Eigen::VectorXd best() const {
        return simplex_optimum(problem_.kernel, problem_.set, answer_.objective, *answer_.level, answer_.reference);
    }

    void bound_peak() {
        optimum_.objective = Optimum::Of::least_force;
        const double peak = best().maxCoeff() * 2 * problem_.kernel.pattern.cells;
        for (const double slack : {1e-14, 1e-12, 1e-10, 1e-8}) {
            optimum_.bound = relative_down(exact(peak * (1 - slack)), value_bits);
            if (proves()) return;
        }
    }

    void bound_shock() {
        optimum_.objective = Optimum::Of::least_shock;
        const Eigen::VectorXd gamma = best();
        const auto columns = static_cast<int>(gamma.size());
        const auto covered = static_cast<int>((gamma.array() > 1e-9 * gamma.maxCoeff()).count());
        for (const int k : {covered, covered + 1, covered - 1}) {
            if (k >= 1 && k <= columns && try_window(k, gamma)) return;
        }
    }

    bool try_window(int k, const Eigen::VectorXd& gamma) {
        const double closure = k == gamma.size() ? shock_closure(problem_.kernel, reduction_) : 0.0;
        const double sum = gamma.sum();
        const double mu = Window(k, closure, gamma.squaredNorm() / (sum * sum), closed_).multiplier();
        optimum_.window = k;
        for (const double slack : {1e-13, 1e-11, 1e-9, 1e-7}) {
            optimum_.multiplier = rounded_down(exact(mu - slack * std::max(1.0, std::abs(mu))), multiplier_bits);
            if (proves()) return true;
        }
        return false;
    }

    // The best of the bounds nu s + sqrt(q sum (t_j - nu)_+^2) on t.y, convex in nu.
    void bound_distance() {
        optimum_.objective = Optimum::Of::nearest;
        const Eigen::VectorXd target = reduction_.gamma(nearest_beta(problem_.kernel, answer_.reference));
        const double q = *answer_.level / reduction_.energy_factor;
        const auto above = [&](double nu) { return (target.array() - nu).max(0.0).matrix().eval(); };
        const auto rising = [&](double nu) { return sum_ * above(nu).norm() > std::sqrt(q) * above(nu).sum(); };
        double hi = target.maxCoeff();
        if (closed_) {
            hi = std::min(hi, 0.0);
        } else {
            double lo = hi - (hi - target.minCoeff()) - std::abs(hi);
            for (int i = 0; i < 30 && rising(lo); ++i) lo = hi - 2 * (hi - lo);
            for (int i = 0; i < 200 && hi - lo > 1e-16 * std::abs(lo); ++i) {
                const double middle = 0.5 * (lo + hi);
                (rising(middle) ? hi : lo) = middle;
            }
        }
        optimum_.reference = rounded(target, false);
        optimum_.level = rounded_down(exact(hi), multiplier_bits);
        // A little more, so that rounding never makes it zero.
        const double multiplier = above(to_double(optimum_.level)).norm() / std::sqrt(q) + 0x1p-40;
        optimum_.multiplier = rounded_down(exact(multiplier), multiplier_bits);
        (void)proves();
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
        const auto begin = std::chrono::steady_clock::now();
        const CheckResult result = check(certificate_);
        check_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        reason_ = result.reason;
        return result.valid;
    }

    const PatternProblem& problem_;
    const OrbitAnswer& answer_;
    const Reduction& reduction_;
    bool closed_;
    Certificate certificate_;
    Optimum optimum_;
    double sum_ = 0;
    int bits_ = 0;  // of the unit of all vectors
    double check_seconds_ = 0;
    std::string reason_ = "optimum: the energy is beyond what a checker reads";
};

}  // namespace

OptimumProof certified_optimum(const PatternProblem& problem, const OrbitAnswer& answer) {
    const auto no = [](std::string reason) { return OptimumProof{std::nullopt, 0, 0, std::move(reason)}; };
    if (!answer.orbit) return no("optimum: expected an orbit, got none");
    if (!problem.proof.verdict_proved) return no(problem.proof.unproved);
    if (!answer.level) {
        const bool least = answer.objective != Objective::max_energy;
        if (!least && !problem.proof.exact_greatest()) return no("optimum: the greatest energy is not exact");
        return {problem.proof.certificate, 0, 0, {}};
    }
    if (problem.kind == PatternKind::free) return no("optimum: expected a motion with contact");
    return Certifier(problem, answer).run();
}

}  // namespace nsma
