#include "state_file.hpp"

#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "input_file.hpp"
#include "one_line.hpp"
#include "results_folder.hpp"

namespace nsma {
namespace {

constexpr const char* header = "stress_pa,velocity_m_s";
constexpr std::size_t longest_line = 1000;

}  // namespace

State read_state(const std::filesystem::path& file, const Mesh& mesh) {
    InputFile input(file, "a state of the bar");
    State state(mesh.window());
    std::string line;
    const auto refuse = [&](const std::string& expected, const std::string& got) {
        fail(fmt::format("{}:{}", file.string(), input.line_number()),
             fmt::format("expected {}, got {}", expected, got));
    };
    const auto next = [&] {
        const bool found = input.line(line, longest_line);
        if (found && line.ends_with('\r')) line.pop_back();
        return found;
    };
    if (!next() || line != header) refuse(fmt::format("the line {}", header), line.empty() ? "none" : shortened(line));
    for (int cell = 0; cell < mesh.cells; ++cell) {
        if (!next()) refuse(fmt::format("{} cells", mesh.cells), fmt::format("{}", cell));
        const char* at = line.data();
        const char* const end = at + line.size();
        for (const int place : {cell, mesh.cells + cell}) {
            double value = std::nan("");
            const auto [rest, error] = std::from_chars(at, end, value);
            const bool last = place >= mesh.cells;
            if (error != std::errc() || !std::isfinite(value) || (last ? rest != end : rest == end || *rest != ','))
                refuse("two finite numbers with a comma between", shortened(line));
            state[place] = value;
            at = rest + 1;
        }
    }
    while (next()) {
        if (!line.empty()) refuse(fmt::format("{} cells", mesh.cells), "more lines");
    }
    return state;
}

}  // namespace nsma
