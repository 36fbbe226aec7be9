#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "nsma/study/sensitivity/sensitivity.hpp"

namespace nsma {

/// Files of a sensitivity study in its folder, beside scene.toml; columns: data/README.md.
inline constexpr std::array<const char*, 8> sensitivity_files{
    "optima.csv",   "prices.csv", "orbit-derivatives.csv", "intervals.csv", "relaxations.csv",
    "ablation.csv", "funnel.csv", "sensitivity.txt"};

/// The six orders in which COND1-3 can be imposed, with the number of patterns left after the
/// kernel and after each condition.
struct Funnel {
    std::array<int, 3> order{};  ///< 1, 2, 3 for COND1, COND2, COND3
    std::array<int, 4> left{};
};
[[nodiscard]] std::vector<Funnel> funnels(const std::vector<AblationRecord>& records);

/// Makes the folder and stores the scene in it. Throws InputError (one line) when it cannot be
/// made or written or holds another scene's results.
void open_sensitivity_folder(const std::filesystem::path& folder, const Scene& scene);

/// Writes the files, their description and the records; each appears under its name only when it is complete. Throws
/// InputError.
void write_sensitivity(const std::filesystem::path& folder, const Scene& scene, const SensitivityRecords& records);

/// The text of each file; `file` is one of sensitivity_files.
[[nodiscard]] std::string sensitivity_text(const std::string& file, const Scene& scene,
                                           const SensitivityRecords& records);

/// What a nondimensional objective is in SI units, and their name.
[[nodiscard]] std::pair<double, const char*> objective_unit(Objective objective, const Bar& bar);
[[nodiscard]] const char* unit_name(Parameter parameter);  ///< "m", "N" or "J"
/// Derivative in SI: objective (J; N for least-force) per metre, newton or joule.
[[nodiscard]] double in_si(double derivative, Objective objective, Parameter parameter, const Bar& bar);
/// Relative change of the value per relative change of gap or energy; of a parameter that is
/// zero, per |d| or per Y S |d|/L.
[[nodiscard]] double elasticity(double derivative, Parameter parameter, double value, int gap_sign, double level);

}  // namespace nsma
