#include "command_line.hpp"
#include "numerics/solver.hpp"

#include <array>
#include <cmath>
#include <map>

#include <CLI/CLI.hpp>

#include "numerics/linear_program.hpp"
#include "nsma/report/scene_file.hpp"

namespace nsma::app {
namespace {

constexpr const char* exit_codes =
    "Exit: 0 done, 2 bad usage or scene, 3 nothing admissible, 4 a solver failed, the two\n"
    "disagree beyond tolerance or a proof does not hold, 130 interrupted (what was done is kept).";

const CLI::Validator finite{[](const std::string& text) -> std::string {
                                double value = 0;
                                if (CLI::detail::lexical_cast(text, value) && std::isfinite(value)) return {};
                                return "expected a finite number, got " + text;
                            },
                            "NUMBER"};

const CLI::Validator finite_positive{
    [](const std::string& text) -> std::string {
        double value = 0;
        if (CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value > 0) return {};
        return "expected a finite number > 0, got " + text;
    },
    "NUMBER>0"};

CLI::Validator whole(int lo, int hi) {
    return {[lo, hi](const std::string& text) -> std::string {
                std::int64_t value = 0;
                if (CLI::detail::lexical_cast(text, value) && value >= lo && value <= hi) return {};
                return "expected a whole number in " + std::to_string(lo) + ".." + std::to_string(hi) + ", got " + text;
            },
            "INTEGER"};
}

const CLI::Validator objective_validator{
    [](const std::string& text) -> std::string {
        if (objective_named(text)) return {};
        return "expected least-shock, nearest, least-force, min-energy or max-energy, got " + text;
    },
    "NAME"};

void add_scene(CLI::App& command, SceneArguments& scene) {
    command.add_option("SCENE", scene.file, "scene file (TOML)")->required();
    command.add_option("--cells", scene.cells, "cells N instead of the scene's")->check(whole(1, max_cells));
    command.add_option("--gap", scene.gap, "gap d [m] instead of the scene's; negative: prestressed")->check(finite);
}

void add_period(CLI::App& command, std::vector<double>& period) {
    command.add_option("--period", period, "periods LO HI in units of tau instead of the scene's patterns")
        ->expected(2)
        ->check(finite);
}

std::optional<std::array<double, 2>> checked_period(const std::vector<double>& period) {
    if (period.empty()) return std::nullopt;
    if (period[0] < 0 || period[1] < period[0]) {
        throw InputError("command line: --period: expected 0 <= LO <= HI, got " + std::to_string(period[0]) + " " +
                         std::to_string(period[1]));
    }
    return std::array{period[0], period[1]};
}

void add_all_kinds(CLI::App& command, bool& all_kinds) {
    command.add_flag("--all-kinds", all_kinds,
                     "also solve patterns whose orbits never press against the wall (free) or never leave it (stuck)");
}

void add_distinct(CLI::App& command, bool& distinct) {
    command.add_flag("--distinct", distinct,
                     "leave out of levels.csv and orbits.jsonl what a row above has under another label");
}

void add_quiet(CLI::App& command, bool& quiet) { command.add_flag("--quiet", quiet, "no progress on stderr"); }

// Options that a user tunes a solver with; the names of the choices as the user types them.
struct SolverWords {
    std::string solver = "proof";
    void add(CLI::App& command, OrbitSolverOptions& options) {
        command
            .add_option("--solver", solver,
                        "proof: closed forms, a solver only where they prove nothing (default); both: Ipopt and NLopt "
                        "as well, against each other; ipopt; nlopt")
            ->check(CLI::Validator(
                [](const std::string& text) -> std::string {
                    if (text == "ipopt" || text == "nlopt" || text == "both" || text == "proof") return {};
                    return "expected ipopt, nlopt, both or proof, got " + text;
                },
                "NAME"));
        command
            .add_option(
                "--starts", options.starts,
                "starts per solver while the optimum is not proved (default 8; a quarter of them above 64 unknowns)")
            ->check(whole(1, 10'000));
    }
    [[nodiscard]] SolverChoice choice() const {
        if (solver == "ipopt") return SolverChoice::ipopt;
        if (solver == "nlopt") return SolverChoice::nlopt;
        return solver == "proof" ? SolverChoice::proof : SolverChoice::both;
    }
};

// "--gap: Required ..." etc. on one line.
std::string one_line(std::string text) {
    for (auto& c : text) {
        if (c == '\n' || c == '\r') c = ' ';
    }
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text;
}

}  // namespace

std::string version() {
    return "nsma " NSMA_VERSION " (Ipopt " + ipopt_version() + ", NLopt " + nlopt_version() + ", CLP " + clp_version() +
           ")";
}

Arguments parse(int count, const char* const* words) {
    CLI::App app{"Nonsmooth modal analysis of a bar in unilateral contact, by the Wave Finite Element Method.", "nsma"};
    app.require_subcommand(1);
    app.set_version_flag("--version", version());
    app.footer(std::string("Examples:\n"
                           "  nsma scan problems/first-mode.toml --cells 6 --period 0 4\n"
                           "  nsma orbit problems/first-mode.toml --free 48 --contact 16 --energy 37.5\n"
                           "  nsma sweep problems/first-mode.toml --out out/first-mode\n"
                           "  nsma sensitivity problems/first-mode.toml --out out/sensitivity\n"
                           "  nsma plot out/first-mode\n"
                           "  nsma prove problems/first-mode.toml --out proofs.jsonl\n"
                           "  nsma check proofs.jsonl\n") +
               exit_codes);

    ScanArguments scan;
    std::vector<double> period;
    auto* scan_command = app.add_subcommand(
        "scan", "list the patterns (r, p) with a nontrivial kernel, their verdicts and energy intervals");
    add_scene(*scan_command, scan.scene);
    add_period(*scan_command, period);
    std::string method = "certified";
    scan_command
        ->add_option("--method", method,
                     "certified (default: every verdict with its proof) or integers (verdicts alone)")
        ->check(CLI::IsMember({"certified", "integers"}));
    scan_command->add_flag("--csv", scan.csv, "CSV on stdout instead of a table");
    add_quiet(*scan_command, scan.quiet);
    scan_command->footer(
        "Examples:\n"
        "  nsma scan problems/first-mode.toml\n"
        "  nsma scan problems/first-mode.toml --cells 6 --gap 1 --period 0 4 --csv");

    OrbitArguments orbit;
    SolverWords orbit_words;
    std::string objective;
    auto* orbit_command = app.add_subcommand("orbit", "one orbit of one pattern");
    add_scene(*orbit_command, orbit.scene);
    orbit_command->add_option("--free", orbit.free_steps, "free flight r [steps]")
        ->required()
        ->check(whole(1, max_period_steps / 2));
    orbit_command->add_option("--contact", orbit.contact_steps, "contact phase p [steps]")
        ->required()
        ->check(whole(1, max_period_steps / 2));
    orbit_command
        ->add_option("--energy", orbit.energy,
                     "energy ratio E/E_g (joules for a closed gap); without it the least-energy orbit")
        ->check(finite_positive);
    orbit_command
        ->add_option("--objective", objective,
                     "least-shock, nearest, least-force, min-energy or max-energy instead of the scene's")
        ->check(objective_validator);
    orbit_words.add(*orbit_command, orbit.solver);
    orbit_command->add_flag("--json", orbit.json, "one JSON object on stdout instead of text");
    orbit_command->footer(
        "Examples:\n"
        "  nsma orbit problems/first-mode.toml --free 48 --contact 16\n"
        "  nsma orbit problems/first-mode.toml --cells 6 --free 16 --contact 4 --energy 12 --json");

    SweepArguments sweep;
    SolverWords sweep_words;
    auto* sweep_command =
        app.add_subcommand("sweep", "every pattern of the scene at every energy level: table, orbits, charts");
    sweep_command->add_option("SCENE", sweep.scene_file, "scene file (TOML)")->required();
    sweep_command->add_option("--out", sweep.out, "folder for the results; made if missing")->required();
    sweep_words.add(*sweep_command, sweep.solver);
    add_all_kinds(*sweep_command, sweep.all_kinds);
    add_distinct(*sweep_command, sweep.distinct);
    sweep_command->add_flag("--resume", sweep.resume, "go on with what the folder holds; without it all is done anew");
    add_quiet(*sweep_command, sweep.quiet);
    sweep_command->footer(
        "Examples:\n  nsma sweep problems/first-mode.toml --out out/first-mode\n"
        "  nsma sweep problems/first-mode.toml --out out/first-mode --resume");

    ExportArguments exported;
    auto* export_command = app.add_subcommand("export", "write the tables and the summary of a stored sweep again");
    export_command->add_option("DIR", exported.folder, "folder of a sweep")->required();
    add_distinct(*export_command, exported.distinct);
    export_command->footer("Example:\n  nsma export out/first-mode");

    AccuracyArguments accuracy;
    auto* accuracy_command =
        app.add_subcommand("accuracy", "speed against accuracy: every method on the same work, and where each fails");
    accuracy_command->add_option("SCENE", accuracy.scene_file, "scene file (TOML)")->required();
    accuracy_command->add_option("--out", accuracy.out, "folder for the results; made if missing")->required();
    accuracy_command->add_flag("--quick", accuracy.quick, "small sizes and few runs: seconds instead of minutes");
    add_quiet(*accuracy_command, accuracy.quiet);
    accuracy_command->footer("Example:\n  nsma accuracy problems/first-mode.toml --out out/accuracy");

    SensitivityArguments sensitivity;
    SolverWords sensitivity_words;
    std::string sensitivity_objective;
    auto* sensitivity_command =
        app.add_subcommand("sensitivity", "which condition decides, how much, and what happens when it is relaxed");
    sensitivity_command->add_option("SCENE", sensitivity.scene_file, "scene file (TOML)")->required();
    auto* sensitivity_free =
        sensitivity_command->add_option("--free", sensitivity.free_steps, "free flight r [steps] of one pattern")
            ->check(whole(1, max_period_steps / 2));
    auto* sensitivity_contact =
        sensitivity_command
            ->add_option("--contact", sensitivity.contact_steps, "contact phase p [steps] of one pattern")
            ->check(whole(1, max_period_steps / 2));
    sensitivity_free->needs(sensitivity_contact);
    sensitivity_contact->needs(sensitivity_free);
    sensitivity_command
        ->add_option("--energy", sensitivity.energy,
                     "energy ratio E/E_g of one pattern (joules for a closed gap); without it its least energy")
        ->check(finite_positive)
        ->needs(sensitivity_free);
    sensitivity_command
        ->add_option("--objective", sensitivity_objective,
                     "least-shock, nearest, least-force, min-energy or max-energy instead of the scene's")
        ->check(objective_validator);
    sensitivity_command->add_option("--out", sensitivity.out, "folder for the results; made if missing")->required();
    sensitivity_words.add(*sensitivity_command, sensitivity.solver);
    add_all_kinds(*sensitivity_command, sensitivity.all_kinds);
    add_quiet(*sensitivity_command, sensitivity.quiet);
    sensitivity_command->footer(
        "Examples:\n"
        "  nsma sensitivity problems/first-mode.toml --out out/sensitivity\n"
        "  nsma sensitivity problems/first-mode.toml --free 48 --contact 16 --energy 30 --out out/one");

    PlotArguments plot;
    auto* plot_command = app.add_subcommand("plot", "draw the charts of a stored sweep again");
    plot_command->add_option("DIR", plot.folder, "folder of a sweep")->required();
    plot_command->add_flag("--quiet", plot.quiet, "print no list of charts");
    plot_command->footer("Example:\n  nsma plot out/first-mode");

    ProveArguments prove;
    std::vector<double> prove_period;
    auto* prove_command =
        app.add_subcommand("prove", "write exact certificates of the verdicts and energy intervals, one a line");
    add_scene(*prove_command, prove.scene);
    add_period(*prove_command, prove_period);
    auto* prove_free = prove_command->add_option("--free", prove.free_steps, "free flight r [steps] of one pattern")
                           ->check(whole(1, max_period_steps / 2));
    auto* prove_contact =
        prove_command->add_option("--contact", prove.contact_steps, "contact phase p [steps] of one pattern")
            ->check(whole(1, max_period_steps / 2));
    prove_free->needs(prove_contact);
    prove_contact->needs(prove_free);
    prove_command->add_option("--out", prove.out, "file to write; must not exist yet; until it is complete FILE.part")
        ->required();
    add_quiet(*prove_command, prove.quiet);
    prove_command->footer(
        "Examples:\n"
        "  nsma prove problems/first-mode.toml --cells 6 --free 16 --contact 4 --out proof.jsonl\n"
        "  nsma prove problems/first-mode.toml --cells 24 --period 0 4 --out proofs.jsonl");

    CheckArguments check;
    auto* check_command =
        app.add_subcommand("check", "verify certificates from their four integers alone, in exact arithmetic");
    check_command->add_option("FILE", check.file, "certificates written by nsma prove")->required();
    check_command->footer("Example:\n  nsma check proofs.jsonl");

    for (auto* command : {scan_command, orbit_command, sweep_command, accuracy_command, sensitivity_command,
                          export_command, plot_command, prove_command, check_command}) {
        command->failure_message(CLI::FailureMessage::simple);
    }
    try {
        app.parse(count, words);
    } catch (const CLI::CallForHelp&) {
        const auto chosen = app.get_subcommands();
        return TextArguments{chosen.empty() ? app.help() : chosen.front()->help()};
    } catch (const CLI::CallForAllHelp&) {
        return TextArguments{app.help("", CLI::AppFormatMode::All)};
    } catch (const CLI::CallForVersion&) {
        return TextArguments{version() + "\n"};
    } catch (const CLI::ParseError& error) {
        throw InputError("command line: " + one_line(error.what()) + " (see nsma --help)");
    }

    if (*scan_command) {
        scan.period = checked_period(period);
        if (method == "integers") scan.method = ScanMethod::integers;
        return scan;
    }
    if (*orbit_command) {
        orbit.solver.solvers = orbit_words.choice();
        if (!objective.empty()) orbit.objective = objective_named(objective);
        return orbit;
    }
    if (*sensitivity_command) {
        sensitivity.solver.solvers = sensitivity_words.choice();
        if (!sensitivity_objective.empty()) sensitivity.objective = objective_named(sensitivity_objective);
        return sensitivity;
    }
    if (*sweep_command) {
        sweep.solver.solvers = sweep_words.choice();
        return sweep;
    }
    if (*prove_command) {
        prove.period = checked_period(prove_period);
        return prove;
    }
    if (*check_command) return check;
    if (*export_command) return exported;
    if (*accuracy_command) return accuracy;
    return plot;
}

}  // namespace nsma::app
