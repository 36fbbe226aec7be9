#include "nsma/proof/prove.hpp"
#include "nsma/numerics/interruption.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace nsma {
namespace {

using Shape = AdmissibleSet::Shape;
using Dense = std::vector<Rational>;

// The proof of a chain grows with the square of its columns: 256 megabytes of text here.
constexpr std::size_t most_chained = 2'500;

RationalVector sparse(const Dense& dense) {
    RationalVector result;
    for (std::size_t i = 0; i < dense.size(); ++i) {
        if (dense[i] != 0) result.emplace_back(static_cast<int>(i), dense[i]);
    }
    return result;
}

class Prover {
public:
    Prover(const Kernel& kernel, const AdmissibleSet& set) : kernel_(kernel), set_(set), reduction_(set.reduction) {
        proof_.certificate.pattern = kernel.pattern;
        proof_.certificate.gap_sign = reduction_.gap_sign;
    }

    Proof run() {
        auto& certificate = proof_.certificate;
        if (kernel_.dimension() == 0) {
            certificate.claim = Certificate::Claim::trivial;
        } else {
            const bool empty = set_.status == AdmissibleSet::Status::empty;
            certificate.claim = empty ? Certificate::Claim::empty : Certificate::Claim::nonempty;
            if (!empty) certificate.kind = pattern_kind(kernel_.pattern);
            if (reduction_.gap_sign == 0 && empty) {
                certificate.rest = only_rest();
            } else if (reduction_.gap_sign == 0) {
                certificate.ray = sparse(unreduced(Dense(variables(), 1)));
            } else {
                certificate.projection = projection(empty);
                // |w|^2 over the reduced columns; check() repeats it over all columns.
                if (!empty) certificate.energy_least = energy_factor() / Rational(reduction_.contact_row.squaredNorm());
            }
        }
        CheckResult result = check(certificate);
        proof_.verdict_proved = result.valid;
        if (!result.valid) {
            proof_.unproved = result.reason;
            return std::move(proof_);
        }
        if (certificate.claim == Certificate::Claim::nonempty && reduction_.gap_sign != 0) greatest();
        return std::move(proof_);
    }

private:
    [[nodiscard]] std::size_t variables() const { return static_cast<std::size_t>(reduction_.variables()); }
    // COND2's coefficients are all the same over the reduced variables.
    [[nodiscard]] int weight() const { return reduction_.contact_row[0]; }
    [[nodiscard]] Rational energy_factor() const {
        return {Integer(4) * kernel_.pattern.cells * kernel_.pattern.cells, kernel_.pattern.class_count()};
    }

    // A vector over the columns of beta from one over the reduced variables.
    [[nodiscard]] Dense unreduced(const Dense& form) const {
        Dense result(static_cast<std::size_t>(reduction_.kernel_dimension));
        for (std::size_t j = 0; j < form.size(); ++j) {
            result[j] = reduction_.flip * form[j];
        }
        return result;
    }

    // The last of the rows that force columns to zero holds the sum of flip beta over all of them: so often that it
    // dominates `times` that sum.
    [[nodiscard]] RationalVector forcing_row(int times) const {
        if (reduction_.forced.empty() || times <= 0) return {};
        return {{reduction_.forced.back().step, times}};
    }

    // The least upper bound of form . gamma with exact multipliers.
    [[nodiscard]] FormBound bound(const Dense& form) const {
        stop_point();
        // Of a simplex the sum of all gamma_j is delta/weight, so the greatest coefficient decides.
        RowCombination proof = set_.shape == Shape::chain
                                   ? chain_bound(form)
                                   : RowCombination{{}, *std::max_element(form.begin(), form.end()) / weight()};
        return {sparse(unreduced(form)), std::move(proof)};
    }

    // By parts, form . gamma = sum_k (f_k - f_{k+1}) P_k + f_n P_n: a positive difference takes P_k <= 0, a negative
    // one P_n - P_k <= 0, and what is left is a multiple of COND2.
    [[nodiscard]] RowCombination chain_bound(const Dense& form) const {
        RowCombination result;
        Rational rest = form.back();
        for (std::size_t k = 1; k < form.size(); ++k) {
            const Rational difference = form[k - 1] - form[k];
            if (difference == 0) continue;
            const std::size_t row = difference > 0 ? k - 1 : form.size() + k - 1;
            result.rows.emplace_back(reduction_.row_step[row], abs(difference));
            if (difference < 0) rest += difference;
        }
        std::sort(result.rows.begin(), result.rows.end(),
                  [](const auto& a, const auto& b) { return a.first < b.first; });
        result.contact = rest / weight();
        return result;
    }

