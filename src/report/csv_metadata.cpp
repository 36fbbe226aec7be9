#include "csv_metadata.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "input_file.hpp"
#include "one_line.hpp"
#include "results_folder.hpp"

namespace nsma {
namespace {

using Json = nlohmann::ordered_json;

struct Table {
    const char* file;
    const char* description;
};
constexpr std::array<Table, 22> known_tables{
    {{"patterns.csv", "patterns, their verdicts and energy intervals"},
     {"levels.csv",
      "one row an answer; level is in units of E_g, in joules for a closed gap, and empty in the row of a pattern's "
      "least-energy orbit"},
     {"timings.csv", "wall times"},
     {"curves.csv",
      "motion and force of every orbit over one period; the force is that of the step that begins at the row's time"},
     {"orbit-curves.csv", "motion and force of one orbit over one period"},
     {"optima.csv", "optima whose sensitivity was studied"},
     {"prices.csv", "shadow prices of every condition at every optimum"},
     {"orbit-derivatives.csv", "how the amplitudes of an optimum change"},
     {"intervals.csv", "prices of the ends of the energy intervals"},
     {"relaxations.csv", "energies and objective when conditions are relaxed"},
     {"ablation.csv", "conditions that each pattern survives"},
     {"funnel.csv", "patterns left after each condition, in every order"},
     {"programs.csv", "one orbit at a given energy: time and error of every method"},
     {"kernels.csv", "kernel of the periodicity matrix: time and error of every method"},
     {"marching.csv", "one period of the first nonsmooth mode: time and error of every method"},
     {"drift.csv", "many periods of it: drift of energy and state"},
     {"stability.csv", "cells of the maps of where methods fail"},
     {"tolerance.csv", "dimension of the kernel that a dense method finds at a tolerance"},
     {"causes.csv", "what went wrong, by method and map"},
     {"response.csv", "response to a force of swept frequency, one row a frequency and direction"},
     {"balance.csv", "orbits of the modes: most work of the force over loss to the damping, a period"},
     {"winners.csv", "Pareto fronts of speed and error, by number of amplitudes"}}};

constexpr std::size_t longest_header = 1U << 16U;

constexpr const char* notes =
    "SI units. energy_ratio* is E/E_g with E_g = Y S gap^2/(2 length), empty for a closed gap; frequency_ratio is "
    "omega/omega_1, omega_1 = pi c/(2 length); *_steps count time steps length/(c cells). An empty field has no value.";

Json columns_of(std::string_view header) {
    Json columns = Json::array();
    for (std::size_t begin = 0; begin <= header.size();) {
        const std::size_t end = std::min(header.find(',', begin), header.size());
        const std::string_view name = header.substr(begin, end - begin);
        Json column = Json::object();
        column["name"] = std::string(name);
        if (const std::string unit = unit_of_column(name); !unit.empty()) column["schema:unitText"] = unit;
        columns.push_back(std::move(column));
        begin = end + 1;
    }
    return columns;
}

}  // namespace

std::string unit_of_column(std::string_view column) {
    static constexpr std::array<std::pair<std::string_view, const char*>, 8> ends{{{"_m_s", "m/s"},
                                                                                   {"_s", "s"},
                                                                                   {"_m", "m"},
                                                                                   {"_n", "N"},
                                                                                   {"_pa", "Pa"},
                                                                                   {"_hz", "Hz"},
                                                                                   {"_joule", "J"},
                                                                                   {"_steps", "time steps"}}};
    if (column == "gap") return "m";
    if (column == "seconds" || column.starts_with("seconds_")) return "s";
    for (const auto& [end, unit] : ends) {
        if (column.ends_with(end)) return unit;
    }
    return {};
}

void write_csv_metadata(const std::filesystem::path& folder, const std::string& title) {
    auto json = Json::object();
    json["@context"] = "http://www.w3.org/ns/csvw";
    json["dc:title"] = one_line(title);
    json["dc:description"] = notes;
    json["tables"] = Json::array();
    for (const Table& table : known_tables) {
        std::string header;
        if (std::error_code code; !std::filesystem::exists(folder / table.file, code)) continue;
        if (!InputFile(folder / table.file, "a table").line(header, longest_header)) continue;
        auto entry = Json::object();
        entry["url"] = table.file;
        entry["dc:description"] = table.description;
        entry["tableSchema"] = Json::object();
        entry["tableSchema"]["columns"] = columns_of(header);
        json["tables"].push_back(std::move(entry));
    }
    write_whole(folder / csv_metadata_name, json.dump(2) + "\n");
}

}  // namespace nsma
