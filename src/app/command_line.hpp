#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "nsma/search/orbit_solver.hpp"
#include "nsma/study/scan.hpp"

namespace nsma::app {

/// What a scene file says may be said anew on the command line.
struct SceneArguments {
    std::string file;
    std::optional<int> cells;
    std::optional<double> gap;  ///< [m]
};

struct ScanArguments {
    SceneArguments scene;
    std::optional<std::array<double, 2>> period;  ///< [lo, hi] in units of tau
    ScanMethod method = ScanMethod::certified;
    bool csv = false;
    bool quiet = false;
};

struct OrbitArguments {
    SceneArguments scene;
    int free_steps = 0;
    int contact_steps = 0;
    std::optional<double> energy;
    std::optional<Objective> objective;  ///< absent: the scene's
    OrbitSolverOptions solver;
    bool json = false;
};

struct SweepArguments {
    std::string scene_file;
    std::string out;
    OrbitSolverOptions solver;
    bool all_kinds = false;  ///< also free and stuck patterns
    bool distinct = false;   ///< one row a motion
    bool resume = false;     ///< go on with what the folder holds
    bool quiet = false;
};

struct ExportArguments {
    std::string folder;
    bool distinct = false;
};

struct AccuracyArguments {
    std::string scene_file;
    std::string out;
    bool quick = false;
    bool quiet = false;
};

struct SensitivityArguments {
    std::string scene_file;
    std::optional<int> free_steps;  ///< with contact_steps: one pattern instead of the scene's
    std::optional<int> contact_steps;
    std::optional<double> energy;  ///< of one pattern
    std::optional<Objective> objective;
    std::string out;
    OrbitSolverOptions solver;
    bool all_kinds = false;
    bool quiet = false;
};

struct PlotArguments {
    std::string folder;
    bool quiet = false;
};

struct ProveArguments {
    SceneArguments scene;
    std::optional<std::array<double, 2>> period;  ///< [lo, hi] in units of tau
    std::optional<int> free_steps;                ///< with contact_steps: one pattern instead of the scene's
    std::optional<int> contact_steps;
    std::string out;
    bool quiet = false;
};

struct CheckArguments {
    std::string file;
};

/// Help or version text was asked: print and leave with 0.
struct TextArguments {
    std::string text;
};

using Arguments = std::variant<TextArguments, ScanArguments, OrbitArguments, SweepArguments, ExportArguments,
                               AccuracyArguments, SensitivityArguments, PlotArguments, ProveArguments, CheckArguments>;

/// Versions of the program and its solvers, one line.
[[nodiscard]] std::string version();

/// Reads the command line. Throws InputError (one line) on anything it cannot take.
[[nodiscard]] Arguments parse(int count, const char* const* words);

}  // namespace nsma::app
