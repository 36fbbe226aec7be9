#include "form_bounds.hpp"

#include <algorithm>
#include <map>

namespace nsma {
RationalVector sparse(const std::vector<Rational>& dense) {
    RationalVector result;
    for (std::size_t i = 0; i < dense.size(); ++i) {
        if (dense[i] != 0) result.emplace_back(static_cast<int>(i), dense[i]);
    }
    return result;
}

std::vector<int> partial_sum_row(const Kernel& kernel, int step) {
    std::vector<int> row(static_cast<std::size_t>(kernel.dimension()), 0);
    for (int k = 0; k < step; ++k) {
        const int column = kernel.column(k);
        if (column >= 0) row[static_cast<std::size_t>(column)] += kernel.sign[static_cast<std::size_t>(k)];
    }
    return row;
}

FormBounds::FormBounds(const Kernel& kernel, const Reduction& reduction, AdmissibleSet::Shape shape)
    : kernel_(kernel), reduction_(reduction), shape_(shape) {
    if (shape_ == AdmissibleSet::Shape::chain) chain_ = chain_rows(reduction);
    const Eigen::VectorXi row = contact_row(kernel);
    contact_.assign(row.data(), row.data() + row.size());
    const Conditions terms = conditions(kernel, reduction.gap_sign);
    for (const auto& zero : reduction.forced) {
        const auto sign = terms.bound_of[static_cast<std::size_t>(zero.column)];
        forced_flip_.push_back(sign == Conditions::Sign::nonpositive ? -1 : 1);
    }
}

std::vector<Rational> FormBounds::unreduced(const std::vector<Rational>& form) const {
    std::vector<Rational> result(static_cast<std::size_t>(reduction_.kernel_dimension));
    for (std::size_t j = 0; j < form.size(); ++j) {
        result[static_cast<std::size_t>(reduction_.column[j])] = reduction_.flip[j] * form[j];
    }
    return result;
}

void FormBounds::cover_forced(const std::vector<Rational>& form, RowCombination& combination) const {
    if (reduction_.forced.empty()) return;
    const auto m = static_cast<std::size_t>(reduction_.kernel_dimension);
    std::vector<Rational> rest = form;
    for (std::size_t c = 0; c < m; ++c) rest[c] -= combination.contact * contact_[c];
    std::map<int, Rational> rows(combination.rows.begin(), combination.rows.end());
    for (const auto& [step, y] : rows) {
        const auto row = partial_sum_row(kernel_, step);
        for (std::size_t c = 0; c < m; ++c) {
            if (row[c] != 0) rest[c] -= y * row[c];
        }
    }
    // In reverse: a row may hold anything in columns that were forced before it.
    for (std::size_t i = reduction_.forced.size(); i-- > 0;) {
        const auto& zero = reduction_.forced[i];
        const auto c = static_cast<std::size_t>(zero.column);
        const Rational excess = forced_flip_[i] * rest[c];
        if (excess <= 0) continue;
        const auto row = partial_sum_row(kernel_, zero.step);
        const Rational times = excess / (forced_flip_[i] * row[c]);
        rows[zero.step] += times;
        for (std::size_t j = 0; j < m; ++j) {
            if (row[j] != 0) rest[j] -= times * row[j];
        }
    }
    combination.rows.clear();
    for (auto& [step, y] : rows) {
        if (y != 0) combination.rows.emplace_back(step, std::move(y));
    }
}

// The sum of all gamma_j is delta/c, so the greatest coefficient decides.
RowCombination FormBounds::simplex_bound(const std::vector<Rational>& form) const {
    return {{}, *std::max_element(form.begin(), form.end()) / reduction_.contact_row[0]};
}

// By parts, form . gamma = sum_k (f_k - f_{k+1}) P_k + f_n P_n: a positive difference takes P_k <= 0, a negative one
// P_n - P_k <= 0, and what is left is a multiple of COND2.
RowCombination FormBounds::chain_bound(const std::vector<Rational>& form) const {
    RowCombination result;
    Rational rest = form.back();
    for (std::size_t k = 1; k < form.size(); ++k) {
        const Rational difference = form[k - 1] - form[k];
        if (difference == 0) continue;
        const int row = difference > 0 ? chain_.prefix[k] : chain_.suffix[k];
        result.rows.emplace_back(reduction_.row_step[static_cast<std::size_t>(row)], abs(difference));
        if (difference < 0) rest += difference;
    }
    std::sort(result.rows.begin(), result.rows.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    result.contact = rest / reduction_.contact_row[0];
    return result;
}

FormBound FormBounds::bound(const std::vector<Rational>& form) const {
    RowCombination proof = shape_ == AdmissibleSet::Shape::chain ? chain_bound(form) : simplex_bound(form);
    const auto full = unreduced(form);
    cover_forced(full, proof);
    return {sparse(full), std::move(proof)};
}

}  // namespace nsma
