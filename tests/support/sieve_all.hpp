#pragma once

#include <array>
#include <numeric>

#include "nsma/orbit/sieve.hpp"

/// How many patterns each argument decided.
struct SieveCounts {
    std::array<long, 5> of{};  ///< by Finding
    [[nodiscard]] long operator[](nsma::Finding finding) const { return of.at(static_cast<std::size_t>(finding)); }
    [[nodiscard]] long patterns() const { return std::accumulate(of.begin(), of.end(), 0L); }
};

/// Over all n_T <= period.
inline SieveCounts sieve_all(int cells, int gap_sign, int period) {
    nsma::Sieve sieve(cells, gap_sign);
    SieveCounts counts;
    for (int steps = 2; steps <= period; ++steps) {
        for (int free = 1; free < steps; ++free) {
            ++counts.of.at(static_cast<std::size_t>(sieve(free, steps - free).finding));
        }
    }
    return counts;
}
