#include "draw.hpp"

#include <fmt/format.h>

#include "standard_streams.hpp"

#include "nsma/report/input_error.hpp"

namespace nsma::app {

void draw(const std::vector<Chart>& charts, const std::filesystem::path& folder, bool quiet, const Drawing& drawing) {
    for (const auto& picture : draw_charts(charts, folder / "charts", drawing)) {
        if (!quiet) fmt::print("chart    {}\n", picture.string());
    }
}

void draw_if_possible(const std::vector<Chart>& charts, const std::filesystem::path& folder, bool quiet) {
    try {
        draw(charts, folder, quiet);
    } catch (const NoGnuplot& error) {
        say("{}; the tables are complete without them", error.what());
    }
}

}  // namespace nsma::app
