#pragma once

#include <string>
#include <string_view>

namespace nsma {

/// A gnuplot string in single quotes; meant for `noenhanced` text.
[[nodiscard]] std::string gnuplot_text(std::string_view text);

/// The unit with the SI prefix that brings `largest` into 1..1000, and the factor that turns
/// base units into it: 2.1e9, "Pa" -> {1e-9, "GPa"}.
struct ScaledUnit {
    double factor = 1.0;
    std::string unit;
};
[[nodiscard]] ScaledUnit scaled_unit(double largest, const std::string& unit);

}  // namespace nsma
