// Whether an optimum is one: an admissible orbit, and a bound that no orbit at the energy passes. Why the bound holds:
// data/optima.md, "What a certificate of an optimum rests on".
#include <algorithm>
#include <cstdlib>
#include <vector>

#include "certificate_terms.hpp"

#include "nsma/numerics/interruption.hpp"

namespace nsma {
namespace {

using Sign = CertificateTerms::Sign;

// Fractions grow with the columns they pass: their work with the third power.
constexpr int most_columns = 400;

constexpr unsigned most_multiplier_bits = 80;

unsigned bits_of(const Integer& value) { return value == 0 ? 0 : msb(abs(value)) + 1; }

// y_j = |beta_j| >= 0 of every column; the shock is 4 N R (|y|^2 - sum_j y_j y_{j+1} - closure y_m y_1) with R rounds.
struct Ring {
    Rational closure;
    Rational factor;  // 4 N R
};

Ring ring_of(const CertificateTerms& terms) {
    const Kernel& kernel = terms.kernel;
    const int period = kernel.pattern.period_steps();
    const int rounds = period / kernel.classes;
    const auto m = static_cast<int>(terms.dimension);
    std::vector<int> links(terms.dimension);  // from each column to the next one, of the last to the first
    for (int n = 0; n < period; ++n) {
        const int next = (n + 1) % period;
        const int from = kernel.column(n);
        const int to = kernel.column(next);
        if (from < 0 || to < 0) continue;
        if (to != (from + 1) % m) invalid("optimum: columns that are no neighbours follow each other");
        links[static_cast<std::size_t>(from)] +=
            kernel.sign[static_cast<std::size_t>(n)] * kernel.sign[static_cast<std::size_t>(next)];
    }
    for (int c = 0; c + 1 < m; ++c) {
        if (links[static_cast<std::size_t>(c)] != rounds) invalid("optimum: neighbouring columns do not always meet");
    }
    const Rational closure = Rational(links.back()) / rounds;
    return {closure, Rational(4 * kernel.pattern.cells) * rounds};
}

// Half of the form y^T (A - mu) y on k columns in a row that are alike on both sides of their middle, or opposite;
// A = 1 on the diagonal, -1/2 beside it, and -closure/2 between the ends. A tridiagonal matrix D over half the columns.
struct Half {
    std::vector<Rational> diagonal;
    bool centre = false;  // the last is the middle column, which counts once

