#include "sweep_charts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "nsma/orbit/backbone.hpp"
#include "report/bar_text.hpp"
#include "report/one_line.hpp"
#include "report/results_folder.hpp"

namespace nsma {
namespace {

using Candidates = std::vector<const StoredOrbit*>;

constexpr double widest_ratio = 25;  // of energies: the least orbit would look flat beside a larger one

/// Of orbits sorted by energy the ones nearest to the ends and the middle of their range on a
/// logarithmic scale.
Candidates spread_by_energy(const Candidates& sorted) {
    if (sorted.size() <= 3) return sorted;
    const double lo = sorted.front()->energy;
    const double hi = std::min(sorted.back()->energy, widest_ratio * lo);
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
double distance(double a, double b) { return std::abs(std::log(a / b)); }

/// Of orbits sorted by energy the two levels of one pattern that are farthest apart and may still be seen beside each
/// other, and an orbit of least energy apart from both; empty where there are none.
Candidates two_levels_and_another(const Candidates& sorted) {
    std::map<std::pair<int, int>, Candidates> levels;
    for (const StoredOrbit* orbit : sorted) {
        const Pattern& pattern = orbit->orbit.kernel.pattern;
        if (orbit->level) levels[{pattern.free_steps, pattern.contact_steps}].push_back(orbit);
    }
    std::array<const StoredOrbit*, 2> pair{};
    double best = 1.0 + 1e-9;
    for (const auto& [steps, orbits] : levels) {
        std::size_t low = 0;
        for (const StoredOrbit* upper : orbits) {
            while (upper->energy > widest_ratio * orbits[low]->energy) ++low;
            const double ratio = upper->energy / orbits[low]->energy;
            if (ratio <= best) continue;
            best = ratio;
            pair = {orbits[low], upper};
        }
    }
    if (pair[0] == nullptr) return {};
    // Of the orbits of least energy in reach of the two, so that none looks flat.
    const double lo = pair[0]->energy / 2.0;
    const double hi = 2.0 * pair[1]->energy;
    const auto from_both = [&pair](const StoredOrbit* orbit) {
        return std::min(distance(orbit->energy, pair[0]->energy), distance(orbit->energy, pair[1]->energy));
    };
    const StoredOrbit* other = nullptr;
    for (const StoredOrbit* orbit : sorted) {
        if (orbit->level || orbit->orbit.kernel.pattern == pair[0]->orbit.kernel.pattern) continue;
        if (orbit->energy < lo || orbit->energy > hi) continue;
        if (other == nullptr || from_both(orbit) > from_both(other)) other = orbit;
    }
    if (other == nullptr) return {};
    Candidates chosen{pair[0], pair[1], other};
    std::stable_sort(chosen.begin(), chosen.end(), less_energy);
    return chosen;
}

std::string energy_text(const StoredOrbit& stored, const Bar& bar) {
    const char* const least = stored.level ? "" : "the least, ";
    const std::string joules = si_text(stored.energy * bar.energy_unit(), "J");
    if (bar.gap == 0) return least + joules;
    return fmt::format("{}{:.6g} E_g{}", least, stored.energy, is_unit_bar(bar) ? "" : " = " + joules);
}

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
    const std::string what = "orbits of mode k = " + std::to_string(lowest_mode.value_or(0));
    if (const auto chosen = two_levels_and_another(of_mode); !chosen.empty()) return {chosen, what};
    if (!of_mode.empty()) {
        return {spread_by_energy(least.size() >= 3 ? least : of_mode), what};
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

std::vector<Chart> sweep_charts(const StoredSweep& sweep) {
    const OrbitChoice choice = choose_orbits(sweep);
    if (choice.orbits.empty()) return {frequency_energy_chart(sweep, choice)};
    return {overview_chart(sweep, choice), frequency_energy_chart(sweep, choice),
            orbit_chart(sweep.scene, choice, "orbits"),
            space_time_chart(sweep.scene, *choice.orbits[choice.orbits.size() / 2], "space-time")};
}

std::vector<Chart> charts_of(const Scene& scene, const StoredOrbit& stored, const std::string& name) {
    const OrbitChoice choice{{&stored}, stored.level ? "one orbit" : "the orbit of least energy"};
    return {orbit_chart(scene, choice, name + "-motion"), space_time_chart(scene, stored, name + "-fields")};
}

std::vector<Chart> charts_of(const StoredSweep& sweep, const std::filesystem::path& folder, int free_steps,
                             int contact_steps, std::optional<double> level) {
    constexpr double same = 0.01;  // of two energies, relative: who types one rounds it
    const StoredOrbit* found = nullptr;
    std::string stored;
    for (const StoredOrbit& orbit : sweep.orbits) {
        const Pattern& pattern = orbit.orbit.kernel.pattern;
        if (pattern.free_steps != free_steps || pattern.contact_steps != contact_steps) continue;
        stored += (stored.empty() ? "" : ", ") + energy_text(orbit, sweep.scene.bar);
        if (orbit.level.has_value() != level.has_value()) continue;
        if (level && distance(*orbit.level, *level) > same) continue;
        if (found == nullptr || (level && distance(*orbit.level, *level) < distance(*found->level, *level)))
            found = &orbit;
    }
    if (found == nullptr) {
        const std::string got = stored.empty() ? "none of this pattern" : shortened("those at " + stored, 300);
        fail(folder, fmt::format("expected an orbit with r = {}, p = {}{}, got {}", free_steps, contact_steps,
                                 level ? fmt::format(" at E = {:g}", *level) : " of least energy", got));
    }
    const std::string energy = found->level ? fmt::format("-{:.6g}", *found->level) : std::string();
    return charts_of(sweep.scene, *found, fmt::format("orbit-{}-{}{}", free_steps, contact_steps, energy));
}

}  // namespace nsma
