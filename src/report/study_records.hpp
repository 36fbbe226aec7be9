#pragma once

#include <filesystem>

#include "nsma/study/scene.hpp"
#include "nsma/study/sensitivity/sensitivity.hpp"
#include "study/accuracy/accuracy_records.hpp"

namespace nsma {

/// The files in the folder of a study that keep all its records, every number as it is: what its tables and charts are
/// made from, at once or later. All functions throw InputError (one line).
inline constexpr const char* accuracy_records_name = "accuracy.json";
inline constexpr const char* sensitivity_records_name = "sensitivity.json";

void write_records(const std::filesystem::path& folder, const AccuracyResults& results);
/// With the objective of the scene, which the command line may have changed.
void write_records(const std::filesystem::path& folder, const Scene& scene, const SensitivityRecords& records);

[[nodiscard]] AccuracyResults read_accuracy_records(const std::filesystem::path& folder);
/// Of the bar of the scene, which gets the objective of the study.
[[nodiscard]] SensitivityRecords read_sensitivity_records(const std::filesystem::path& folder, Scene& scene);

}  // namespace nsma