    Half(int k, const Rational& mu, const Rational& closure, bool alike) : centre(alike && k % 2 == 1) {
        const Rational side = alike ? -1 : 1;
        diagonal.assign(static_cast<std::size_t>(k / 2), 1 - mu);
        if (centre) diagonal.push_back((1 - mu) / 2);
        if (diagonal.empty()) return;
        if (k > 1) diagonal.front() += side * closure / 2;
        if (k == 1) diagonal.front() -= closure / 2;
        if (k % 2 == 0) diagonal.back() += side / 2;
    }
};

struct Solved {
    int negative = 0;  // pivots
    Rational sum;      // e^T w of (A - mu) w = e
    Rational square;   // |w|^2
};

// Its pivots, and unless it is empty what it gives of the solution. Throws Invalid on a pivot that is zero.
Solved solve(const Half& half) {
    Solved result;
    const std::size_t n = half.diagonal.size();
    std::vector<Rational> pivots(n), right(n), solution(n);
    for (std::size_t j = 0; j < n; ++j) {
        stop_point();
        pivots[j] = half.diagonal[j];
        right[j] = half.centre && j + 1 == n ? Rational(1) / 2 : Rational(1);
        if (j > 0) {
            pivots[j] -= Rational(1) / 4 / pivots[j - 1];
            right[j] += right[j - 1] / 2 / pivots[j - 1];
        }
        if (pivots[j] == 0) invalid("optimum: the multiplier makes a pivot zero");
        result.negative += pivots[j] < 0 ? 1 : 0;
    }
    for (std::size_t j = n; j-- > 0;) {
        solution[j] = right[j];
        if (j + 1 < n) solution[j] += solution[j + 1] / 2;
        solution[j] /= pivots[j];
        const int times = half.centre && j + 1 == n ? 1 : 2;
        result.sum += times * solution[j];
        result.square += times * solution[j] * solution[j];
    }
    return result;
}

// The least of y^T A y over sum y = s, |y|^2 = q (of a closed gap: |y|^2 = q alone), y >= 0.
Rational least_shock(const CertificateTerms& terms, const Optimum& optimum, const Rational& closure, const Rational& s,
                     const Rational& q) {
    const auto m = static_cast<int>(terms.dimension);
    const int k = optimum.window;
    const Rational& mu = optimum.multiplier;
    if (k < 1 || k > m || k > most_columns) {
        invalid("optimum: expected a window of 1.." + std::to_string(std::min(m, most_columns)) + " columns, got " +
                std::to_string(k));
    }
    if (bits_of(numerator(mu)) > most_multiplier_bits || bits_of(denominator(mu)) > most_multiplier_bits)
        invalid("optimum: expected a multiplier of at most " + std::to_string(most_multiplier_bits) + " bits");
    const Rational ends = k == m ? closure : Rational(0);
    const Solved alike = solve(Half(k, mu, ends, true));
    const Solved opposite = solve(Half(k, mu, ends, false));
    if (opposite.negative > 0) invalid("optimum: the multiplier is too large for the window");
    if (terms.certificate.gap_sign == 0) {
        if (k != m || alike.negative > 0) invalid("optimum: expected a multiplier below every eigenvalue");
        return mu * q;
    }
    // A - mu + kappa e e^T is positive semidefinite from this kappa on.
    if (alike.negative > 1 || alike.sum == 0 || (alike.sum < 0) != (alike.negative == 1))
        invalid("optimum: the multiplier is too large for the window");
    if (k < m) {
        // The best orbit on the window has a multiplier that is not less; so those on more columns lean.
        if (alike.square * s * s > q * alike.sum * alike.sum) invalid("optimum: the multiplier is that of more energy");
        const Solved wider = solve(Half(k + 1, mu, k + 1 == m ? closure : Rational(0), false));
        if (wider.negative == 0) invalid("optimum: a wider window is not excluded");
    }
    return mu * q + s * s / alike.sum;
}

// A largest entry below t leaves less than q of the sum of squares: as many t as fit, and a rest.
void check_least_peak(const CertificateTerms& terms, const Optimum& optimum, const Rational& s, const Rational& q) {
    const Rational t = optimum.bound / (2 * terms.certificate.pattern.cells);
    if (t <= 0) invalid("optimum: expected a bound above zero");
    const Rational columns = terms.certificate.gap_sign == 0 ? Rational(static_cast<int>(terms.dimension)) : s / t;
    const Integer fit = numerator(columns) / denominator(columns);
    const Rational rest = terms.certificate.gap_sign == 0 ? Rational(0) : Rational(s - fit * t);
    if (fit * t * t + rest * rest > q) invalid("optimum: the bound is not proved");
}

Rational shock_of(const Ring& ring, const Fractions& orbit) {
    Whole products = 0;
    const auto& y = orbit.numerators;
    for (std::size_t c = 0; c + 1 < y.size(); ++c) products += Whole{y[c]} * y[c + 1];
    Rational sum(products);
    sum += ring.closure * (Rational(y.back()) * y.front());
    return ring.factor * (square(orbit) - sum / (Rational(orbit.denominator) * orbit.denominator));
}

Rational force_of(const CertificateTerms& terms, const Fractions& orbit) {
    std::int64_t largest = 0;
    for (const std::int64_t value : orbit.numerators) largest = std::max(largest, std::abs(value));
    return Rational(largest) * (2 * terms.certificate.pattern.cells) / orbit.denominator;
}

}  // namespace

OptimumFacts proved_optimum(const CertificateTerms& terms, const Optimum& optimum) {
    if (terms.certificate.kind != PatternKind::contact) invalid("optimum: expected a contact motion");
    // With y = |beta|: all of one sign, and COND2 says the sum, or of a closed gap nothing.
    for (std::size_t c = 0; c < terms.dimension; ++c) {
        const Sign sign = terms.signs[c];
        if ((sign != Sign::nonnegative && sign != Sign::nonpositive) || sign != terms.signs.front())
            invalid("optimum: COND3 differs from column to column");
        if (terms.contact[c] != terms.contact.front()) invalid("optimum: COND2 differs from column to column");
    }
    const int weight = terms.contact.front();
    if ((weight == 0) != (terms.certificate.gap_sign == 0)) invalid("optimum: COND2 does not say the sum");
    if (optimum.energy <= 0) invalid("optimum: expected an energy above zero");
    const Fractions orbit = terms.dense(optimum.orbit, "optimum");
    check_cone(terms, orbit, "optimum");
    if (contact_value(terms, orbit) != Whole{terms.certificate.gap_sign} * orbit.denominator)
        invalid("optimum: COND2 fails");
    OptimumFacts facts;
    facts.energy = terms.factor * square(orbit);
    const Rational q = optimum.energy / terms.factor;
    const Rational s = terms.certificate.gap_sign == 0 ? Rational(0) : 1 / abs(Rational(weight));
    if (optimum.objective == Optimum::Of::least_force) {
        facts.value = force_of(terms, orbit);
        check_least_peak(terms, optimum, s, q);
        facts.bound = optimum.bound;
    } else {
        const Ring ring = ring_of(terms);
        facts.value = shock_of(ring, orbit);
        facts.bound = ring.factor * least_shock(terms, optimum, ring.closure, s, q);
    }
    return facts;
}

}  // namespace nsma
