#include "sweep_folder.hpp"

#include <cerrno>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "tables.hpp"
#include "nsma/report/orbit_json.hpp"
#include "report/one_line.hpp"
#include "report/results_folder.hpp"

namespace nsma {
namespace {

namespace fs = std::filesystem;

/// Whether the folder holds a whole, uninterrupted sweep.
bool complete(const fs::path& folder) {
    for (const char* file : sweep_files) {
        if (!fs::is_regular_file(folder / file)) return false;
    }
    const auto text = contents(folder / "summary.json");
    const auto json = nlohmann::json::parse(text.value_or(""), nullptr, false);
    return json.is_object() && json.value("interrupted", true) == false;
}

std::string summary_json(const SweepSummary& summary) {
    nlohmann::ordered_json json;
    json["patterns"] = summary.patterns;
    json["trivial"] = summary.trivial;
    json["inadmissible"] = summary.inadmissible;
    json["admissible"] = summary.admissible;
    for (const PatternKind kind : pattern_kinds)
        json["kinds"][std::string(name(kind))] = summary.kinds[static_cast<std::size_t>(kind)];
    json["left"] = summary.left;
    json["failed_patterns"] = summary.failed_patterns;
    json["levels"] = summary.levels;
    json["solved"] = summary.solved;
    json["copies"] = summary.copies;
    json["closed_form"] = summary.closed_form;
    json["below"] = summary.below;
    json["above"] = summary.above;
    json["undecided"] = summary.undecided;
    json["unproved"] = summary.unproved;
    json["open_bounds"] = summary.open_bounds;
    json["global"] = summary.global;
    json["worst_gap"] = summary.worst_gap;
    json["agreed"] = summary.agreed;
    json["disagreed"] = summary.disagreed;
    json["one_failed"] = summary.one_failed;
    json["failed"] = summary.failed;
    if (std::isfinite(summary.worst_violation)) {
        json["worst_violation"] = summary.worst_violation;
    } else {
        json["worst_violation"] = nullptr;
    }
    json["seconds"] = summary.seconds;
    json["interrupted"] = summary.interrupted;
    return json.dump(2);
}

constexpr const char* csv_notes =
    "# SI units: gap [m], period_s [s], *_joule [J]. energy_ratio* is E/E_g with E_g = Y S gap^2 / "
    "(2 length),\n"
    "# empty for a closed gap; frequency_ratio is omega/omega_1; *_steps count time steps "
    "length/(c cells).\n"
    "# An empty field has no value. All columns: data/README.md of nsma.";

}  // namespace

void prepare_sweep_folder(const fs::path& folder, const Scene& scene) {
    prepare_results_folder(folder, scene, sweep_files);
}

SweepFolder::SweepFolder(const fs::path& folder, const Scene& scene) : folder_(folder), bar_(scene.bar) {
    prepare_sweep_folder(folder, scene);
    patterns_ = open("patterns.csv");
    levels_ = open("levels.csv");
    orbits_ = open("orbits.jsonl");
    timings_ = open("timings.csv");
    const std::string title = "# nsma sweep: " + one_line(scene.title);
    write(patterns_, fmt::format("{}: patterns\n{}\n{}", title, csv_notes, patterns_csv_header()));
    write(levels_, fmt::format("{}: energy levels\n{}\n# level is in units of E_g, in joules for a closed gap; "
                               "empty in the row of a pattern's least-energy orbit.\n{}",
                               title, csv_notes, levels_csv_header()));
    write(timings_, fmt::format("{}: wall times [s]\n{}", title, timings_csv_header()));
}

SweepFolder::~SweepFolder() = default;

SweepFolder::Output SweepFolder::open(const char* name) {
    Output output{part_of(folder_ / name), nullptr};
    output.file.reset(std::fopen(output.path.c_str(), "wb"));
    if (!output.file) fail_errno(output.path);
    return output;
}

void SweepFolder::write(Output& output, const std::string& line) {
    std::FILE* file = output.file.get();
    if (std::fwrite(line.data(), 1, line.size(), file) != line.size() || std::fputc('\n', file) == EOF ||
        std::fflush(file) != 0) {
        fail_errno(output.path);
    }
}

void SweepFolder::close(Output& output) {
    std::FILE* file = output.file.get();
    if (std::fflush(file) != 0 || (fsync(fileno(file)) != 0 && errno != EINVAL)) fail_errno(output.path);
    if (std::fclose(output.file.release()) != 0) fail_errno(output.path);
}

void SweepFolder::pattern(const PatternRecord& record) {
    write(patterns_, patterns_csv_row(bar_, record));
    for (const std::string& row : timings_csv_rows(record)) write(timings_, row);
}

void SweepFolder::answer(const OrbitAnswer& answer) { this->answer(answer, false); }

void SweepFolder::answer(const OrbitAnswer& answer, bool only_times) {
    if (!only_times) {
        write(levels_, levels_csv_row(bar_, answer));
        if (answer.orbit) write(orbits_, orbit_json(answer, bar_, false, -1));
    }
    for (const std::string& row : timings_csv_rows(answer)) write(timings_, row);
}

void SweepFolder::progress(long, long) {}

std::string SweepFolder::finish(const SweepSummary& summary) {
    for (Output* output : {&patterns_, &levels_, &orbits_, &timings_}) close(*output);
    std::string table = summary_table(summary);
    table.pop_back();
    for (const auto& [file, text] :
         {std::pair{"summary.txt", table}, std::pair{"summary.json", summary_json(summary)}}) {
        Output output = open(file);
        write(output, text);
        close(output);
    }
    if (summary.interrupted && complete(folder_)) {
        return fmt::format(
            "interrupted: {} keeps its complete results; the rows done now are beside them as "
            ".part files",
            folder_.string());
    }
    for (const char* file : sweep_files) put_in_place(folder_ / file);
    return fmt::format("{}results are in {}", summary.interrupted ? "interrupted: partial " : "", folder_.string());
}

}  // namespace nsma
