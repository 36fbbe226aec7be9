#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/chart.hpp"
#include "report/sweep/sweep_export.hpp"

namespace nsma {

/// Orbits worth drawing, which the charts call I, II, III.
struct OrbitChoice {
    std::vector<const StoredOrbit*> orbits;  ///< by increasing energy, at most three
    std::string what;                        ///< e.g. "orbits of mode k = 1"
};
/// Of the lowest nonsmooth mode one orbit of least energy and two solved levels of one pattern, or, where no pattern
/// has two, three well-separated energies; without a mode one orbit of each of the three lowest frequencies.
[[nodiscard]] OrbitChoice choose_orbits(const StoredSweep& sweep);

/// Frequency against energy: exact backbones beneath, linear frequencies dashed, single orbits
/// as points, energy intervals as lines (an arrow when unbounded), solved levels and the orbits drawn marked.
[[nodiscard]] Chart frequency_energy_chart(const StoredSweep& sweep, const OrbitChoice& choice);

/// Tip displacement of the orbits beside the diagram on which they are marked, as in Fig. 2 of [1].
[[nodiscard]] Chart overview_chart(const StoredSweep& sweep, const OrbitChoice& choice);

/// Tip displacement over two periods with the wall drawn; contact force on the same time axis.
/// `name` is that of its files.
[[nodiscard]] Chart orbit_chart(const Scene& scene, const OrbitChoice& choice, const std::string& name);

/// Stress and velocity over bar and time for one period, with the contact phase marked at the wall. The waves
/// are drawn where they are exactly, at several samples a cell.
[[nodiscard]] Chart space_time_chart(const Scene& scene, const StoredOrbit& stored, const std::string& name);

/// All charts of a sweep; without an orbit the diagram alone.
[[nodiscard]] std::vector<Chart> sweep_charts(const StoredSweep& sweep);

/// Motion and fields of one orbit, files NAME-motion and NAME-fields.
[[nodiscard]] std::vector<Chart> charts_of(const Scene& scene, const StoredOrbit& stored, const std::string& name);

/// Those of one orbit of a sweep: its least-energy orbit without a level (energy units), else the one at that level, to
/// 1 %. Throws InputError, which names the folder and the pattern's orbits, where the sweep has none.
[[nodiscard]] std::vector<Chart> charts_of(const StoredSweep& sweep, const std::filesystem::path& folder,
                                           int free_steps, int contact_steps, std::optional<double> level);

}  // namespace nsma
