#pragma once

#include <numeric>
#include <optional>
#include <vector>

#include "nsma/orbit/pattern.hpp"
#include "nsma/check/certificate.hpp"

/// The conditions of a pattern written down once more from the scheme alone, in integers and
/// fractions: nothing of the library but its types.
namespace literal {

using nsma::Integer;
using nsma::Pattern;
using nsma::Rational;

struct Problem {
    Pattern pattern;
    int gap_sign = 1;
    int period = 0;
    std::vector<int> sign;    ///< eps_n, n = 0..n_T-1
    std::vector<int> column;  ///< column of beta that step n carries, -1: none
    int dimension = 0;

    /// b_n for any n >= 0.
    [[nodiscard]] Rational wave(const std::vector<Rational>& beta, int n) const {
        const auto k = static_cast<std::size_t>(n % period);
        return column[k] < 0 ? Rational(0) : Rational(sign[k] * beta[static_cast<std::size_t>(column[k])]);
    }
    /// x_n = -sum_{k=n}^{n+2N-1} b_k.
    [[nodiscard]] Rational tip(const std::vector<Rational>& beta, int n) const {
        Rational sum;
        for (int k = n; k < n + 2 * pattern.cells; ++k) sum -= wave(beta, k);
        return sum;
    }
    /// First step whose condition fails, with `offset` on the right of COND1 and COND2 (the gap,
    /// or 0 for a direction).
    [[nodiscard]] std::optional<int> failing_step(const std::vector<Rational>& beta, int offset) const {
        for (int n = 0; n <= period; ++n) {
            const Rational x = tip(beta, n);
            const bool contact = n == 0 || n >= pattern.free_steps;
            if (contact ? x != offset : x > offset) return n;
            if (n >= pattern.free_steps && n < period && wave(beta, n) < 0) return n;
        }
        return std::nullopt;
    }
    /// E/E_unit: 2N sum over the window of b^2.
    [[nodiscard]] Rational energy(const std::vector<Rational>& beta) const {
        Rational sum;
        for (int k = 0; k < 2 * pattern.cells; ++k) sum += wave(beta, k) * wave(beta, k);
        return 2 * pattern.cells * sum;
    }
};

/// b_{n+2N} = -b_n where step n is free, +b_n where it is in contact, period n_T: an amplitude for
/// each residue class whose signs close up.
inline Problem problem(const Pattern& pattern, int gap_sign) {
    Problem result{pattern, gap_sign, pattern.free_steps + pattern.contact_steps, {}, {}, 0};
    const int classes = std::gcd(2 * pattern.cells, result.period);
    result.sign.assign(static_cast<std::size_t>(result.period), 0);
    result.column.assign(static_cast<std::size_t>(result.period), -1);
    for (int c = 0; c < classes; ++c) {
        int flips = 0;
        for (int n = c; n < result.period; n += classes) flips += n < pattern.free_steps ? 1 : 0;
        if (flips % 2 != 0) continue;
        int value = 1;
        int n = c;
        for (int k = 0; k < result.period / classes; ++k) {
            result.sign[static_cast<std::size_t>(n)] = value;
            result.column[static_cast<std::size_t>(n)] = result.dimension;
            if (n < pattern.free_steps) value = -value;
            n = (n + 2 * pattern.cells) % result.period;
        }
        ++result.dimension;
    }
    return result;
}

inline std::vector<Rational> dense(const nsma::RationalVector& sparse, int size) {
    std::vector<Rational> result(static_cast<std::size_t>(size));
    for (const auto& [index, value] : sparse) result.at(static_cast<std::size_t>(index)) = value;
    return result;
}

/// The row x_n - x_0 over beta.
inline std::vector<Rational> rise(const Problem& problem, int n) {
    std::vector<Rational> row(static_cast<std::size_t>(problem.dimension));
    for (std::size_t c = 0; c < row.size(); ++c) {
        std::vector<Rational> unit(row.size());
        unit[c] = 1;
        row[c] = problem.tip(unit, n) - problem.tip(unit, 0);
    }
    return row;
}

}  // namespace literal
