#include "sweep_charts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "nsma/orbit/backbone.hpp"
#include "report/results_folder.hpp"

namespace nsma {
namespace {

using Candidates = std::vector<const StoredOrbit*>;

/// Of orbits sorted by energy the ones nearest to the ends and the middle of their range on a
/// logarithmic scale; above 25 times the least energy the others would look flat beside it.
Candidates spread_by_energy(const Candidates& sorted) {
    if (sorted.size() <= 3) return sorted;
    const double lo = sorted.front()->energy;
    const double hi = std::min(sorted.back()->energy, 25.0 * lo);
    Candidates chosen;
    for (const double target : {lo, std::sqrt(lo * hi), hi}) {
        const auto nearest = std::min_element(sorted.begin(), sorted.end(), [&](const auto* a, const auto* b) {
            return std::abs(std::log(a->energy / target)) < std::abs(std::log(b->energy / target));
        });
        if (std::find(chosen.begin(), chosen.end(), *nearest) == chosen.end()) chosen.push_back(*nearest);
    }
    return chosen;
}

int period_steps(const StoredOrbit* stored) { return stored->orbit.kernel.pattern.period_steps(); }
bool less_energy(const StoredOrbit* a, const StoredOrbit* b) { return a->energy < b->energy; }

}  // namespace

OrbitChoice choose_orbits(const StoredSweep& sweep) {
    std::optional<int> lowest_mode;
    Candidates all, of_mode, least;
    for (const StoredOrbit& orbit : sweep.orbits) {
        const auto mode = mode_of(orbit.orbit.kernel.pattern);
        if (mode && (!lowest_mode || *mode < *lowest_mode)) lowest_mode = mode;
        if (orbit.energy > 0.0) all.push_back(&orbit);
    }
    std::stable_sort(all.begin(), all.end(), less_energy);
    for (const StoredOrbit* orbit : all) {
        if (!lowest_mode || mode_of(orbit->orbit.kernel.pattern) != lowest_mode) continue;
        of_mode.push_back(orbit);
        if (!orbit->level) least.push_back(orbit);
    }
    if (!of_mode.empty()) {
        return {spread_by_energy(least.size() >= 3 ? least : of_mode),
                "orbits of mode k = " + std::to_string(*lowest_mode)};
    }
    // No mode at all: of each of the three lowest frequencies its least-energy orbit.
    std::stable_sort(all.begin(), all.end(),
                     [](const auto* a, const auto* b) { return period_steps(a) > period_steps(b); });
    const auto same = [](const auto* a, const auto* b) { return period_steps(a) == period_steps(b); };
    all.erase(std::unique(all.begin(), all.end(), same), all.end());
    if (all.size() > 3) all.resize(3);
    std::stable_sort(all.begin(), all.end(), less_energy);
    return {all, "orbits of the lowest frequencies"};
}

DrawnCharts draw_sweep(const std::filesystem::path& sweep_folder) {
    const StoredSweep sweep = read_sweep_folder(sweep_folder);
    const OrbitChoice choice = choose_orbits(sweep);
    std::vector<Chart> charts{frequency_energy_chart(sweep)};
    DrawnCharts drawn;
    if (choice.orbits.empty()) {
        drawn.skipped = {"orbits: no orbit is stored", "space-time: no orbit is stored"};
    } else {
        charts.push_back(orbit_chart(sweep.scene, choice));
        charts.push_back(space_time_chart(sweep.scene, *choice.orbits[choice.orbits.size() / 2]));
    }
    drawn.pictures = draw_charts(charts, sweep_folder / "charts");
    return drawn;
}

DrawnCharts draw_orbit(const StoredSweep& sweep, const std::filesystem::path& sweep_folder, int free_steps,
                       int contact_steps, std::optional<double> level) {
    const StoredOrbit* found = nullptr;
    const auto distance = [&](const StoredOrbit& orbit) { return std::abs(std::log(*orbit.level / *level)); };
    for (const StoredOrbit& orbit : sweep.orbits) {
        const Pattern& pattern = orbit.orbit.kernel.pattern;
        if (pattern.free_steps != free_steps || pattern.contact_steps != contact_steps) continue;
        if (orbit.level.has_value() != level.has_value()) continue;
        if (found == nullptr || (level && distance(orbit) < distance(*found))) found = &orbit;
    }
    if (found == nullptr) {
        fail(sweep_folder, fmt::format("expected an orbit with r = {}, p = {}{}, got none in this sweep", free_steps,
                                       contact_steps, level ? " at a level" : ""));
    }
    const std::string energy = found->level ? fmt::format("-{:.6g}", *found->level) : std::string();
    const std::string name = fmt::format("orbit-{}-{}{}", free_steps, contact_steps, energy);
    return {draw_charts(charts_of(sweep.scene, *found, name), sweep_folder / "charts"), {}};
}

}  // namespace nsma
