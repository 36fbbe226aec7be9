// Records of a study or an orbit as the input says, under a checksum that fits: refused in one line that names the
// file, or made into tables and charts.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "../support/sweep_scene.hpp"
#include "fuzz.hpp"

#include "orbit/fnv_hash.hpp"
#include "nsma/report/input_error.hpp"
#include "nsma/report/scene_file.hpp"
#include "report/accuracy/accuracy_folder.hpp"
#include "report/forced/forced_folder.hpp"
#include "report/orbit_folder.hpp"
#include "report/sensitivity/sensitivity_charts.hpp"
#include "report/sensitivity/sensitivity_folder.hpp"
#include "report/state_file.hpp"
#include "report/study_records.hpp"
#include "report/sweep/sweep_charts.hpp"

namespace {

namespace fs = std::filesystem;

constexpr const char* forcing_text =
    "[damping]\nkind = \"tip\"\nvalue = 0.1\n[forcing]\namplitude = 0.5\nfrom = 1.0\nto = 1.1\ncount = 2\nsettle = 2\n"
    "record = 2\n";

struct Place {
    fs::path folder = fs::temp_directory_path() / ("nsma-fuzz-study-" + std::to_string(getpid()));
    Place() {
        fs::create_directories(folder);
        std::ofstream(folder / "scene.toml") << sweep_scene_text << forcing_text;
    }
    ~Place() { fs::remove_all(folder); }
};

std::string under_checksum(const std::string& records) {
    const auto json = nlohmann::json::parse(records, nullptr, false);
    if (json.is_discarded()) return records;
    nsma::FnvHash hash;
    for (const char letter : json.dump()) hash.add(static_cast<unsigned char>(letter));
    return fmt::format("{{\"format\":1,\"checksum\":\"{:016x}\",\"records\":{}}}", hash.value(), json.dump());
}

// The first letter tells whose records they are.
void read_and_draw(char kind, const fs::path& folder, const std::string& text) {
    const auto write = [&](const char* name, const std::string& all) {
        std::ofstream(folder / name, std::ios::binary) << all;
    };
    std::vector<nsma::Chart> charts;
    nsma::Scene scene = nsma::read_scene(folder / "scene.toml");
    if (kind == 'o') {
        write(nsma::orbit_json_name, text);
        const auto [read, orbit] = nsma::read_orbit_folder(folder);
        nsma::write_orbit_curves(folder, orbit);
        charts = nsma::charts_of(read, orbit, "orbit");
    } else if (kind == 'f') {
        write(nsma::forced_records_name, text);
        const auto points = nsma::read_forced(folder, scene);
        nsma::write_forced(folder, scene, points);
        charts = nsma::forced_charts(scene, points);
    } else if (kind == 'q') {
        write("state.csv", text);
        const nsma::State state = nsma::read_state(folder / "state.csv", scene.mesh);
        fuzz::expect(state.allFinite(), "a state is finite");
    } else if (kind == 'a') {
        write(nsma::accuracy_records_name, under_checksum(text));
        const auto records = nsma::read_accuracy_records(folder);
        nsma::write_accuracy(folder, scene, records);
        charts = nsma::accuracy_charts(records);
    } else {
        write(nsma::sensitivity_records_name, under_checksum(text));
        const auto records = nsma::read_sensitivity_records(folder, scene);
        for (const char* file : nsma::sensitivity_files) (void)nsma::sensitivity_text(file, scene, records);
        charts = nsma::sensitivity_charts(scene, records);
    }
    for (const auto& chart : charts) fuzz::expect(!nsma::gnuplot_script(chart).empty(), "a chart has a script");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Place place;
    if (size == 0) return 0;
    const std::string text(data + 1, data + size);
    try {
        read_and_draw(static_cast<char>(data[0]), place.folder, text);
    } catch (const nsma::InputError& error) {
        fuzz::expect_one_line(error.what());
        fuzz::expect(std::string_view(error.what()).find(place.folder.string()) != std::string_view::npos,
                     "a refusal names the file", error.what());
    }
    return 0;
}
