#pragma once

#include <string>

#include "sweep_charts.hpp"
#include "report/orbit_units.hpp"

namespace nsma {

inline constexpr int periods_shown = 2;

/// What tells an orbit in a key: energy, frequency or period, steps.
[[nodiscard]] std::string orbit_label(const StoredOrbit& stored);

/// What the axes of the orbits must show, in SI units.
struct Extent {
    double force = 0;
    double tip = 0;
    double lowest = 0;  ///< tip displacement
    double period = 0;  ///< T/tau
};
[[nodiscard]] Extent extent_of(const OrbitChoice& choice, const Bar& bar);

/// "I", "II", "III"
[[nodiscard]] const char* roman(std::size_t place);

/// A row of an orbit's block: time, value and, where a mark stands, the value again.
[[nodiscard]] std::string orbit_row(double time, double value, bool marked);
/// Draws such a block, of the orbit at this place of a choice, as a line with its marks.
void draw_orbit(Panel& panel, const std::string& block, std::size_t place);

/// Panel settings that shade the contact phases of one orbit; the label stands in the first.
[[nodiscard]] std::string contact_shade(const Orbit& orbit, const Units& units, bool label);

/// The tips of the orbits over two periods in a frame, a key below; their blocks are added to the chart.
[[nodiscard]] Panel tip_panel(Chart& chart, const Scene& scene, const OrbitChoice& choice, const Frame& frame);

}  // namespace nsma
