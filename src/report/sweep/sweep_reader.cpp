#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "sweep_folder.hpp"
#include "sweep_store.hpp"
#include "nsma/report/scene_file.hpp"
#include "report/csv.hpp"
#include "report/one_line.hpp"

namespace nsma {
namespace {

namespace fs = std::filesystem;

Pattern read_pattern(const CsvTable& table, const Scene& scene) {
    const Pattern pattern{table.integer("cells"), table.integer("free_steps"), table.integer("contact_steps")};
    if (pattern.cells != scene.mesh.cells) table.fail("cells", fmt::format("the scene's {}", scene.mesh.cells));
    if (pattern.free_steps < 1) table.fail("free_steps", "an integer >= 1");
    if (pattern.contact_steps < 1) table.fail("contact_steps", "an integer >= 1");
    return pattern;
}

Verdict read_verdict(const CsvTable& table) {
    for (const Verdict verdict : {Verdict::trivial, Verdict::inadmissible, Verdict::below, Verdict::above,
                                  Verdict::undecided, Verdict::admissible, Verdict::failed}) {
        if (table.text("verdict") == name(verdict)) return verdict;
    }
    table.fail("verdict", "a verdict");
}

std::vector<PatternRecord> read_patterns(const fs::path& file, const Scene& scene) {
    std::vector<PatternRecord> records;
    const double unit = scene.bar.energy_unit();
    const bool closed = scene.bar.gap_sign() == 0;
    for (CsvTable table(file); table.next();) {
        PatternRecord record;
        record.pattern = read_pattern(table, scene);
        record.gap_sign = scene.bar.gap_sign();
        record.kernel_dimension = table.integer("kernel_dimension");
        record.verdict = read_verdict(table);
        record.interval.least = table.number(closed ? "energy_min_joule" : "energy_ratio_min");
        record.interval.greatest = table.number(closed ? "energy_max_joule" : "energy_ratio_max");
        if (closed && record.interval.least) *record.interval.least /= unit;
        if (closed && record.interval.greatest) *record.interval.greatest /= unit;
        record.interval.unbounded = table.text("energy_unbounded") == "true";
        record.reason = table.text("reason");
        records.push_back(std::move(record));
    }
    return records;
}

std::vector<StoredLevel> read_levels(const fs::path& file, const Scene& scene) {
    std::vector<StoredLevel> levels;
    const bool closed = scene.bar.gap_sign() == 0;
    for (CsvTable table(file); table.next();) {
        StoredLevel level{read_pattern(table, scene), table.number("level"), read_verdict(table),
                          table.number(closed ? "energy_joule" : "energy_ratio"), table.text("agreement")};
        if (closed && level.energy) *level.energy /= scene.bar.energy_unit();
        levels.push_back(std::move(level));
    }
    return levels;
}

StoredOrbit read_orbit(const nlohmann::json& json, const Scene& scene) {
    const Pattern pattern{json.at("cells").get<int>(), json.at("free_steps").get<int>(),
                          json.at("contact_steps").get<int>()};
    validate(pattern);
    const auto alpha = json.at("alpha").get<std::vector<double>>();
    const Kernel kernel = exact_kernel(pattern);
    const Mesh mesh{pattern.cells};
    const Eigen::VectorXd beta =
        Eigen::Map<const Eigen::VectorXd>(alpha.data(), static_cast<Eigen::Index>(alpha.size())) *
        (mesh.time_step(scene.bar) / scene.bar.displacement_unit());
    StoredOrbit stored;
    if (!json.at("level").is_null()) stored.level = json.at("level").get<double>();
    stored.energy = json.at("energy_joule").get<double>() / scene.bar.energy_unit();
    stored.orbit = make_orbit(scene.bar, kernel, beta);
    return stored;
}

std::vector<StoredOrbit> read_orbits(const fs::path& file, const Scene& scene) {
    errno = 0;
    std::ifstream stream(file);
    if (!stream) throw InputError(one_line(fmt::format("{}: cannot be read: {}", file.string(), std::strerror(errno))));
    std::vector<StoredOrbit> orbits;
    int number = 0;
    for (std::string line; std::getline(stream, line);) {
        ++number;
        try {
            orbits.push_back(read_orbit(nlohmann::json::parse(line), scene));
        } catch (const std::exception& error) {
            throw InputError(one_line(fmt::format("{}:{}: expected an orbit as one JSON object, got: {}", file.string(),
                                                  number, error.what())));
        }
    }
    return orbits;
}

StoredSweep read_store(const fs::path& folder) {
    const SweepStore store(folder);
    StoredSweep sweep;
    sweep.scene = store.scene();
    store.for_each([&sweep](WorkResult result) {
        if (result.record) sweep.patterns.push_back(std::move(*result.record));
        if (!result.answer) return;
        OrbitAnswer& answer = *result.answer;
        sweep.levels.push_back(
            {answer.pattern, answer.level, answer.verdict, answer.energy, std::string(name(answer.agreement))});
        if (answer.orbit) {
            sweep.orbits.push_back({answer.level, answer.energy.value_or(0.0), std::move(*answer.orbit)});
        }
    });
    return sweep;
}

}  // namespace

StoredSweep read_sweep_folder(const fs::path& folder) {
    std::error_code code;
    if (!fs::is_directory(folder, code)) {
        throw InputError(one_line(fmt::format("{}: expected the folder of a sweep, got {}", folder.string(),
                                              fs::exists(folder, code) ? "a file" : "nothing")));
    }
    if (SweepStore::in(folder)) return read_store(folder);
    for (const char* file : {"scene.toml", "patterns.csv", "levels.csv", "orbits.jsonl"}) {
        if (!fs::exists(folder / file, code)) {
            throw InputError(one_line(
                fmt::format("{}: expected the folder of a finished sweep, got one without {}", folder.string(), file)));
        }
    }
    StoredSweep sweep;
    sweep.scene = read_scene(folder / "scene.toml");
    sweep.patterns = read_patterns(folder / "patterns.csv", sweep.scene);
    sweep.levels = read_levels(folder / "levels.csv", sweep.scene);
    sweep.orbits = read_orbits(folder / "orbits.jsonl", sweep.scene);
    return sweep;
}

}  // namespace nsma
