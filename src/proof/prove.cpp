#include "nsma/proof/prove.hpp"

#include <algorithm>
#include <numeric>

namespace nsma {
namespace {

using Shape = AdmissibleSet::Shape;

class Prover {
public:
    Prover(const Kernel& kernel, const AdmissibleSet& set) : kernel_(kernel), set_(set), reduction_(set.reduction) {
        certificate_.pattern = kernel.pattern;
        certificate_.gap_sign = reduction_.gap_sign;
    }

    Proof run() {
        using Claim = Certificate::Claim;
        const bool empty = set_.status == AdmissibleSet::Status::empty;
        certificate_.claim = kernel_.dimension() == 0 ? Claim::trivial : empty ? Claim::empty : Claim::nonempty;
        if (certificate_.claim == Claim::nonempty) certificate_.kind = pattern_kind(kernel_.pattern);
        if (set_.shape == Shape::chain && (!empty || reduction_.gap_sign == 0)) {
            certificate_.chain.resize(static_cast<std::size_t>(kernel_.dimension()));
            std::iota(certificate_.chain.begin(), certificate_.chain.end(), 0);
        }
        if (reduction_.gap_sign == 0) {
            prove_at_closed_gap(empty);
        } else if (kernel_.dimension() > 0) {
            certificate_.projection = projection(empty);
            if (!empty) claim_energies();
        }
        CheckResult result = check(certificate_);
        return {std::move(certificate_), result.valid, std::move(result.reason)};
    }

private:
    // COND2's coefficients are all the same over the columns that are left.
    [[nodiscard]] int weight() const { return reduction_.contact_row[0]; }

    void prove_at_closed_gap(bool empty) {
        if (empty && !reduction_.forced.empty()) certificate_.forcing_row = reduction_.forced.back().step;
        if (empty) return;
        for (int column = 0; column < kernel_.dimension(); ++column)
            certificate_.ray.emplace_back(column, reduction_.flip);
    }

    // Multipliers of the projection of delta w. A simplex and a nonempty chain need no row. Where a chain is empty, so
    // that delta w is a positive multiple of the sum of all columns, the row of that sum covers it; where COND1 forces
    // all columns to zero the last of those rows holds the sum of flip beta, so often that it does.
    [[nodiscard]] RationalVector projection(bool empty) const {
        RationalVector rows;
        const Rational times = reduction_.gap_sign * reduction_.flip * contact_row(kernel_)[0];
        if (empty && set_.shape == Shape::chain) {
            const auto last = static_cast<std::size_t>(reduction_.variables()) - 1;
            rows.emplace_back(reduction_.row_step[last], times);
        } else if (!reduction_.forced.empty() && times > 0) {
            rows.emplace_back(reduction_.forced.back().step, times);
        }
        return rows;
    }

    // |beta|^2 is 1/|w|^2 at least, and at most that of one column alone, or of a chain whose partial sums change all
    // the time between 0 and delta/w.
    void claim_energies() {
        const int n = reduction_.variables();
        Rational unit = Rational(2 * kernel_.pattern.cells) / weight();
        unit *= unit;
        unit /= kernel_.pattern.class_count();
        const int changes = set_.shape == Shape::simplex ? 1 : n % 2 == 1 ? n : n - 1;
        certificate_.energy_least = unit / n;
        certificate_.energy_attained = certificate_.energy_bound = unit * changes;
        Rational change = Rational(reduction_.gap_sign * reduction_.flip) / weight();
        for (int column = 0; column < changes; ++column) {
            certificate_.greatest.emplace_back(column, change);
            change = -change;
        }
    }

    const Kernel& kernel_;
    const AdmissibleSet& set_;
    const Reduction& reduction_;
    Certificate certificate_;
};

}  // namespace

bool Proof::exact_greatest() const {
    if (!certificate.ray.empty()) return true;
    return certificate.energy_bound && certificate.energy_attained &&
           *certificate.energy_bound == *certificate.energy_attained;
}

Proof prove(const Kernel& kernel, const AdmissibleSet& set) { return Prover(kernel, set).run(); }

}  // namespace nsma
