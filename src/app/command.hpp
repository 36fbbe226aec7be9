#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "nsma/search/orbit_solver.hpp"
#include "nsma/study/scan.hpp"
#include "report/chart.hpp"

namespace nsma::app {

/// What the command line says; every command reads what its options set.
struct Arguments {
    std::string input;  ///< scene file, folder of a sweep or file of certificates
    std::string out;    ///< folder or file for the results; of `orbit` and `plot` perhaps none
    std::optional<int> cells;
    std::optional<double> gap;                    ///< [m]
    std::optional<std::array<double, 2>> period;  ///< [lo, hi] in units of tau
    int free_steps = 0;                           ///< of one pattern; 0: none named
    int contact_steps = 0;
    std::optional<double> energy;  ///< of one pattern, in E_g; joules for a closed gap
    bool joules = false;           ///< energy is in joules
    std::optional<Objective> objective;
    OrbitSolverOptions solver;
    ScanMethod method = ScanMethod::certified;
    bool all_kinds = false;  ///< also free and stuck patterns
    bool distinct = false;   ///< one row a motion
    bool certify = false;    ///< exact certificates of every orbit
    bool resume = false;     ///< go on with what an interrupted run left
    std::string state;       ///< file of a state to march
    double perturb = 0;      ///< share of its norm by which a start is moved
    int periods = 100;       ///< to march
    bool quick = false;
    bool curves = false;  ///< the curves of every orbit as well
    bool csv = false;
    bool json = false;
    bool quiet = false;
    bool verbose = false;
    bool fresh = false;  ///< whatever an interrupted run left
    Drawing drawing;     ///< of `plot`

    /// The scene with what is said anew, checked. This and the next throw InputError.
    [[nodiscard]] Scene scene() const;
    /// The one pattern that was named, or all of the scene.
    [[nodiscard]] std::vector<Pattern> patterns(const Scene& scene) const;
    /// The energy in units of the scene's bar.
    [[nodiscard]] std::optional<double> level(const Scene& scene) const;
    /// Throws InputError where the objective or the gap of the scene does not go with the energy, or with none for one
    /// pattern; `objective_from` says where the objective stands.
    void check_energy(const Scene& scene, const std::string& objective_from) const;
};

enum ExitCode {
    exit_done = 0,
    exit_input = 2,
    exit_inadmissible = 3,
    exit_solver = 4,
    exit_interrupted = 130,
    exit_terminated = 143  ///< interrupted by SIGTERM
};

/// Each runs one command and returns its exit code. Throw InputError on bad input, and Interrupted where they have
/// nothing to keep.
using Run = int(const Arguments& arguments);
Run run_scan, run_orbit, run_sweep, run_export, run_report, run_forced, run_march, run_accuracy, run_sensitivity,
    run_plot, run_prove, run_check;

/// The names of `--solver`.
inline constexpr std::array<std::pair<const char*, SolverChoice>, 4> solver_choices{{{"ipopt", SolverChoice::ipopt},
                                                                                     {"nlopt", SolverChoice::nlopt},
                                                                                     {"both", SolverChoice::both},
                                                                                     {"proof", SolverChoice::proof}}};

/// A command with its arguments.
struct Command {
    Run* run = nullptr;
    Arguments arguments;
};

/// Reads the command line; absent when it asked for help or the version, which are then printed. Throws InputError (one
/// line) on anything it cannot take.
[[nodiscard]] std::optional<Command> read_command_line(int count, const char* const* words);

/// Versions of the program and its solvers, one line.
[[nodiscard]] std::string version();

}  // namespace nsma::app
