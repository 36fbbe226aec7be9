#include <algorithm>
#include <cstdlib>

#include "certificate_terms.hpp"

namespace nsma {
namespace {

using Sign = CertificateTerms::Sign;

// A COND1 row over the columns of a chain, step by step, and where neighbours in it differ.
class ChainRow {
public:
    explicit ChainRow(std::size_t columns) : row_(columns) {}

    void add(std::size_t place, int sign) {
        count_borders(place, -1);
        row_[place] += sign;
        count_borders(place, 1);
    }
    /// Where all columns before are alike and all from there on: one of the two kinds is zero. Else 0.
    [[nodiscard]] std::size_t border() const {
        return borders_ == 1 && (row_.front() == 0 || row_.back() == 0) ? border_sum_ : 0;
    }
    [[nodiscard]] int first() const { return row_.front(); }
    [[nodiscard]] int last() const { return row_.back(); }

private:
    void count_borders(std::size_t place, int times) {
        for (const std::size_t border : {place, place + 1}) {
            if (border == 0 || border == row_.size() || row_[border - 1] == row_[border]) continue;
            borders_ += times;
            border_sum_ = times > 0 ? border_sum_ + border : border_sum_ - border;
        }
    }

    std::vector<int> row_;
    int borders_ = 0;
    std::size_t border_sum_ = 0;  // of their places
};

// The place of every column in the chain, -1 for those that are zero by COND3.
std::vector<int> places_in(const CertificateTerms& terms) {
    const std::vector<int>& chain = terms.certificate.chain;
    std::vector<int> place(terms.dimension, -1);
    for (std::size_t k = 0; k < chain.size(); ++k) {
        const int column = chain[k];
        if (column < 0 || column >= static_cast<int>(terms.dimension)) invalid("chain: unknown " + column_name(column));
        const auto c = static_cast<std::size_t>(column);
        if (place[c] >= 0) invalid("chain: " + column_name(column) + " twice");
        if (terms.contact[c] == 0 || terms.contact[c] != terms.contact[static_cast<std::size_t>(chain.front())])
            invalid("chain: " + column_name(column) + " has another weight in COND2");
        place[c] = static_cast<int>(k);
    }
    for (std::size_t c = 0; c < terms.dimension; ++c) {
        if (terms.signs[c] != Sign::zero && place[c] < 0)
            invalid("chain: " + column_name(static_cast<int>(c)) + " is missing");
        if (terms.signs[c] == Sign::zero && place[c] >= 0)
            invalid("chain: " + column_name(static_cast<int>(c)) + " is zero by COND3");
    }
    return place;
}

}  // namespace

bool is_simplex(const CertificateTerms& terms) {
    int sign = terms.certificate.gap_sign;
    for (std::size_t c = 0; c < terms.dimension; ++c) {
        if (terms.signs[c] == Sign::zero) continue;
        if (terms.signs[c] == Sign::free || terms.contact[c] == 0) return false;
        const int own = (terms.contact[c] > 0) == (terms.signs[c] == Sign::nonnegative) ? 1 : -1;
        if (sign == 0) sign = own;
        if (own != sign) return false;
    }
    return true;
}

void expect_chain(const CertificateTerms& terms) {
    const std::vector<int> place = places_in(terms);
    const std::size_t n = terms.certificate.chain.size();
    if (n == 0) invalid("chain: expected its columns, got none");
    // P_n = delta/w; with t its sign, t P_k >= 0 and t (P_n - P_k) >= 0 are wanted of every partial sum. Of a closed
    // gap P_n = 0, and both together say P_k = 0, whatever t is.
    const int weight = terms.contact[static_cast<std::size_t>(terms.certificate.chain.front())];
    const int t = terms.certificate.gap_sign * (weight > 0 ? 1 : -1) < 0 ? -1 : 1;
    std::vector<char> from_front(n), from_back(n);
    ChainRow row(n);
    terms.kernel.for_each_live(0, terms.certificate.pattern.free_steps - 1, [&](int, std::size_t column, int sign) {
        if (place[column] < 0) return;
        row.add(static_cast<std::size_t>(place[column]), sign);
        // COND1 says that this row is <= 0: a multiple of P_k, or of P_n - P_k.
        const std::size_t border = row.border();
        if (border == 0) return;
        if (t * row.first() < 0) from_front[border] = 1;
        if (t * row.last() < 0) from_back[border] = 1;
        if (terms.certificate.gap_sign != 0) return;
        if (row.first() > 0) from_back[border] = 1;  // P_k <= 0 is P_n - P_k >= 0
        if (row.last() > 0) from_front[border] = 1;
    });
    for (std::size_t k = 1; k < n; ++k) {
        if (from_front[k] == 0 || from_back[k] == 0)
            invalid("chain: COND1 does not bound the sum of its first " + std::to_string(k) + " columns");
    }
}

Rational proved_square(const CertificateTerms& terms) {
    // Shares w_c beta_c/delta that are >= 0 and add up to 1: the greatest sum of squares has one share alone.
    if (is_simplex(terms)) {
        int least = 0;
        for (std::size_t c = 0; c < terms.dimension; ++c) {
            if (terms.signs[c] == Sign::zero) continue;
            const int weight = std::abs(terms.contact[c]);
            least = least == 0 ? weight : std::min(least, weight);
        }
        if (least == 0) invalid("energy_bound: no column may differ from zero");
        return {1, Integer(least) * least};
    }
    // Steps of partial sums in [0, 1] from 0 to 1: a convex function is greatest where each is 0 or 1, and an odd
    // number of steps is not zero.
    expect_chain(terms);
    const auto n = static_cast<int>(terms.certificate.chain.size());
    const Integer weight = terms.contact[static_cast<std::size_t>(terms.certificate.chain.front())];
    return {n % 2 == 1 ? n : n - 1, weight * weight};
}

}  // namespace nsma
