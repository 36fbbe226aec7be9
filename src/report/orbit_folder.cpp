#include "orbit_folder.hpp"

#include <array>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "csv_metadata.hpp"
#include "input_file.hpp"
#include "json_numbers.hpp"
#include "nesting.hpp"
#include "results_folder.hpp"
#include "nsma/orbit/kernel.hpp"
#include "nsma/orbit/replay.hpp"
#include "nsma/report/orbit_json.hpp"
#include "nsma/report/scene_file.hpp"
#include "report/sweep/tables.hpp"

namespace nsma {
namespace {

namespace fs = std::filesystem;

constexpr const char* curves_name = "orbit-curves.csv";
constexpr std::size_t most_orbit_bytes = std::size_t{1} << 30U;
constexpr int deepest_orbit = 16;

// The alpha of a file and the bar it is of give the orbit.
StoredOrbit stored_orbit(const nlohmann::json& json, const Scene& scene) {
    const Pattern pattern{whole_number(json.at("cells")), whole_number(json.at("free_steps")),
                          whole_number(json.at("contact_steps"))};
    const auto alpha = json.at("alpha").get<std::vector<double>>();
    validate(pattern);
    if (pattern.cells != scene.mesh.cells || alpha.size() != static_cast<std::size_t>(kernel_dimension(pattern)))
        throw std::invalid_argument("another mesh or number of amplitudes");
    const double velocity = scene.bar.displacement_unit() / Mesh{pattern.cells}.time_step(scene.bar);
    const Eigen::VectorXd beta =
        Eigen::Map<const Eigen::VectorXd>(alpha.data(), static_cast<Eigen::Index>(alpha.size())) / velocity;
    StoredOrbit stored{std::nullopt, 0.0, make_orbit(scene.bar, exact_kernel(pattern), beta)};
    if (!json.at("level").is_null()) stored.level = json.at("level").get<double>();
    stored.energy = energy_ratio(stored.orbit);
    // Whoever changed the amplitudes changed the motion.
    const double energy = json.at("energy_joule").get<double>();
    const bool same = std::abs(stored.energy * scene.bar.energy_unit() - energy) <= 1e-9 * energy;
    if (!same || !replay(stored.orbit).accepted) throw std::invalid_argument("amplitudes that are not of this orbit");
    return stored;
}

}  // namespace

void write_orbit_curves(const fs::path& folder, const StoredOrbit& stored) {
    write_whole(folder / curves_name, curves_csv_header() + "\n" + curves_csv_rows(stored.orbit, stored.level));
}

void write_orbit_folder(const fs::path& folder, const Scene& scene, const OrbitAnswer& answer) {
    static constexpr std::array<const char*, 2> files{orbit_json_name, curves_name};
    prepare_results_folder(folder, scene, files);
    write_whole(folder / orbit_json_name, orbit_json(answer, scene.bar) + "\n");
    write_orbit_curves(folder, {answer.level, *answer.energy, *answer.orbit});
    write_csv_metadata(folder, scene.title);
}

OrbitFolder read_orbit_folder(const fs::path& folder) {
    const fs::path file = folder / orbit_json_name;
    const std::string text = InputFile(file, "an orbit").text(most_orbit_bytes);
    Scene scene = read_scene(folder / "scene.toml");
    try {
        if (too_deep(text, deepest_orbit)) throw std::invalid_argument("brackets nested too deep");
        StoredOrbit orbit = stored_orbit(nlohmann::json::parse(text), scene);
        return {std::move(scene), std::move(orbit)};
    } catch (const nlohmann::json::exception&) {
        fail(file, "expected the orbit that nsma orbit --out writes, got other text");
    } catch (const std::invalid_argument& error) {
        fail(file, fmt::format("expected the orbit that nsma orbit --out writes, got {}", error.what()));
    }
}

}  // namespace nsma
