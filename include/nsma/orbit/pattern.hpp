#pragma once

#include <vector>

namespace nsma {

/// One free flight and one contact phase per period, on a mesh of N cells.
/// Source: [1] Eq. (3). Valid when N, r, p >= 1.
struct Pattern {
    int cells = 1;          ///< N
    int free_steps = 1;     ///< r
    int contact_steps = 1;  ///< p

    [[nodiscard]] int period_steps() const { return free_steps + contact_steps; }  ///< n_T
    [[nodiscard]] int class_count() const;                                         ///< g = gcd(2N, n_T)
    [[nodiscard]] double frequency_ratio() const;                                  ///< omega/omega_1 = 4N/n_T
    [[nodiscard]] double period_ratio() const;                                     ///< T/tau = n_T/N

    /// The same N, r and p.
    bool operator==(const Pattern&) const = default;
};

/// Throws std::invalid_argument (name, expected, got) unless 1 <= N <= max_cells and r, p >= 1
/// and n_T <= max_period_steps.
void validate(const Pattern& pattern);

/// Largest n_T accepted by validate(), 10 million.
inline constexpr int max_period_steps = 10'000'000;

/// m = dim ker S_T in closed form, O(log N): with q = floor(r/g), s = r mod g,
/// m = g - s for even q and s for odd q. Source: [1] Eq. (4), solved by cycles.
[[nodiscard]] int kernel_dimension(const Pattern& pattern);

/// Every pattern with lo <= n_T <= hi in period steps and, if given, contact steps in
/// [contact_lo, contact_hi], ordered by n_T then r; those of trivial kernel included.
struct PatternRange {
    int period_lo = 2;                  ///< least n_T
    int period_hi = 2;                  ///< greatest n_T
    int contact_lo = 1;                 ///< least p
    int contact_hi = max_period_steps;  ///< greatest p
};
/// The patterns of a range on a mesh of N cells; empty where lo > hi. Throws std::invalid_argument unless
/// 1 <= N <= max_cells and period_hi <= max_period_steps.
[[nodiscard]] std::vector<Pattern> patterns_in(int cells, const PatternRange& range);

}  // namespace nsma
