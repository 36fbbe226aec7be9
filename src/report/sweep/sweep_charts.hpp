#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/chart.hpp"
#include "report/sweep/sweep_export.hpp"

namespace nsma {

/// Frequency against energy: exact backbones beneath, linear frequencies dashed, single orbits
/// as points, energy intervals as lines (an arrow when unbounded), solved levels marked.
[[nodiscard]] Chart frequency_energy_chart(const StoredSweep& sweep);

/// Orbits worth drawing: three well-separated energies of the lowest nonsmooth mode or, without
/// any, one orbit of each of the three lowest frequencies; least-energy orbits are preferred.
struct OrbitChoice {
    std::vector<const StoredOrbit*> orbits;  ///< by increasing energy, at most three
    std::string what;                        ///< e.g. "orbits of mode k = 1"
};
[[nodiscard]] OrbitChoice choose_orbits(const StoredSweep& sweep);

/// Tip displacement over one period with the wall drawn; contact force on the same time axis.
/// `name` is that of its files.
[[nodiscard]] Chart orbit_chart(const Scene& scene, const OrbitChoice& choice, const std::string& name = "orbits");

/// Stress over bar and time for one period, with the contact phase marked at the wall. The waves
/// are drawn where they are exactly, at several samples a cell.
[[nodiscard]] Chart space_time_chart(const Scene& scene, const StoredOrbit& stored,
                                     const std::string& name = "space-time");

/// Motion and stress of one orbit, files NAME-motion and NAME-stress.
[[nodiscard]] std::vector<Chart> charts_of(const Scene& scene, const StoredOrbit& stored, const std::string& name);

/// Draws every chart of a stored sweep into folder/charts.
struct DrawnCharts {
    std::vector<std::filesystem::path> pictures;  ///< the SVG and PNG files
    std::vector<std::string> skipped;             ///< one line a chart that had nothing to show
};
[[nodiscard]] DrawnCharts draw_sweep(const std::filesystem::path& sweep_folder);

/// Draws one orbit of a sweep into folder/charts: its least-energy orbit without a level (energy units), else the one
/// at the nearest level. Throws InputError where the sweep has none of this pattern.
[[nodiscard]] DrawnCharts draw_orbit(const StoredSweep& sweep, const std::filesystem::path& sweep_folder,
                                     int free_steps, int contact_steps, std::optional<double> level);

}  // namespace nsma
