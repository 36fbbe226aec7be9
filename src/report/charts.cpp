#include "charts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "nsma/orbit/backbone.hpp"

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

void sort_by_energy(Candidates& orbits) {
    std::stable_sort(orbits.begin(), orbits.end(), [](const auto* a, const auto* b) { return a->energy < b->energy; });
}

}  // namespace

OrbitChoice choose_orbits(const StoredSweep& sweep) {
    int lowest_mode = 0;  // none
    for (const StoredOrbit& orbit : sweep.orbits) {
        const int mode = mode_of(orbit.orbit.kernel.pattern).value_or(0);
        if (mode > 0 && (lowest_mode == 0 || mode < lowest_mode)) lowest_mode = mode;
    }
    Candidates least, any, others;
    for (const StoredOrbit& orbit : sweep.orbits) {
        if (!(orbit.energy > 0.0)) continue;
        const bool of_mode = mode_of(orbit.orbit.kernel.pattern).value_or(-1) == lowest_mode;
        if (of_mode && !orbit.level) least.push_back(&orbit);
        if (of_mode) any.push_back(&orbit);
        others.push_back(&orbit);
    }
    Candidates& of_mode = least.size() >= 3 ? least : any;
    if (!of_mode.empty()) {
        sort_by_energy(of_mode);
        return {spread_by_energy(of_mode), "orbits of mode k = " + std::to_string(lowest_mode)};
    }
    // No mode at all: of each of the three lowest frequencies its least-energy orbit.
    std::stable_sort(others.begin(), others.end(), [](const auto* a, const auto* b) {
        const int period_a = a->orbit.kernel.pattern.period_steps();
        const int period_b = b->orbit.kernel.pattern.period_steps();
        return period_a != period_b ? period_a > period_b : a->energy < b->energy;
    });
    Candidates chosen;
    for (const StoredOrbit* orbit : others) {
        const int period = orbit->orbit.kernel.pattern.period_steps();
        if (chosen.size() < 3 && (chosen.empty() || chosen.back()->orbit.kernel.pattern.period_steps() != period)) {
            chosen.push_back(orbit);
        }
    }
    sort_by_energy(chosen);
    return {chosen, "orbits of the lowest frequencies"};
}

DrawnCharts draw_charts(const std::filesystem::path& sweep_folder) {
    const StoredSweep sweep = read_sweep_folder(sweep_folder);
    const std::filesystem::path folder = sweep_folder / "charts";
    DrawnCharts drawn;
    const auto draw = [&](const Chart& chart) {
        draw_chart(chart, folder);
        drawn.pictures.push_back(folder / (chart.name + ".svg"));
        drawn.pictures.push_back(folder / (chart.name + ".png"));
    };
    draw(frequency_energy_chart(sweep));
    const OrbitChoice choice = choose_orbits(sweep);
    if (choice.orbits.empty()) {
        drawn.skipped = {"orbits: no orbit is stored", "space-time: no orbit is stored"};
        return drawn;
    }
    draw(orbit_chart(sweep, choice));
    draw(space_time_chart(sweep, *choice.orbits[choice.orbits.size() / 2]));
    return drawn;
}

}  // namespace nsma
