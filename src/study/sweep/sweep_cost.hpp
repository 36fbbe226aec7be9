#pragma once

#include <cstdint>
#include <vector>

#include "nsma/orbit/sieve.hpp"
#include "nsma/search/orbit_solver.hpp"
#include "nsma/study/scene.hpp"

namespace nsma {

/// What the patterns of a sweep will take, known before any of them is decided: the sieve tells which have orbits, and
/// between which energies. In microseconds of one machine; only ratios count.
class SweepCost {
public:
    SweepCost(const Scene& scene, const OrbitSolverOptions& options);

    struct Cost {
        std::int64_t verdict = 0;
        std::int64_t inside = 0;   ///< of one level inside the interval
        std::int64_t outside = 0;  ///< of one outside
        std::int64_t answers = 0;  ///< of all levels
    };
    /// Patterns of one n_T in a row cost O(1) each.
    [[nodiscard]] Cost operator()(const Pattern& pattern);

private:
    Sieve sieve_;
    OrbitSolverOptions options_;
    Objective objective_;
    bool all_kinds_;
    std::vector<double> levels_;  // in ascending order
};

}  // namespace nsma
