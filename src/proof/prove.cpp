#include "nsma/proof/prove.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "form_bounds.hpp"

namespace nsma {
namespace {

class Prover {
public:
    Prover(const Kernel& kernel, const AdmissibleSet& set)
        : kernel_(kernel), set_(set), reduction_(set.reduction), bounds_(kernel, set.reduction, set.shape) {
        proof_.certificate.pattern = kernel.pattern;
        proof_.certificate.gap_sign = reduction_.gap_sign;
    }

    Proof run() {
        auto& certificate = proof_.certificate;
        if (kernel_.dimension() == 0) {
            certificate.claim = Certificate::Claim::trivial;
        } else if (set_.status == AdmissibleSet::Status::failed) {
            proof_.unproved = set_.reason;
            return std::move(proof_);
        } else {
            const bool empty = set_.status == AdmissibleSet::Status::empty;
            certificate.claim = empty ? Certificate::Claim::empty : Certificate::Claim::nonempty;
            if (!empty) certificate.kind = pattern_kind(kernel_.pattern);
            if (reduction_.gap_sign == 0) {
                closed_gap(empty);
            } else {
                project(empty);
                if (!empty) claim_least();
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
    [[nodiscard]] int contact(std::size_t j) const { return reduction_.contact_row[static_cast<Eigen::Index>(j)]; }

    // Multipliers of the projection of delta w. A simplex and a nonempty chain need no row; where a chain is empty, so
    // that delta w is a positive multiple of the sum of all columns, the row of that sum covers it.
    void project(bool empty) {
        RowCombination combination;
        if (empty && set_.shape == AdmissibleSet::Shape::chain) {
            const int whole = chain_rows(reduction_).prefix.back();
            if (whole >= 0)
                combination.rows.emplace_back(reduction_.row_step[static_cast<std::size_t>(whole)],
                                              reduction_.gap_sign * contact(0));
        }
        // On columns that rows force to zero, delta w must be covered too.
        std::vector<Rational> target(static_cast<std::size_t>(kernel_.dimension()));
        const Eigen::VectorXi w = contact_row(kernel_);
        for (std::size_t c = 0; c < target.size(); ++c) {
            target[c] = reduction_.gap_sign * w[static_cast<Eigen::Index>(c)];
        }
        bounds_.cover_forced(target, combination);
        proof_.certificate.projection = std::move(combination.rows);
    }

    // |w|^2 over the reduced columns gives E_min; check() repeats it over all columns.
    void claim_least() {
        proof_.certificate.energy_least = energy_factor() / Rational(reduction_.contact_row.squaredNorm());
    }

    [[nodiscard]] Rational energy_factor() const {
        return {Integer(4) * kernel_.pattern.cells * kernel_.pattern.cells, kernel_.pattern.class_count()};
    }

    void closed_gap(bool empty) {
        auto& certificate = proof_.certificate;
        if (!empty) {
            certificate.ray = sparse(bounds_.unreduced(std::vector<Rational>(variables(), 1)));
            return;
        }
        // Forced columns belong to the first form as well: it must bound every column of COND3.
        std::vector<Rational> all(variables());
        for (std::size_t j = 0; j < variables(); ++j) all[j] = reduction_.bounded[j] != 0 ? 1 : 0;
        RowCombination combination;
        if (variables() > 0) combination = bounds_.bound(all).proof;
        std::vector<Rational> full = bounds_.unreduced(all);
        const Conditions terms = conditions(kernel_, 0);
        for (const auto& zero : reduction_.forced) {
            const auto c = static_cast<std::size_t>(zero.column);
            full[c] = terms.bound_of[c] == Conditions::Sign::nonpositive ? -1 : 1;
        }
        bounds_.cover_forced(full, combination);
        certificate.rest.push_back({sparse(full), std::move(combination)});
        for (std::size_t j = 0; j < variables(); ++j) {
            if (reduction_.bounded[j] != 0) continue;
            for (const int side : {1, -1}) {
                std::vector<Rational> form(variables());
                form[j] = side;
                certificate.rest.push_back(bounds_.bound(form));
            }
        }
    }

    // The columns of a vertex are whole multiples of 1/c.
    [[nodiscard]] RationalVector exact_vertex(const Eigen::VectorXd& gamma) const {
        std::vector<Rational> point(variables());
        for (std::size_t j = 0; j < variables(); ++j) {
            const int c = contact(j);
            point[j] = Rational(std::lround(gamma[static_cast<Eigen::Index>(j)] * c)) / c;
        }
        return sparse(bounds_.unreduced(point));
    }

    // The greatest vertex, and the bound that meets it; kept where check() agrees.
    void greatest() {
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
        trial.greatest_proof = chain();
        trial.energy_bound = proved_energy_bound(trial);  // verified by itself
        proof_.certificate = std::move(trial);
        if (!proof_.exact_greatest()) proof_.unproved = "no bound of the greatest energy meets the energy attained";
    }

    [[nodiscard]] GreatestProof chain() const {
        GreatestProof proof;
        for (std::size_t j = 0; j < variables(); ++j) proof.chain.push_back(reduction_.column[j]);
        // Columns that rows force to zero have no step: the checker does not know that they are
        // zero, so each enters the chain as well.
        for (const auto& zero : reduction_.forced) proof.chain.push_back(zero.column);
        const Eigen::VectorXi w = contact_row(kernel_);
        std::vector<Rational> partial(static_cast<std::size_t>(kernel_.dimension()));
        for (std::size_t k = 0; k + 1 < proof.chain.size(); ++k) {
            const auto c = static_cast<std::size_t>(proof.chain[k]);
            partial[c] = reduction_.gap_sign * w[static_cast<Eigen::Index>(c)];
            for (const int side : {1, -1}) {
                std::vector<Rational> reduced(variables());
                for (std::size_t j = 0; j < variables(); ++j) {
                    reduced[j] = side * reduction_.flip[j] * partial[static_cast<std::size_t>(reduction_.column[j])];
                }
                FormBound bound = bounds_.bound(reduced);
                std::vector<Rational> full = partial;
                for (auto& value : full) value *= side;
                bound.form = sparse(full);
                bounds_.cover_forced(full, bound.proof);
                proof.chain_bounds.push_back(std::move(bound));
            }
        }
        return proof;
    }

    const Kernel& kernel_;
    const AdmissibleSet& set_;
    const Reduction& reduction_;
    FormBounds bounds_;
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
