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

// Integers grow with the columns they pass: their work with the square, a second for so many.
constexpr int most_columns = 10'000;

constexpr unsigned most_multiplier_bits = 80;

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
// A = 1 on the diagonal, -1/2 beside it, and -closure/2 between the ends: a tridiagonal matrix over half the columns.
struct Half {
    int negative = 0;    // pivots
    Integer sum, scale;  // e^T w of (A - mu) w = e is sum/scale
};

// Row j says x_{j+1} = 2 a_j x_j - x_{j-1} - 2 r_j, so that x_j = u_j x_1 + v_j; the leading minors are u_{j+1}/2^j.
// All in integers, u_j and v_j times q^{j-1}. Throws Invalid on a pivot that is zero.
Half solve(int k, const Rational& mu, const Rational& closure, bool alike) {
    const Integer q = lcm(denominator(mu), denominator(closure));
    const auto whole = [&q](const Rational& value) -> Integer { return numerator(value) * (q / denominator(value)); };
    const bool centre = alike && k % 2 == 1;  // the last is the middle column, which counts once
    const int n = k / 2 + (centre ? 1 : 0);
    const int side = alike ? -1 : 1;
    const Integer stiffness = q - whole(mu);
    const Integer square = q * q;
    Integer u = 1, u_before = 0, v = 0, v_before = 0, power = q;
    Integer u_sum = 0, v_sum = 0, scale = 1;
    Half half;
    for (int j = 0; j < n; ++j) {
        stop_point();
        const bool middle = centre && j + 1 == n;
        Integer diagonal = middle ? stiffness : Integer(2 * stiffness);
        if (j == 0) diagonal += (k > 1 ? side : -1) * whole(closure);
        if (j + 1 == n && k % 2 == 0) diagonal += side * q;
        if (j > 0) {
            u_sum *= q;
            v_sum *= q;
            scale *= q;
        }
        u_sum += (middle ? 1 : 2) * u;
        v_sum += (middle ? 1 : 2) * v;
        Integer u_next = diagonal * u - square * u_before;
        Integer v_next = diagonal * v - square * v_before - (middle ? 1 : 2) * power;
        if (u_next == 0) invalid("optimum: the multiplier makes a pivot zero");
        half.negative += u_next.sign() != u.sign() ? 1 : 0;
        u_before.swap(u);
        v_before.swap(v);
        u.swap(u_next);
        v.swap(v_next);
        power *= q;
    }
    half.sum = v_sum * u - u_sum * v;
    half.scale = scale * u;
    if (half.scale < 0) {
        half.sum = -half.sum;
        half.scale = -half.scale;
    }
    return half;
}

// Not above value/divisor, by less than 2^-bound_bits.
Rational quotient_below(const Rational& value, const Rational& divisor) {
    constexpr unsigned bound_bits = 160;
    const Integer over = (numerator(value) * denominator(divisor)) << bound_bits;
    const Integer under = denominator(value) * numerator(divisor);
    Integer quotient = over / under;
    if (quotient * under != over && over.sign() * under.sign() < 0) --quotient;
    Rational result(quotient);
    result /= Integer(1) << bound_bits;
    return result;
}

void expect_short(const Rational& value) {
    const auto bits = [](const Integer& part) { return part == 0 ? 0U : msb(abs(part)) + 1U; };
    if (bits(numerator(value)) > most_multiplier_bits || bits(denominator(value)) > most_multiplier_bits)
        invalid("optimum: expected multipliers of at most " + std::to_string(most_multiplier_bits) + " bits");
}

// Whether sum y = s and |y|^2 = q leave the one point whose entries are all equal.
bool is_centre(const CertificateTerms& terms, const Rational& s, const Rational& q) {
    return s > 0 && s * s == q * static_cast<int>(terms.dimension);
}