    // Multipliers of the projection of delta w. A simplex and a nonempty chain need no row; where a chain is empty, so
    // that delta w is a positive multiple of the sum of all columns, the row of that sum covers it.
    [[nodiscard]] RationalVector projection(bool empty) const {
        if (empty && set_.shape == Shape::chain) {
            return {{reduction_.row_step[variables() - 1], reduction_.gap_sign * weight()}};
        }
        return forcing_row(reduction_.gap_sign * reduction_.flip * contact_row(kernel_)[0]);
    }

    // Forms proved <= 0 that leave only rest: first one over every column of COND3.
    [[nodiscard]] std::vector<FormBound> only_rest() const {
        if (variables() == 0) {
            const bool forced = !reduction_.forced.empty();
            const Dense sum(static_cast<std::size_t>(kernel_.dimension()), forced ? reduction_.flip : 0);
            return {{sparse(sum), {forcing_row(1), 0}}};
        }
        if (set_.shape == Shape::simplex) return {bound(Dense(variables(), 1))};
        std::vector<FormBound> forms{bound(Dense(variables()))};  // COND3 has none
        for (std::size_t j = 0; j < variables(); ++j) {
            for (const int side : {1, -1}) {
                Dense form(variables());
                form[j] = side;
                forms.push_back(bound(form));
            }
        }
        return forms;
    }

    // The columns of a vertex are whole multiples of 1/weight.
    [[nodiscard]] RationalVector exact_vertex(const Eigen::VectorXd& gamma) const {
        Dense point(variables());
        for (std::size_t j = 0; j < variables(); ++j) {
            point[j] = Rational(std::lround(gamma[static_cast<Eigen::Index>(j)] * weight())) / weight();
        }
        return sparse(unreduced(point));
    }

    // The greatest vertex, and the bound that meets it; kept where check() agrees.
    void greatest() {
        if (set_.shape == Shape::chain && variables() > most_chained) {
            proof_.unproved = "greatest energy: proved for chains of at most " + std::to_string(most_chained) +
                              " columns, got " + std::to_string(variables());
            return;
        }
        Certificate trial = proof_.certificate;
        trial.greatest = exact_vertex(set_.vertices.front());
        Rational square;
        for (const auto& [column, value] : trial.greatest) square += value * value;
        trial.energy_attained = energy_factor() * square;
        const CheckResult result = check(trial);
        if (!result.valid) {
            proof_.unproved = result.reason;
            return;
        }
        trial.greatest_proof = greatest_proof();
        trial.energy_bound = proved_energy_bound(trial);  // verified by itself
        proof_.certificate = std::move(trial);
        if (!proof_.exact_greatest()) proof_.unproved = "no bound of the greatest energy meets the energy attained";
    }

    [[nodiscard]] GreatestProof greatest_proof() const {
        GreatestProof proof{std::vector<int>(variables()), {}};
        std::iota(proof.chain.begin(), proof.chain.end(), 0);
        Dense sum(variables());
        for (std::size_t k = 0; k + 1 < variables(); ++k) {
            sum[k] = reduction_.gap_sign * weight();
            proof.chain_bounds.push_back(bound(sum));
            Dense opposite = sum;
            for (Rational& value : opposite) value = -value;
            proof.chain_bounds.push_back(bound(opposite));
        }
        return proof;
    }

    const Kernel& kernel_;
    const AdmissibleSet& set_;
    const Reduction& reduction_;
    Proof proof_;
};

}  // namespace

bool Proof::exact_greatest() const {
    if (!certificate.ray.empty()) return true;
    return certificate.energy_bound && certificate.energy_attained &&
           *certificate.energy_bound == *certificate.energy_attained;
}

Proof prove(const Kernel& kernel, const AdmissibleSet& set) { return Prover(kernel, set).run(); }

}  // namespace nsma
