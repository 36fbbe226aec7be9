#include "nsma/program/prove.hpp"

#include <algorithm>
#include <cmath>

#include "bound_tree.hpp"
#include "form_bounds.hpp"

namespace nsma {
namespace {

// Entries of a vertex from CLP (tolerance 1e-9, sharpened) below this are zero.
constexpr double vertex_tolerance = 1e-8;

class Prover {
public:
    Prover(const Kernel& kernel, const AdmissibleSet& set, const ProveOptions& options)
        : kernel_(kernel), set_(set), reduction_(set.reduction), options_(options) {
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
            bounds_.emplace(kernel_, reduction_, set_.shape);
            const bool empty = set_.status == AdmissibleSet::Status::empty;
            certificate.claim = empty ? Certificate::Claim::empty : Certificate::Claim::nonempty;
            if (reduction_.gap_sign == 0) {
                closed_gap(empty);
            } else {
                project();
                if (!empty) claim_least();
            }
        }
        CheckResult result = check(certificate);
        proof_.verdict_proved = result.valid;
        if (!result.valid) {
            proof_.unproved = result.reason;
            return std::move(proof_);
        }
        if (certificate.claim == Certificate::Claim::nonempty && options_.greatest) greatest();
        return std::move(proof_);
    }

private:
    [[nodiscard]] std::size_t variables() const { return static_cast<std::size_t>(reduction_.variables()); }

    // Multipliers of the projection of delta w, by the normal equations on its active set.
    void project() {
        RowCombination combination;
        const auto& rows = set_.projection_rows;
        std::vector<char> zero(variables(), 0);
        for (const int j : set_.projection_zeros) zero[static_cast<std::size_t>(j)] = 1;
        std::vector<std::vector<Integer>> gram(rows.size(), std::vector<Integer>(rows.size()));
        std::vector<Integer> right(rows.size());
        for (std::size_t a = 0; a < rows.size(); ++a) {
            for (std::size_t b = 0; b < rows.size(); ++b) {
                long sum = 0;
                for (std::size_t j = 0; j < variables(); ++j) {
                    if (zero[j] == 0) sum += long{entry(rows[a], j)} * entry(rows[b], j);
                }
                gram[a][b] = sum;
            }
            long sum = 0;
            for (std::size_t j = 0; j < variables(); ++j) {
                if (zero[j] == 0) sum += long{entry(rows[a], j)} * contact(j);
            }
            right[a] = reduction_.gap_sign * sum;
        }
        const auto solved = solve_exactly(std::move(gram), std::move(right));
        if (solved) {
            for (std::size_t a = 0; a < rows.size(); ++a) {
                if ((*solved)[a] == 0) continue;
                combination.rows.emplace_back(reduction_.row_step[static_cast<std::size_t>(rows[a])], (*solved)[a]);
            }
        }
        // On columns that rows force to zero, delta w must be covered too.
        std::vector<Rational> target(static_cast<std::size_t>(kernel_.dimension()));
        const Eigen::VectorXi w = contact_row(kernel_);
        for (std::size_t c = 0; c < target.size(); ++c) {
            target[c] = reduction_.gap_sign * w[static_cast<Eigen::Index>(c)];
        }
        bounds_->cover_forced(target, combination);
        proof_.certificate.projection = std::move(combination.rows);
    }

    [[nodiscard]] int entry(int row, std::size_t j) const {
        return reduction_.rows(row, static_cast<Eigen::Index>(j));
    }
    [[nodiscard]] int contact(std::size_t j) const {
        return reduction_.contact_row[static_cast<Eigen::Index>(j)];
    }

    // |rho|^2 of the reduced columns gives E_min; check() repeats it over all columns.
    void claim_least() {
        std::vector<Rational> rho(variables());
        for (std::size_t j = 0; j < variables(); ++j) rho[j] = reduction_.gap_sign * contact(j);
        for (const auto& [step, y] : proof_.certificate.projection) {
            const auto row = std::find(reduction_.row_step.begin(), reduction_.row_step.end(), step);
            if (row == reduction_.row_step.end()) continue;  // a row of forced zeros only
            const auto i = static_cast<int>(row - reduction_.row_step.begin());
            for (std::size_t j = 0; j < variables(); ++j) {
                if (entry(i, j) != 0) rho[j] -= y * entry(i, j);
            }
        }
        Rational length;
        for (std::size_t j = 0; j < variables(); ++j) {
            if (reduction_.bounded[j] != 0 && rho[j] < 0) continue;
            length += rho[j] * rho[j];
        }
        if (length == 0) return;
        proof_.certificate.energy_least = energy_factor() / length;
    }

    [[nodiscard]] Rational energy_factor() const {
        return {Integer(4) * kernel_.pattern.cells * kernel_.pattern.cells, kernel_.pattern.class_count()};
    }

