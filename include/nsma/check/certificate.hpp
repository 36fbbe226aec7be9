#pragma once

#include <optional>
#include <string>
#include <vector>

#include "nsma/orbit/pattern_kind.hpp"
#include "nsma/numerics/exact.hpp"

namespace nsma {

/// That no orbit of a `contact` or `stuck` pattern at one energy has less than `bound` of an objective, and an orbit
/// that nearly has it. Objectives as reported (nondimensional).
struct Optimum {
    /// The smoothest orbit, the least of the largest contact forces, or the orbit nearest to `reference`.
    enum class Of { least_shock, least_force, nearest };
    Of objective = Of::least_shock;  ///< what is least
    Rational energy;                 ///< E/E_unit asked
    Rational bound;                  ///< no orbit at that energy has less
    RationalVector orbit;            ///< beta, admissible
    Rational value;                  ///< of the orbit, at most
    Rational energy_error;           ///< |E(orbit) - energy|/energy, at most
    int window = 0;                  ///< least shock: columns in a row that a best orbit covers
    Rational multiplier;             ///< least shock, nearest: of the energy, see data/optima.md
    Rational level;                  ///< nearest: of COND2
    RationalVector reference;        ///< nearest: beta of the orbit to stay near
};

/// (value - bound)/value, of `nearest` over the energy: how far the orbit may be from the best.
[[nodiscard]] double relative_gap(const Optimum& optimum);

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

    /// gap != 0: (n, y_n >= 0) of the COND1 rows a_n, a_n . beta = sum_{k<n} eps_k beta <= 0, that a projection takes.
    /// With rho the projection of delta w - sum y_n a_n on COND3's cone (w = x_0: COND2's row), rho = 0 proves
    /// emptiness (a Farkas vector); else beta = rho/|rho|^2 is the least-energy point.
    RationalVector projection;
    /// Closed gap, empty: step of a COND1 row that COND3 lets have terms >= 0 only, so that every column is zero.
    std::optional<int> forcing_row;
    /// Closed gap, nonempty: a nonzero admissible direction.
    RationalVector ray;
    /// gap != 0: an admissible point of the greatest energy known.
    RationalVector greatest;
    /// Where COND3 does not bound the columns: their order in which COND1 has a row of each partial sum from either
    /// end. They lie between 0 and delta/w, so |beta|^2 is greatest where they change all the time; of a closed gap
    /// they are all zero.
    std::vector<int> chain;

    std::optional<Optimum> optimum;  ///< at one energy

    std::optional<Rational> energy_least;     ///< E_min/E_unit claimed
    std::optional<Rational> energy_attained;  ///< E/E_unit claimed of `greatest`
    std::optional<Rational> energy_bound;     ///< claimed upper bound on E/E_unit
};

/// Verdict of the exact checker.
struct CheckResult {
    bool valid = false;  ///< every claim holds
    std::string reason;  ///< one line; of an invalid certificate: the row that fails
};

/// What orbit, window and multiplier of an optimum prove, exactly, whatever is claimed of them.
struct OptimumFacts {
    std::string reason;  ///< why nothing is proved, one line; empty where the rest holds
    Rational energy;     ///< E/E_unit of the orbit
    Rational value;      ///< objective of the orbit
    Rational bound;      ///< no orbit at the energy asked has less; of least_force the bound claimed, which is proved
};
/// Of the optimum of a certificate, which must have one.
[[nodiscard]] OptimumFacts optimum_facts(const Certificate& certificate);

/// Re-verifies a certificate from its four integers, in integers and fractions only: no solver,
/// no floating point, nothing taken from the program that wrote it. Never throws on a wrong
/// certificate.
[[nodiscard]] CheckResult check(const Certificate& certificate);

}  // namespace nsma
