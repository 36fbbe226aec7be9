#pragma once

#include <filesystem>
#include <vector>

#include "report/chart.hpp"

namespace nsma::app {

/// Draws charts into folder/charts and lists the pictures on stdout unless `quiet`.
void draw(const std::vector<Chart>& charts, const std::filesystem::path& folder, bool quiet,
          const Drawing& drawing = {});

/// The same at the end of a study, whose tables are complete without them: no gnuplot is a line on stderr, no error.
void draw_if_possible(const std::vector<Chart>& charts, const std::filesystem::path& folder, bool quiet = false);

}  // namespace nsma::app
