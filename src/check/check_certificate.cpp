// The checker of certificates. It takes nothing from the program that writes them: kernel signs
// are integers, everything else is fractions.
#include <algorithm>
#include <set>
#include <stdexcept>

#include "certificate_terms.hpp"

namespace nsma {
namespace {

class Checker {
public:
    explicit Checker(const Certificate& certificate) : certificate_(certificate), terms_(certificate) {}

    void run() {
        switch (certificate_.claim) {
            case Certificate::Claim::trivial:
                expect_no_kind();
                if (terms_.dimension != 0)
                    invalid("claim: expected a kernel of dimension 0, got " + std::to_string(terms_.dimension));
                expect_no_energies("a trivial kernel");
                return;
            case Certificate::Claim::empty: check_empty(); return;
            case Certificate::Claim::nonempty: check_nonempty(); return;
        }
        invalid("claim: unknown");
    }

    [[nodiscard]] Rational energy_bound() const { return terms_.factor * proved_square(terms_); }

private:
    using Sign = CertificateTerms::Sign;

    // COND1 and COND3 (a cone); COND2 is the caller's.
    void check_cone(const Fractions& beta, const std::string& what) const {
        for (std::size_t c = 0; c < terms_.dimension; ++c) {
            if (!terms_.allows(c, beta.numerators[c].sign()))
                invalid(what + ": COND3 fails at " + column_name(static_cast<int>(c)));
        }
        Integer sum = 0;
        for (int k = 0; k < certificate_.pattern.free_steps; ++k) {
            const int column = terms_.kernel.column(k);
            if (column < 0) continue;
            const auto c = static_cast<std::size_t>(column);
            if (terms_.kernel.sign[static_cast<std::size_t>(k)] > 0)
                sum += beta.numerators[c];
            else
                sum -= beta.numerators[c];
            if (sum > 0) invalid(what + ": COND1 row " + std::to_string(k + 1) + " fails");
        }
        if (sum != 0) invalid(what + ": the tip does not return to the wall");
    }

    [[nodiscard]] Rational contact_value(const Fractions& beta) const {
        Integer sum;
        for (std::size_t c = 0; c < terms_.dimension; ++c) sum += beta.numerators[c] * terms_.contact[c];
        return {sum, beta.denominator};
    }

    [[nodiscard]] static Rational square(const Fractions& beta) {
        Integer sum;
        for (const Integer& value : beta.numerators) sum += value * value;
        return {sum, beta.denominator * beta.denominator};
    }

    // rho: delta w minus the combination, projected on COND3's cone.
    [[nodiscard]] Fractions projection() const {
        Fractions result = terms_.combine_rows(certificate_.projection);
        for (std::size_t c = 0; c < terms_.dimension; ++c) {
            Integer& value = result.numerators[c];
            value = certificate_.gap_sign * terms_.contact[c] * result.denominator - value;
            if (!terms_.allows(c, value.sign())) value = 0;
        }
        return result;
    }

    void expect_no_energies(const char* of) const {
        if (certificate_.energy_least || certificate_.energy_attained || certificate_.energy_bound) {
            invalid(std::string("energies: expected none for ") + of);
        }
    }

    void expect_no_kind() const {
        if (certificate_.kind) invalid("kind: expected none but for a nonempty set");
    }

    // Whether a step of [begin, end) carries a column for which `moves` holds.
    template <class Moves>
    [[nodiscard]] bool any_step(int begin, int end, Moves moves) const {
        for (int n = begin; n < end; ++n) {
            const int column = terms_.kernel.column(n);
            if (column >= 0 && moves(static_cast<std::size_t>(column))) return true;
        }
        return false;
    }

    // `witness`: an admissible point, or direction of a closed gap. Where one presses and one moves the tip, a mixture
    // does both, and by COND1 a tip that moves leaves the wall.
    void check_kind(const Fractions& witness) const {
        if (!certificate_.kind) invalid("kind: expected contact, free or stuck, got none");
        const int r = certificate_.pattern.free_steps;
        const int period = certificate_.pattern.period_steps();
        const auto live = [&](std::size_t c) { return terms_.signs[c] != Sign::zero; };
        const auto nonzero = [&](std::size_t c) { return witness.numerators[c] != 0; };
        switch (*certificate_.kind) {
            case PatternKind::free:
                if (any_step(r, period, live)) invalid("kind: a contact step carries a wave, so free is not proved");
                return;
            case PatternKind::stuck:
                if (any_step(0, r, live)) invalid("kind: a free step carries a wave, so stuck is not proved");
                return;
            case PatternKind::contact: break;
        }
        if (!any_step(r, period, nonzero)) invalid("kind: the point does not press against the wall");
        if (!any_step(0, r, nonzero)) invalid("kind: the point does not leave the wall");
    }

    void check_empty() const {
        expect_no_kind();
        if (terms_.dimension == 0) invalid("claim: expected a nontrivial kernel, got dimension 0");
        expect_no_energies("an empty set");
        if (certificate_.gap_sign == 0) {
            check_only_rest();
            return;
        }
        const Fractions rho = projection();
        for (std::size_t c = 0; c < terms_.dimension; ++c) {
            if (rho.numerators[c] != 0) invalid("Farkas vector: " + column_name(static_cast<int>(c)) + " is left over");
        }
    }

