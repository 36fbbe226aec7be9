#pragma once

#include <string>
#include <vector>

#include "nsma/study/scene.hpp"

namespace nsma {

/// Whether length, modulus, density and area are all one: a bar without units, shown in units of tau and d.
[[nodiscard]] bool is_unit_bar(const Bar& bar);

/// A value with the SI prefix that suits it: "98.2 µs".
[[nodiscard]] std::string si_text(double value, const std::string& unit);

/// What follows from bar and mesh, one line: wave speed, travel time, first linear frequency, energy unit, gap over
/// length and, where the scene asks for a mode, the number of its frequencies on this mesh.
[[nodiscard]] std::string derived_text(const Scene& scene);

/// A line for everything that no bar is likely to have: strains over 1 %, stresses that no solid bears, sound slower or
/// faster than in any solid. None for the bar of unit length, density, area and modulus.
[[nodiscard]] std::vector<std::string> doubts(const Scene& scene);

}  // namespace nsma