    void closed_gap(bool empty) {
        auto& certificate = proof_.certificate;
        if (!empty) {
            certificate.ray = exact_point(set_.ray / set_.ray.cwiseAbs().maxCoeff(), true);
            return;
        }
        const auto add = [&](const std::vector<Rational>& form) {
            if (auto bound = bounds_->bound(form)) {
                certificate.rest.push_back(std::move(*bound));
            }
        };
        // Forced columns belong to the first form as well: it must bound every column of COND3.
        std::vector<Rational> all(variables());
        for (std::size_t j = 0; j < variables(); ++j) all[j] = reduction_.bounded[j] != 0 ? 1 : 0;
        RowCombination combination;
        if (variables() > 0) {
            if (const auto bound = bounds_->bound(all)) combination = bound->proof;
        }
        std::vector<Rational> full = bounds_->unreduced(all);
        const Conditions terms = conditions(kernel_, 0);
        for (const auto& zero : reduction_.forced) {
            const auto c = static_cast<std::size_t>(zero.column);
            full[c] = terms.bound_of[c] == Conditions::Sign::nonpositive ? -1 : 1;
        }
        bounds_->cover_forced(full, combination);
        certificate.rest.push_back({sparse(full), std::move(combination)});
        for (std::size_t j = 0; j < variables(); ++j) {
            if (reduction_.bounded[j] != 0) continue;
            for (const int side : {1, -1}) {
                std::vector<Rational> form(variables());
                form[j] = side;
                add(form);
            }
        }
    }

    // The columns of a known shape's vertices are whole multiples of 1/c.
    [[nodiscard]] RationalVector known_vertex(const Eigen::VectorXd& gamma) const {
        std::vector<Rational> point(variables());
        for (std::size_t j = 0; j < variables(); ++j) {
            const int c = contact(j);
            point[j] = Rational(std::lround(gamma[static_cast<Eigen::Index>(j)] * c)) / c;
        }
        return sparse(bounds_->unreduced(point));
    }

    // The vertex of floating-point `gamma` in fractions: its zero columns (for a direction in the
    // unit box also its +-1 columns) and active rows determine it. Empty where they do not.
    [[nodiscard]] RationalVector exact_point(const Eigen::VectorXd& gamma, bool direction) const {
        if (!direction && set_.shape != AdmissibleSet::Shape::general) return known_vertex(gamma);
        const double tolerance = vertex_tolerance * gamma.cwiseAbs().maxCoeff();
        std::vector<std::size_t> basic;
        std::vector<int> fixed(variables(), 0);
        for (std::size_t j = 0; j < variables(); ++j) {
            const double value = gamma[static_cast<Eigen::Index>(j)];
            if (direction && std::abs(std::abs(value) - 1) <= vertex_tolerance) {
                fixed[j] = value > 0 ? 1 : -1;
            } else if (std::abs(value) > tolerance || reduction_.bounded[j] == 0) {
                basic.push_back(j);
            }
        }
        std::vector<std::vector<Integer>> a;
        std::vector<Integer> b;
        const auto add_equation = [&](const auto& coefficient, long value) {
            std::vector<Integer> row;
            for (const auto j : basic) row.emplace_back(coefficient(j));
            for (std::size_t j = 0; j < variables(); ++j) value -= long{coefficient(j)} * fixed[j];
            a.push_back(std::move(row));
            b.emplace_back(value);
        };
        add_equation([&](std::size_t j) { return contact(j); }, direction ? 0 : reduction_.gap_sign);
        const Eigen::VectorXd values = reduction_.rows.cast<double>() * gamma;
        for (Eigen::Index i = 0; i < values.size(); ++i) {
            if (values[i] >= -tolerance) {
                add_equation([&](std::size_t j) { return entry(static_cast<int>(i), j); }, 0);
            }
        }
        const auto solved = solve_exactly(std::move(a), std::move(b));
        if (!solved || solved->size() != basic.size()) return {};
        std::vector<Rational> point(variables());
        for (std::size_t j = 0; j < variables(); ++j) point[j] = fixed[j];
        for (std::size_t k = 0; k < basic.size(); ++k) point[basic[k]] = (*solved)[k];
        return sparse(bounds_->unreduced(point));
    }

