#pragma once

#include <optional>
#include <string>

#include "sensitivity_folder.hpp"
#include "report/chart.hpp"

namespace nsma {

/// How much there is to see under x_1(t): rows that save at least a tenth of what the most telling
/// one saves, those in flight counted thrice.
[[nodiscard]] int binding_rows(const OptimumRecord& optimum);
/// Where in the motion the wall decides: x_1(t) above, what relaxing each row saves below.
[[nodiscard]] Chart binding_chart(const Scene& scene, const OptimumRecord& optimum);

/// E_min of one pattern under each relaxation and, given its optimum at the level of the curves,
/// the objective; the tangents at zero that the multipliers predict dotted.
[[nodiscard]] Chart relaxation_chart(const Scene& scene, const SensitivityRecords& records,
                                     const IntervalRecord& interval, const OptimumRecord* optimum);
/// Number of admissible patterns under each relaxation.
[[nodiscard]] Chart count_chart(const Scene& scene, const SensitivityRecords& records);
/// Patterns left after each condition, in every order.
[[nodiscard]] Chart funnel_chart(const Scene& scene, const SensitivityRecords& records);

/// Those of these charts that the records can show.
[[nodiscard]] std::vector<Chart> sensitivity_charts(const Scene& scene, const SensitivityRecords& records);

/// Derivative of an objective with respect to a parameter that is raised, where it has a price.
[[nodiscard]] std::optional<double> right_slope(const std::vector<Price>& prices, Parameter parameter);
/// "N = 20, r = 60, p = 10"
[[nodiscard]] std::string text_of(const Pattern& pattern);
/// "E = 12.6 E_g" after the separator, of a bar with units in joules; empty without a level.
[[nodiscard]] std::string level_text(const char* separator, const OptimumRecord& optimum);

}  // namespace nsma
