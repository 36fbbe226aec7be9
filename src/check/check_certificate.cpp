// The checker of certificates. It takes nothing from the program that writes them: kernel signs
// are integers, everything else is fractions. Its work is O(n_T).
#include <stdexcept>

#include "certificate_terms.hpp"

namespace nsma {
namespace {

class Checker {
public:
    explicit Checker(const Certificate& certificate) : certificate_(certificate), terms_(certificate) {}

    void run() {
        if (certificate_.optimum && certificate_.claim != Certificate::Claim::nonempty)
            invalid("optimum: expected none but of a nonempty set");
        switch (certificate_.claim) {
            case Certificate::Claim::trivial:
                expect_no_kind();
                if (terms_.dimension != 0)
                    invalid("claim: expected a kernel of dimension 0, got " + std::to_string(terms_.dimension));
                expect_no_energies("a trivial kernel");
                return;
            case Certificate::Claim::empty: check_empty(); return;
            case Certificate::Claim::nonempty: check_nonempty(); break;
        }
        if (certificate_.optimum) check_optimum(*certificate_.optimum);
    }

    [[nodiscard]] OptimumFacts optimum() const { return proved_optimum(terms_, *certificate_.optimum); }

private:
    using Sign = CertificateTerms::Sign;

    void check_optimum(const Optimum& said) const {
        const OptimumFacts facts = optimum();
        if (abs(facts.energy - said.energy) > said.energy_error * said.energy)
            invalid("optimum: its orbit has the energy " + to_string(facts.energy));
        if (facts.value > said.value) invalid("optimum: its orbit has " + to_string(facts.value));
        if (said.bound > facts.bound) invalid("optimum: proved only " + to_string(facts.bound));
    }

    // rho: delta w minus the combination, projected on COND3's cone.
    [[nodiscard]] Fractions projection() const {
        Fractions result = terms_.without_rows(certificate_.projection);
        for (std::size_t c = 0; c < terms_.dimension; ++c) {
            std::int64_t& value = result.numerators[c];
            if (!terms_.allows(c, value > 0 ? 1 : -1)) value = 0;
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
        bool any = false;
        terms_.kernel.for_each_live(begin, end, [&](int, std::size_t column, int) { any = any || moves(column); });
        return any;
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

    // Of a closed gap w . beta = 0.
    void check_only_rest() const {
        if (certificate_.forcing_row) {
            check_forcing_row(*certificate_.forcing_row);
        } else if (!certificate_.chain.empty()) {
            expect_chain(terms_);
        } else if (!is_simplex(terms_)) {
            invalid("rest: COND2 and COND3 alone leave more, and neither a row nor a chain is given");
        }
    }

    // A sum of terms that COND3 lets be nonnegative only, and COND1 nonpositive.
    void check_forcing_row(int n) const {
        if (n < 1 || n >= certificate_.pattern.free_steps) {
            invalid("forcing row: expected a step in 1.." + std::to_string(certificate_.pattern.free_steps - 1) +
                    ", got " + std::to_string(n));
        }
        std::vector<int> row(terms_.dimension);
        terms_.kernel.for_each_live(0, n, [&](int, std::size_t column, int sign) { row[column] += sign; });
        for (std::size_t c = 0; c < terms_.dimension; ++c) {
            const Sign sign = terms_.signs[c];
            const bool forced = sign == Sign::zero || (sign == Sign::nonnegative && row[c] > 0) ||
                                (sign == Sign::nonpositive && row[c] < 0);
            if (!forced) invalid("forcing row: " + column_name(static_cast<int>(c)) + " is left");
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
        check_cone(terms_, rho, "least-energy point");
        // delta w . rho = |rho|^2 makes rho/|rho|^2 meet COND2 and proves that nothing is nearer.
        if (Rational(contact_value(terms_, rho)) * certificate_.gap_sign / rho.denominator != length)
            invalid("least-energy point: COND2 fails");
        const Rational least = terms_.factor / length;
        if (!certificate_.energy_least || *certificate_.energy_least != least)
            invalid("energy_least: expected " + to_string(least));
        check_kind(rho);
        if (!certificate_.ray.empty()) invalid("ray: expected none where there is a gap");
        check_greatest(least);
    }

    [[nodiscard]] Fractions check_ray() const {
        Fractions ray = terms_.dense(certificate_.ray, "ray");
        if (square(ray) == 0) invalid("ray: expected a nonzero direction");
        check_cone(terms_, ray, "ray");
        if (contact_value(terms_, ray) != 0) invalid("ray: COND2 fails");
        return ray;
    }

    void check_greatest(const Rational& least) const {
        if (certificate_.greatest.empty()) {
            if (certificate_.energy_attained) invalid("energy_attained: expected a point");
        } else {
            const Fractions point = terms_.dense(certificate_.greatest, "greatest");
            check_cone(terms_, point, "greatest-energy point");
            if (contact_value(terms_, point) != Whole{certificate_.gap_sign} * point.denominator)
                invalid("greatest-energy point: COND2 fails");
            const Rational energy = terms_.factor * square(point);
            if (!certificate_.energy_attained || *certificate_.energy_attained != energy) {
                invalid("energy_attained: expected " + to_string(energy));
            }
        }
        if (!certificate_.energy_bound) return;
        const Rational bound = terms_.factor * proved_square(terms_);
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

double relative_gap(const Optimum& optimum) {
    const Rational& scale = optimum.objective == Optimum::Of::nearest ? optimum.energy : optimum.value;
    return scale > 0 ? std::abs(to_double((optimum.value - optimum.bound) / scale)) : 0.0;
}

OptimumFacts optimum_facts(const Certificate& certificate) {
    OptimumFacts facts;
    facts.reason = refusal(certificate);
    if (facts.reason.empty() && !certificate.optimum) facts.reason = "optimum: expected one, got none";
    if (!facts.reason.empty()) return facts;
    try {
        facts = Checker(certificate).optimum();
    } catch (const Invalid& failure) {
        facts.reason = failure.reason;
    }
    return facts;
}

}  // namespace nsma
