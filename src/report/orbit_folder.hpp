#pragma once

#include <filesystem>

#include "nsma/search/answer.hpp"
#include "nsma/study/scene.hpp"
#include "report/sweep/sweep_export.hpp"

namespace nsma {

/// The file of a folder that holds one orbit.
inline constexpr const char* orbit_json_name = "orbit.json";

/// Writes orbit.json, curves.csv and a copy of the scene into a folder (made if missing). Throws InputError where it
/// cannot be written or holds results of another scene.
void write_orbit_folder(const std::filesystem::path& folder, const Scene& scene, const OrbitAnswer& answer);

/// Writes its curves.csv again.
void write_orbit_curves(const std::filesystem::path& folder, const StoredOrbit& stored);

/// Reads such a folder back; the orbit from its amplitudes alpha. Throws InputError where it is missing or damaged.
struct OrbitFolder {
    Scene scene;
    StoredOrbit orbit;
};
[[nodiscard]] OrbitFolder read_orbit_folder(const std::filesystem::path& folder);

}  // namespace nsma
