#include <algorithm>
#include <optional>
#include <set>

#include "certificate_terms.hpp"

#include "nsma/numerics/interruption.hpp"

namespace nsma {
namespace {

using Sign = CertificateTerms::Sign;

// Beyond this a chain is refused, so that a forged one cannot exhaust the machine: pairs of values over all its steps.
// Honest chains have two values.
constexpr std::size_t chain_work = 2'000'000;

// A convex sum of squared steps over bounds and known directions of steps is greatest at a
// vertex, and there every partial sum equals one of the bounds.
Rational best_chain(const CertificateTerms& terms, const std::vector<int>& chain, const std::vector<Rational>& lower,
                    const std::vector<Rational>& upper, const std::vector<Rational>& values) {
    // Steps over one denominator: that of the values times the weights.
    Integer common = 1, weights = 1;
    for (const Rational& value : values) common = common_multiple(common, denominator(value));
    for (const int column : chain)
        weights = common_multiple(weights, abs(Integer(terms.contact[static_cast<std::size_t>(column)])));
    std::vector<Integer> scaled;
    scaled.reserve(values.size());
    for (const Rational& value : values) scaled.push_back(numerator(value) * (common / denominator(value)));
    std::vector<std::optional<Integer>> best(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (values[i] == 0) best[i] = 0;
    }
    for (std::size_t k = 0; k < chain.size(); ++k) {
        stop_point();
        const auto c = static_cast<std::size_t>(chain[k]);
        const int weight = terms.certificate.gap_sign * terms.contact[c];
        int direction = terms.signs[c] == Sign::nonnegative ? 1 : terms.signs[c] == Sign::nonpositive ? -1 : 0;
        if (weight < 0) direction = -direction;
        const bool fixed = terms.signs[c] == Sign::zero;
        const Integer scale = weights / weight;
        std::vector<std::optional<Integer>> next(values.size());
        for (std::size_t to = 0; to < values.size(); ++to) {
            if (values[to] < lower[k + 1] || values[to] > upper[k + 1]) continue;
            for (std::size_t from = 0; from < values.size(); ++from) {
                if (!best[from] || (fixed && from != to)) continue;
                if ((direction > 0 && to < from) || (direction < 0 && to > from)) continue;
                const Integer step = (scaled[to] - scaled[from]) * scale;
                Integer total = *best[from] + step * step;
                if (!next[to] || total > *next[to]) next[to] = std::move(total);
            }
        }
        best = std::move(next);
    }
    const Integer unit = common * weights;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (values[i] == 1 && best[i]) return {*best[i], unit * unit};
    }
    invalid("chain: its bounds exclude one another");
}

Rational chain_bound(const CertificateTerms& terms, const GreatestProof& proof) {
    std::vector<int> seen(terms.dimension, 0);
    for (const int column : proof.chain) {
        if (column < 0 || column >= static_cast<int>(terms.dimension)) invalid("chain: unknown " + column_name(column));
        const auto c = static_cast<std::size_t>(column);
        if (seen[c]++ != 0 || terms.contact[c] == 0) invalid("chain: " + column_name(column) + " cannot be chained");
    }
    for (std::size_t c = 0; c < terms.dimension; ++c) {
        if (terms.signs[c] != Sign::zero && seen[c] == 0)
            invalid("chain: " + column_name(static_cast<int>(c)) + " is missing");
    }
    const std::size_t n = proof.chain.size();
    if (n == 0 || proof.chain_bounds.size() != 2 * (n - 1)) invalid("chain: expected two bounds a partial sum");
    std::vector<Rational> lower(n + 1);
    std::vector<Rational> upper(n + 1);
    lower[n] = upper[n] = 1;
    std::vector<int> partial(terms.dimension);
    std::set<Rational> values{Rational(0), Rational(1)};
    for (std::size_t k = 1; k < n; ++k) {
        const auto c = static_cast<std::size_t>(proof.chain[k - 1]);
        partial[c] = terms.certificate.gap_sign * terms.contact[c];
        for (const int side : {1, -1}) {
            const auto& bound = proof.chain_bounds[2 * (k - 1) + (side > 0 ? 0 : 1)];
            const Fractions form = terms.dense(bound.form, "form");
            for (std::size_t j = 0; j < terms.dimension; ++j) {
                if (form.numerators[j] != side * partial[j] * form.denominator)
                    invalid("chain: bound " + std::to_string(k) + " is of another form");
            }
            (side > 0 ? upper : lower)[k] = side * terms.verified(bound);
        }
        values.insert(lower[k]);
        values.insert(upper[k]);
    }
    if (values.size() * values.size() * n > chain_work)
        invalid("chain: expected few different bounds, got " + std::to_string(values.size()) + " over " +
                std::to_string(n) + " steps");
    return best_chain(terms, proof.chain, lower, upper, {values.begin(), values.end()});
}

}  // namespace

Rational proved_square(const CertificateTerms& terms) { return chain_bound(terms, terms.certificate.greatest_proof); }

}  // namespace nsma