    // Forms proved <= 0: first the sum of |beta_c| over COND3's columns, then +-beta_c of the others.
    void check_only_rest() const {
        std::set<std::pair<int, int>> free_bounded;
        bool bounded_zero = std::none_of(terms_.signs.begin(), terms_.signs.end(),
                                         [](Sign s) { return s == Sign::nonnegative || s == Sign::nonpositive; });
        for (const auto& bound : certificate_.rest) {
            if (terms_.verified(bound) > 0) invalid("rest: a form is not proved <= 0");
            const Fractions form = terms_.dense(bound.form, "form");
            bool covers = true;
            for (std::size_t c = 0; c < terms_.dimension; ++c) {
                const int sign = form.numerators[c].sign();
                covers = covers && (terms_.signs[c] != Sign::nonnegative || sign > 0) &&
                         (terms_.signs[c] != Sign::nonpositive || sign < 0) &&
                         (terms_.signs[c] != Sign::free || sign == 0);
            }
            bounded_zero = bounded_zero || covers;
            if (bound.form.size() == 1) {
                free_bounded.insert({bound.form[0].first, bound.form[0].second > 0 ? 1 : -1});
            }
        }
        if (!bounded_zero) invalid("rest: no form bounds every column of COND3");
        for (std::size_t c = 0; c < terms_.dimension; ++c) {
            if (terms_.signs[c] != Sign::free) continue;
            const int column = static_cast<int>(c);
            if (!free_bounded.contains({column, 1}) || !free_bounded.contains({column, -1})) {
                invalid("rest: " + column_name(column) + " is not bounded from both sides");
            }
        }
    }

    void check_nonempty() const {
        if (certificate_.gap_sign == 0) {
            check_kind(check_ray());
            expect_no_energies("a closed gap");
            return;
        }
        const Fractions rho = projection();
        const Rational length = square(rho);
        if (length == 0) invalid("least-energy point: the projection is zero");
        check_cone(rho, "least-energy point");
        // delta w . rho = |rho|^2 makes rho/|rho|^2 meet COND2 and proves that nothing is nearer.
        if (contact_value(rho) * certificate_.gap_sign != length) invalid("least-energy point: COND2 fails");
        if (!certificate_.energy_least || *certificate_.energy_least != terms_.factor / length) {
            invalid("energy_least: expected " + to_string(terms_.factor / length));
        }
        check_kind(rho);
        if (!certificate_.ray.empty()) invalid("ray: expected none where there is a gap");
        check_greatest(terms_.factor / length);
    }

    [[nodiscard]] Fractions check_ray() const {
        Fractions ray = terms_.dense(certificate_.ray, "ray");
        if (square(ray) == 0) invalid("ray: expected a nonzero direction");
        check_cone(ray, "ray");
        if (contact_value(ray) != 0) invalid("ray: COND2 fails");
        return ray;
    }

    void check_greatest(const Rational& least) const {
        if (certificate_.greatest.empty()) {
            if (certificate_.energy_attained) invalid("energy_attained: expected a point");
        } else {
            const Fractions point = terms_.dense(certificate_.greatest, "greatest");
            check_cone(point, "greatest-energy point");
            if (contact_value(point) != certificate_.gap_sign) invalid("greatest-energy point: COND2 fails");
            const Rational energy = terms_.factor * square(point);
            if (!certificate_.energy_attained || *certificate_.energy_attained != energy) {
                invalid("energy_attained: expected " + to_string(energy));
            }
        }
        if (!certificate_.energy_bound) return;
        const Rational bound = energy_bound();
        if (bound > *certificate_.energy_bound) invalid("energy_bound: proved only " + to_string(bound));
        if (*certificate_.energy_bound < least) invalid("energy_bound: below the least energy");
    }

    const Certificate& certificate_;
    CertificateTerms terms_;
};

// Empty when the four integers are within what the checker takes.
std::string refusal(const Certificate& certificate) {
    try {
        validate(certificate.pattern);
    } catch (const std::invalid_argument& error) {
        return std::string("pattern: ") + error.what();
    }
    if (certificate.gap_sign < -1 || certificate.gap_sign > 1) {
        return "gap_sign: expected -1, 0 or 1, got " + std::to_string(certificate.gap_sign);
    }
    return {};
}

}  // namespace

CheckResult check(const Certificate& certificate) {
    if (auto reason = refusal(certificate); !reason.empty()) return {false, std::move(reason)};
    try {
        Checker(certificate).run();
    } catch (const Invalid& failure) {
        return {false, failure.reason};
    }
    return {true, {}};
}

std::optional<Rational> proved_energy_bound(const Certificate& certificate) {
    if (!refusal(certificate).empty()) return std::nullopt;
    try {
        return Checker(certificate).energy_bound();
    } catch (const Invalid&) {
        return std::nullopt;
    }
}

}  // namespace nsma
