#pragma once

#include <cstdint>
#include <vector>

#include "nsma/orbit/pattern.hpp"

namespace nsma {

/// Which argument in integers decided a pattern.
enum class Finding : std::uint8_t {
    trivial,        ///< m = 0: every class is dead
    sign_conflict,  ///< COND3 bounds every live class from both sides
    wrong_side,     ///< COND2's row has the wrong sign or is zero where COND3 allows amplitudes
    penetrates,     ///< a COND1 row is positive for every motion COND3 allows
    admissible      ///< some motion meets COND1-3
};

/// What the sieve says of one pattern.
struct Sieved {
    Finding finding = Finding::trivial;  ///< what decided
    int kernel_dimension = 0;            ///< m
    double energy_least = 0;             ///< E_min/E_g, a quotient of integers; 0 unless admissible and gap != 0
    double energy_greatest = 0;          ///< E_max/E_g, likewise
    bool unbounded = false;              ///< admissible at a closed gap: a cone
};

/// Verdicts on COND1-3 without a linear program. The classes mod g = gcd(2N, n_T) all walk the
/// same cycle of c = n_T/g places by steps of 2N/g, and the live ones all have the same even
/// number f of free places, so one walk decides a pattern. By the three gap theorem the contact
/// places return after two waits a, b or after a, b and a + b; COND3 has no conflict only when
/// there are two and both are odd, which Euclid's algorithm lists for all f at once.
/// With contact places COND1-3 then are the simplex {gamma >= 0, |w| sum gamma = 1} or empty;
/// without (f = c) they are 0 >= P_k >= P_m = -1 for the partial sums P_k of beta.
/// Patterns of one n_T in a row cost O(1) each; nothing is allocated for a pattern.
class Sieve {
public:
    /// Throws std::invalid_argument unless 1 <= cells <= max_cells and gap_sign is -1, 0 or 1.
    Sieve(int cells, int gap_sign);

    /// The pattern's free and contact steps; both >= 1, their sum at most max_period_steps.
    [[nodiscard]] Sieved operator()(int free_steps, int contact_steps);

private:
    struct Place {
        Finding finding = Finding::sign_conflict;
        bool walked = true;       // false: two waits, both odd, and not yet decided
        std::int32_t weight = 0;  // |w|
    };
    void prepare(int period_steps);
    [[nodiscard]] Place walk(int free_places);

    int cells_;
    int gap_sign_;
    int period_ = 0;                 // n_T that the table is for
    int classes_ = 1;                // g
    int places_ = 1;                 // c
    int step_ = 0;                   // 2N/g mod c
    std::vector<Place> of_free_;     // by f = 0..c
    std::vector<std::int8_t> sign_;  // eps by place
};

}  // namespace nsma
