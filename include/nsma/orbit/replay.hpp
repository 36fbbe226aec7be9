#pragma once

#include <optional>

#include "nsma/wave/marcher.hpp"
#include "nsma/orbit/orbit.hpp"

namespace nsma {

/// Relative violations of an orbit, all >= 0, recomputed from Q0 by stepping waves.
struct Violations {
    double periodicity = 0.0;  ///< ||Q_nT - Q_0|| / ||Q_0||, energy norm
    double cond1 = 0.0;        ///< max (x_n - d)+ over the free flight / displacement scale
    double cond2 = 0.0;        ///< max |x_n - d| over the contact phase / displacement scale
    /// max (lambda_n)+ / largest |lambda|; where the orbit has no force (below 1e-12 of what its
    /// largest wave could exert) / 2 z S max|b|, so that noise is not divided by noise.
    double cond3 = 0.0;
    double energy = 0.0;  ///< |E/E_unit - level| / level; 0 when no level is asked

    [[nodiscard]] double worst() const;  ///< the largest of them
};

/// Verdict of the independent marcher on an orbit.
struct Replay {
    Violations violations;     ///< of the labelled schedule, energy against the level asked
    MarchReport march;         ///< what the marcher saw, its own decisions
    bool same_labels = false;  ///< contact seen exactly in the labelled steps, silent ones aside
    bool accepted = false;     ///< worst violation, march defect <= tolerance and same_labels
};

/// Default bound on every relative violation of an accepted orbit.
inline constexpr double replay_tolerance = 1e-9;

/// Replays Q0 twice: with the labelled schedule (r free, p contact steps), which measures each
/// condition, and with the marcher, which decides contact by itself. Displacement scale: |d|, or
/// for a closed gap the largest |x_n|. Throws std::invalid_argument unless level > 0, periods >= 1
/// and tolerance >= 0.
[[nodiscard]] Replay replay(const Orbit& orbit, std::optional<double> level = std::nullopt, int periods = 1,
                            double tolerance = replay_tolerance);

}  // namespace nsma