// The least of y^T A y over sum y = s, |y|^2 = q (of a closed gap: |y|^2 = q alone), y >= 0.
Rational least_shock(const CertificateTerms& terms, const Optimum& optimum, const Rational& closure, const Rational& s,
                     const Rational& q) {
    const auto m = static_cast<int>(terms.dimension);
    const int k = optimum.window;
    const Rational& mu = optimum.multiplier;
    if (is_centre(terms, s, q)) return q / m * (1 - closure);
    if (k < 1 || k > m || k > most_columns) {
        invalid("optimum: expected a window of 1.." + std::to_string(std::min(m, most_columns)) + " columns, got " +
                std::to_string(k));
    }
    expect_short(mu);
    const Rational ends = k == m ? closure : Rational(0);
    const Half alike = solve(k, mu, ends, true);
    if (solve(k, mu, ends, false).negative > 0) invalid("optimum: the multiplier is too large for the window");
    if (terms.certificate.gap_sign == 0) {
        if (k != m || alike.negative > 0) invalid("optimum: expected a multiplier below every eigenvalue");
        return mu * q;
    }
    // A - mu + kappa e e^T is positive semidefinite from this kappa on.
    if (alike.negative > 1 || alike.sum == 0 || (alike.sum < 0) != (alike.negative == 1))
        invalid("optimum: the multiplier is too large for the window");
    if (k < m && solve(k + 1, mu, k + 1 == m ? closure : Rational(0), false).negative == 0)
        invalid("optimum: a wider window is not excluded");
    Rational share = s * s;
    share *= alike.scale;
    return mu * q + quotient_below(share, Rational(alike.sum));
}

// Not above sqrt(value), value >= 0.
Rational root_below(const Rational& value) {
    constexpr unsigned root_bits = 80;
    const Integer whole = (numerator(value) << (2 * root_bits)) / denominator(value);
    Rational root(sqrt(whole));
    root /= Integer(1) << root_bits;
    return root;
}

// The least of |beta - t|^2 over the same points: with y = |beta| and t alike
// t.y = nu sum y + sum (t_j - nu) y_j <= nu sum y + mu q/2 + sum (t_j - nu)_+^2/(2 mu) for any nu and mu > 0.
Rational least_distance(const CertificateTerms& terms, const Optimum& optimum, const Fractions& reference,
                        const Rational& s, const Rational& q) {
    const int sign = terms.signs.front() == Sign::nonnegative ? 1 : -1;
    const Rational& mu = optimum.multiplier;
    const Rational& nu = optimum.level;
    Rational product;  // t.y, at most
    if (is_centre(terms, s, q)) {
        for (const std::int64_t value : reference.numerators) product += sign * value;
        product *= s / static_cast<int>(terms.dimension) / reference.denominator;
    } else {
        expect_short(mu);
        expect_short(nu);
        if (mu < 0) invalid("optimum: expected a multiplier >= 0");
        const bool closed = terms.certificate.gap_sign == 0;
        if (closed && nu > 0) invalid("optimum: expected a level <= 0 of a closed gap");
        const Integer threshold = numerator(nu) * reference.denominator;
        Integer squares = 0;
        for (const std::int64_t value : reference.numerators) {
            const Integer above = sign * value * denominator(nu) - threshold;
            if (above > 0) squares += above * above;
        }
        Rational over(squares);
        over /= denominator(nu) * reference.denominator;
        over /= denominator(nu) * reference.denominator;
        if (mu == 0 && over != 0) invalid("optimum: expected a multiplier > 0");
        // Of a closed gap the sum is at least |y|, and nu <= 0.
        product = nu * (closed ? root_below(q) : s) + mu * q / 2;
        if (mu > 0) product += over / (2 * mu);
    }
    const Rational distance = q + square(reference) - 2 * product;
    return distance > 0 ? distance : Rational(0);
}

Rational distance_of(const Fractions& orbit, const Fractions& reference) {
    Whole products = 0;
    for (std::size_t c = 0; c < orbit.numerators.size(); ++c)
        products += Whole{orbit.numerators[c]} * reference.numerators[c];
    Rational twice(products);
    twice *= 2;
    twice /= orbit.denominator;
    twice /= reference.denominator;
    return square(orbit) + square(reference) - twice;
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
    if (terms.certificate.kind != PatternKind::contact && terms.certificate.kind != PatternKind::stuck)
        invalid("optimum: expected a motion with contact");
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
    } else if (optimum.objective == Optimum::Of::nearest) {
        const Fractions reference = terms.dense(optimum.reference, "reference");
        facts.value = terms.factor * distance_of(orbit, reference);
        facts.bound = terms.factor * least_distance(terms, optimum, reference, s, q);
    } else {
        const Ring ring = ring_of(terms);
        facts.value = shock_of(ring, orbit);
        facts.bound = ring.factor * least_shock(terms, optimum, ring.closure, s, q);
    }
    return facts;
}

}  // namespace nsma
