#pragma once

#include <optional>
#include <string>
#include <vector>

#include "nsma/orbit/pattern_kind.hpp"
#include "nsma/numerics/exact.hpp"

namespace nsma {

/// Sum of constraints: sum_n y_n a_n + nu w over the columns of alpha, where a_n is the COND1
/// row sum_{k<n} eps_k beta (<= 0, 1 <= n < r, y_n >= 0) and w = x_0 is COND2's row (= delta).
struct RowCombination {
    RationalVector rows;  ///< (n, y_n)
    Rational contact;     ///< nu, any sign
};

/// Proof that f . beta <= value for one linear form over the admissible set: f minus the
/// combination has no positive part that COND3 allows, so value = nu delta.
struct FormBound {
    RationalVector form;   ///< (column, coefficient)
    RowCombination proof;  ///< y and nu
};

/// Upper bound on |beta|^2 over the admissible set: columns in this order with partial sums s_k of w_c beta_c/delta,
/// 0 = s_0, s_n = 1, and bounds of s_k (forms s_k, then -s_k, k = 1..n-1). A convex sum over steps is greatest where
/// each s_k is at a bound, which dynamic programming decides.
struct GreatestProof {
    std::vector<int> chain;               ///< columns in the order of the partial sums
    std::vector<FormBound> chain_bounds;  ///< 2 (n - 1) of them
};

/// Everything needed to believe the verdict on one pattern, as exact numbers. The four integers
/// (N, r, p, sign d) and this are enough: see check().
struct Certificate {
    Pattern pattern;   ///< (N, r, p)
    int gap_sign = 1;  ///< delta
    /// What is claimed of the pattern: `trivial` m = 0, `empty` no orbit but rest, `nonempty` an orbit.
    enum class Claim { trivial, empty, nonempty };
    Claim claim = Claim::trivial;  ///< proved by what follows
    /// Nonempty: `contact` where the point of least energy (closed gap: the ray) presses and leaves the wall, `free`
    /// where no column has a contact step, `stuck` where none has a free one.
    std::optional<PatternKind> kind;

    /// gap != 0: y of the projection rho of delta w on the cone of COND1 and COND3. rho = 0
    /// proves emptiness (a Farkas vector); else beta = rho/|rho|^2 is the least-energy point.
    RationalVector projection;
    /// Closed gap, empty: forms proved <= 0 that together leave only beta = 0.
    std::vector<FormBound> rest;
    /// Closed gap, nonempty: a nonzero admissible direction.
    RationalVector ray;
    /// gap != 0: an admissible point of the greatest energy known, and the bound.
    RationalVector greatest;
    GreatestProof greatest_proof;  ///< why no energy exceeds `energy_bound`

    std::optional<Rational> energy_least;     ///< E_min/E_unit claimed
    std::optional<Rational> energy_attained;  ///< E/E_unit claimed of `greatest`
    std::optional<Rational> energy_bound;     ///< claimed upper bound on E/E_unit
};

/// Verdict of the exact checker.
struct CheckResult {
    bool valid = false;  ///< every claim holds
    std::string reason;  ///< one line; of an invalid certificate: the row that fails
};

/// Re-verifies a certificate from its four integers, in integers and fractions only: no solver,
/// no floating point, nothing taken from the program that wrote it. Never throws on a wrong
/// certificate.
[[nodiscard]] CheckResult check(const Certificate& certificate);

/// The bound on E/E_unit that `greatest_proof` gives by itself, verified; absent when the proof
/// does not hold.
[[nodiscard]] std::optional<Rational> proved_energy_bound(const Certificate& certificate);

}  // namespace nsma