    void greatest() {
        auto& certificate = proof_.certificate;
        if (reduction_.gap_sign == 0) {
            proof_.greatest_proved = true;  // a cone: every energy
            return;
        }
        if (set_.unbounded()) {
            certificate.ray = exact_point(set_.ray / set_.ray.cwiseAbs().maxCoeff(), true);
            proof_.greatest_proved = !certificate.ray.empty() && check(certificate).valid;
            if (!proof_.greatest_proved) {
                certificate.ray.clear();
                proof_.unproved = "the ray found does not verify";
            }
            return;
        }
        if (!set_.vertices.empty()) take_point(set_.vertices.front());
        const bool closed = (options_.chain && try_chain()) || try_tree(1);
        if (!closed && options_.node_limit > 1) try_tree(options_.node_limit);
        proof_.greatest_proved = certificate.energy_bound.has_value();
        if (!proof_.greatest_proved && proof_.unproved.empty()) {
            proof_.unproved = "no bound of the greatest energy verifies";
        }
        if (certificate.energy_bound && certificate.energy_attained) {
            proof_.bound_gap = to_double(*certificate.energy_bound / *certificate.energy_attained - 1);
        }
    }

    // Claims an admissible point if it verifies and beats the one held.
    void take_point(const Eigen::VectorXd& gamma) {
        Certificate trial = proof_.certificate;
        trial.greatest = exact_point(gamma, false);
        if (trial.greatest.empty()) return;
        Rational square;
        for (const auto& [column, value] : trial.greatest) square += value * value;
        const Rational energy = energy_factor() * square;
        if (trial.energy_attained && energy <= *trial.energy_attained) return;
        trial.energy_attained = energy;
        trial.energy_bound.reset();
        if (!check(trial).valid) return;
        proof_.certificate.greatest = std::move(trial.greatest);
        proof_.certificate.energy_attained = energy;
    }

    // Keeps a proof of the bound if it verifies and beats the one held; true once nothing is open.
    bool take_bound(GreatestProof candidate, int nodes) {
        auto& certificate = proof_.certificate;
        Certificate trial = certificate;
        trial.greatest_proof = std::move(candidate);
        const auto bound = proved_energy_bound(trial);
        if (bound && (!certificate.energy_bound || *bound < *certificate.energy_bound)) {
            certificate.greatest_proof = std::move(trial.greatest_proof);
            certificate.energy_bound = bound;
            proof_.nodes = nodes;
        }
        return certificate.energy_bound && certificate.energy_attained &&
               *certificate.energy_bound == *certificate.energy_attained;
    }

    bool try_chain() {
        GreatestProof candidate;
        for (std::size_t j = 0; j < variables(); ++j) {
            if (contact(j) == 0) return false;
            candidate.chain.push_back(reduction_.column[j]);
        }
        // Columns that rows force to zero have no step: the checker does not know that they are
        // zero, so each enters the chain as well.
        const auto m = static_cast<std::size_t>(kernel_.dimension());
        const Eigen::VectorXi w = contact_row(kernel_);
        for (const auto& zero : reduction_.forced) {
            if (w[zero.column] == 0) return false;
            candidate.chain.push_back(zero.column);
        }
        std::vector<Rational> partial(m);
        for (std::size_t k = 0; k + 1 < candidate.chain.size(); ++k) {
            const auto c = static_cast<std::size_t>(candidate.chain[k]);
            partial[c] = reduction_.gap_sign * w[static_cast<Eigen::Index>(c)];
            for (const int side : {1, -1}) {
                std::vector<Rational> reduced(variables());
                for (std::size_t j = 0; j < variables(); ++j) {
                    reduced[j] = side * reduction_.flip[j] * partial[static_cast<std::size_t>(reduction_.column[j])];
                }
                auto bound = bounds_->bound(reduced);
                if (!bound) return false;
                std::vector<Rational> full = partial;
                for (auto& value : full) value *= side;
                bound->form = sparse(full);
                bounds_->cover_forced(full, bound->proof);
                candidate.chain_bounds.push_back(std::move(*bound));
            }
        }
        return take_bound(std::move(candidate), 0);
    }

    [[nodiscard]] double attained_square() const {
        const auto& attained = proof_.certificate.energy_attained;
        return attained ? to_double(*attained / energy_factor()) : 0.0;
    }

    bool try_tree(int node_limit) {
        BoundTree tree(kernel_, reduction_, *bounds_, [this] { return attained_square(); },
                       [this](const Eigen::VectorXd& point) { take_point(point); });
        auto candidate = tree.grow(node_limit);
        if (!candidate) return false;
        const int nodes = static_cast<int>(candidate->tree.size());
        return take_bound(std::move(*candidate), nodes);
    }

    const Kernel& kernel_;
    const AdmissibleSet& set_;
    const Reduction& reduction_;
    const ProveOptions& options_;
    std::optional<FormBounds> bounds_;
    Proof proof_;
};

}  // namespace

bool Proof::exact_greatest() const {
    if (!certificate.ray.empty()) return true;
    return certificate.energy_bound && certificate.energy_attained &&
           *certificate.energy_bound == *certificate.energy_attained;
}

Proof prove(const Kernel& kernel, const AdmissibleSet& set, const ProveOptions& options) {
    return Prover(kernel, set, options).run();
}

}  // namespace nsma
