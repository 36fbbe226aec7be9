#pragma once

#include <optional>
#include <random>

#include <Eigen/Core>

#include "nsma/set/admissible_set.hpp"

namespace nsma {

/// Where the segment between two points reaches the sphere |x|^2 = square: from inside (or on it) to
/// outside; no cancellation where `from` is close to it.
[[nodiscard]] Eigen::VectorXd crossing(const Eigen::VectorXd& from, const Eigen::VectorXd& to, double square);

/// Exponential weights are uniform over mixtures; drawn from raw bits so that every standard library gives the same.
[[nodiscard]] double random_weight(std::mt19937_64& generator);

/// Points of an admissible set at one energy level, without a solver: between two admissible
/// points the energy is a quadratic, so a segment from below the level to above it crosses it
/// exactly, and convexity keeps the crossing admissible.
class LevelPoints {
public:
    /// The set must be nonempty, with its vertices, and outlive this object; level > 0.
    LevelPoints(const AdmissibleSet& set, double level);

    /// Start number k >= 0, feasible on the level: toward each vertex above it, the greatest energy first, then toward
    /// fixed-seed random mixtures. Absent when the level is not attainable.
    [[nodiscard]] std::optional<Eigen::VectorXd> start(int k) const;

    /// Number of vertices above the level: it may cut the set into as many pieces, each with optima of its own.
    [[nodiscard]] int pieces() const;

    /// The admissible point on the level that a segment from `gamma` (admissible) reaches.
    [[nodiscard]] std::optional<Eigen::VectorXd> reach(const Eigen::VectorXd& gamma) const;

    /// An admissible point near one that may be off: into the bounds, onto COND2, then toward an inner point until no
    /// row is crossed.
    [[nodiscard]] Eigen::VectorXd admissible_near(Eigen::VectorXd gamma) const;
    /// ... and on the level.
    [[nodiscard]] std::optional<Eigen::VectorXd> restored(const Eigen::VectorXd& gamma) const {
        return reach(admissible_near(gamma));
    }

private:
    [[nodiscard]] Eigen::VectorXd mixture(int seed) const;

    const AdmissibleSet& set_;
    double level_;
    Eigen::VectorXd base_;    // the least-energy point; the rest state for a closed gap
    Eigen::VectorXd centre_;  // away from the rows that can be away from equality
};

}  // namespace nsma
