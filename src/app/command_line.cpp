#include <algorithm>
#include <cmath>
#include <functional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "command.hpp"
#include "words.hpp"

#include "numerics/linear_program.hpp"
#include "numerics/solver.hpp"
#include "nsma/report/input_error.hpp"
#include "nsma/report/scene_file.hpp"
#include "report/did_you_mean.hpp"
#include "report/one_line.hpp"

namespace nsma::app {
namespace {

using Option = std::function<void(CLI::App& command, Arguments& arguments)>;

// Accepts the numbers that fit; `description` stands in the help, `expected` in the refusal. What is accepted is
// written so that the library, which takes 010 for eight, reads it as it was read here.
template <class Value, class Fits>
CLI::Validator number(const char* description, const std::string& expected, Fits fits) {
    return {[expected, fits](std::string& text) -> std::string {
                const auto value = number_in<Value>(text);
                if (!value || !fits(*value)) return "expected " + expected + ", got " + shortened(text);
                if constexpr (std::is_integral_v<Value>)
                    text = std::to_string(*value);
                else
                    text = fmt::format("{:a}", *value);
                return {};
            },
            description};
}

CLI::Validator finite() {
    return number<double>("NUMBER", "a finite number", [](double value) { return std::isfinite(value); });
}

CLI::Validator whole(int lo, int hi) {
    return number<std::int64_t>("INTEGER", fmt::format("a whole number in {}..{}", lo, hi),
                                [lo, hi](std::int64_t value) { return value >= lo && value <= hi; });
}

template <class Fits>
CLI::Validator word_of(const std::string& names, Fits fits) {
    return {[names, fits](const std::string& word) -> std::string {
                return fits(word) ? std::string() : "expected " + names + ", got " + shortened(word);
            },
            "NAME"};
}

Option text(const char* name, std::string Arguments::*value, const char* help) {
    return
        [=](CLI::App& command, Arguments& arguments) { command.add_option(name, arguments.*value, help)->required(); };
}

Option flag(const char* name, bool Arguments::*value, const char* help) {
    return [=](CLI::App& command, Arguments& arguments) { command.add_flag(name, arguments.*value, help); };
}

void bar_and_mesh(CLI::App& command, Arguments& arguments) {
    command.add_option("--cells", arguments.cells, "cells N instead of the scene's")->transform(whole(1, max_cells));
    command.add_option("--gap", arguments.gap, "gap d [m] instead of the scene's; negative: prestressed")
        ->transform(finite());
}

void period(CLI::App& command, Arguments& arguments) {
    const auto set = [&](const std::vector<double>& bounds) { arguments.period = {bounds.at(0), bounds.at(1)}; };
    command
        .add_option_function<std::vector<double>>("--period", set,
                                                  "periods LO HI in units of tau instead of the scene's patterns")
        ->expected(2)
        ->transform(finite());
}

void method(CLI::App& command, Arguments& arguments) {
    const auto set = [&](const std::string& word) {
        arguments.method = word == "integers" ? ScanMethod::integers : ScanMethod::certified;
    };
    command
        .add_option_function<std::string>(
            "--method", set, "certified (default: every verdict with its proof) or integers (verdicts alone)")
        ->check(CLI::IsMember({"certified", "integers"}));
}

// --free and --contact: one pattern, or unless `required` instead of the scene's.
Option pattern(bool required) {
    return [required](CLI::App& command, Arguments& arguments) {
        const std::string of_one = required ? "" : " of one pattern";
        const CLI::Validator steps = whole(1, max_period_steps / 2);
        auto* free = command.add_option("--free", arguments.free_steps, "free flight r [steps]" + of_one);
        auto* contact = command.add_option("--contact", arguments.contact_steps, "contact phase p [steps]" + of_one);
        free->transform(steps)->required(required);
        contact->transform(steps)->required(required);
        if (required) return;
        free->needs(contact);
        contact->needs(free);
        if (CLI::Option* period = command.get_option_no_throw("--period")) period->excludes(free);
    };
}

// `needs_pattern`: not without --free.
void add_energy(CLI::App& command, Arguments& arguments, const char* help, bool needs_pattern) {
    const auto set = [&](const std::string& word) {
        const auto [value, joules] = energy_in(word).value();
        arguments.energy = value;
        arguments.joules = joules;
    };
    auto* const option = command.add_option_function<std::string>("--energy", set, help);
    const auto refusal = [](const std::string& word) {
        return energy_in(word)
                   ? std::string()
                   : fmt::format("expected a number from {:g} to {:g}, in joules with a J behind it, got {}",
                                 least_level, greatest_level, shortened(word));
    };
    option->check({refusal, "NUMBER[J]"});
    if (needs_pattern) option->needs(command.get_option("--free"));
}

Option energy(const char* help, bool needs_pattern) {
    return [=](CLI::App& command, Arguments& arguments) { add_energy(command, arguments, help, needs_pattern); };
}

void objective(CLI::App& command, Arguments& arguments) {
    const std::string names = "least-shock, nearest, least-force, min-energy or max-energy";
    const auto set = [&](const std::string& word) { arguments.objective = objective_named(word); };
    command.add_option_function<std::string>("--objective", set, names + " instead of the scene's")
        ->check(word_of(names, [](const auto& word) { return objective_named(word).has_value(); }));
}

void solver(CLI::App& command, Arguments& arguments) {
    const auto known = [](const std::string& word) {
        return std::find_if(solver_choices.begin(), solver_choices.end(),
                            [&](const auto& choice) { return choice.first == word; });
    };
    command
        .add_option_function<std::string>(
            "--solver", [&, known](const std::string& word) { arguments.solver.solvers = known(word)->second; },
            "proof: closed forms, a solver only where they prove nothing (default); both: Ipopt and NLopt "
            "as well, against each other; ipopt; nlopt")
        ->check(word_of("ipopt, nlopt, both or proof",
                        [known](const auto& word) { return known(word) != solver_choices.end(); }));
    command
        .add_option(
            "--starts", arguments.solver.starts,
            "starts per solver while the optimum is not proved (default 8; a quarter of them above 64 unknowns)")
        ->transform(whole(1, 10'000));
}

// R,P or R,P,E: steps, and an energy as --energy has it.
void one_orbit(CLI::App& command, Arguments& arguments) {
    const auto set = [&arguments](const std::string& word) {
        const OrbitWord orbit = orbit_in(word).value();
        arguments.free_steps = orbit.free;
        arguments.contact_steps = orbit.contact;
        if (!orbit.energy) return;
        arguments.energy = orbit.energy->first;
        arguments.joules = orbit.energy->second;
    };
    command
        .add_option_function<std::string>("--orbit", set,
                                          "one stored orbit: free and contact steps, then an energy (E/E_g; with a J "
                                          "behind it joules), without one its least-energy orbit")
        ->check({[](const std::string& word) {
                     return orbit_in(word) ? std::string()
                                           : "expected R,P or R,P,ENERGY such as 60,10,12.6, got " + shortened(word);
                 },
                 "R,P[,E]"});
}

void drawing(CLI::App& command, Arguments& arguments) {
    const auto known = [](const std::string& word) {
        const auto formats = parts(word);
        return std::all_of(formats.begin(), formats.end(), [](const std::string& format) {
            return std::find(picture_formats.begin(), picture_formats.end(), format) != picture_formats.end();
        });
    };
    command
        .add_option_function<std::string>(
            "--format", [&arguments](const std::string& word) { arguments.drawing.formats = parts(word); },
            "svg, png, pdf or several, as svg,pdf (default svg,png)")
        ->check(word_of("svg, png, pdf or several with commas between", known));
    const auto set = [&arguments](const std::string& word) {
        const auto size = size_in(word).value();
        arguments.drawing.width = size[0];
        arguments.drawing.height = size[1];
    };
    command
        .add_option_function<std::string>(
            "--size", set,
            "WIDTH or WIDTHxHEIGHT in pixels, of a PDF in points (1/72 inch); letters and "
            "lines grow with the width")
        ->check({[](const std::string& word) {
                     return size_in(word) ? std::string()
                                          : "expected WIDTH or WIDTHxHEIGHT of 100 to 20000, such as 1600x1000, got " +
                                                shortened(word);
                 },
                 "W[xH]"});
}

// What `march` begins with besides an orbit.
void start(CLI::App& command, Arguments& arguments) {
    command.add_option("--state", arguments.state,
                       "CSV file of a state: stress_pa,velocity_m_s of each cell from the held end on");
    command.add_option("--perturb", arguments.perturb, "move the start by this share of its energy norm (0 to 1)")
        ->transform(finite())
        ->check(CLI::Range(0.0, 1.0));
    command.add_option("--periods", arguments.periods, "periods to march (default 100; of --state of 4 L/c)")
        ->transform(whole(1, 10'000'000));
}

struct Entry {
    const char* name;
    const char* summary;
    std::vector<Option> options;
    const char* examples;
    Run* run;
};

std::vector<Entry> commands() {
    const Option scene = text("SCENE", &Arguments::input, "scene file (TOML)");
    const Option folder = text("DIR", &Arguments::input, "folder that nsma wrote");
    const Option out_folder = text("--out", &Arguments::out, "folder for the results; made if missing");
    const Option all_kinds =
        flag("--all-kinds", &Arguments::all_kinds,
             "also solve patterns whose orbits never press against the wall (free) or never leave it (stuck)");
    const Option certify =
        flag("--certify", &Arguments::certify,
             "certify in exact arithmetic how good every orbit is: certificates.jsonl, for nsma check");
    const Option distinct = flag("--distinct", &Arguments::distinct,
                                 "leave out of levels.csv and orbits.jsonl what a row above has under another label");
    const Option quiet = flag("--quiet", &Arguments::quiet, "no progress on stderr");
    const Option resume = [](CLI::App& command, Arguments& arguments) {
        auto* const old = command.add_flag("--resume", arguments.resume, "go on with what an interrupted run left");
        command.add_flag("--fresh", arguments.fresh, "begin anew, also where an interrupted run could be gone on with")
            ->excludes(old);
    };
    return {
        {"scan",
         "list the patterns (r, p) with a nontrivial kernel, their verdicts and energy intervals",
         {scene, bar_and_mesh, period, method, flag("--csv", &Arguments::csv, "CSV on stdout instead of a table"),
          quiet},
         "Examples:\n"
         "  nsma scan problems/first-mode.toml\n"
         "  nsma scan problems/first-mode.toml --cells 6 --gap 1 --period 0 4 --csv",
         run_scan},
        {"orbit",
         "one orbit of one pattern",
         {scene, bar_and_mesh, pattern(true),
          energy("energy E/E_g, or in joules with a J behind it: 12.6, 0.8J; without it the least-energy orbit", false),
          objective, solver, flag("--json", &Arguments::json, "one JSON object on stdout instead of text"),
          [](CLI::App& command, Arguments& arguments) {
              command.add_option("--out", arguments.out,
                                 "folder for the orbit's charts, orbit-curves.csv and orbit.json");
          },
          flag("--verbose", &Arguments::verbose, "also what presolve took from the conditions")},
         "Examples:\n"
         "  nsma orbit problems/first-mode.toml --free 48 --contact 16\n"
         "  nsma orbit problems/first-mode.toml --cells 6 --free 16 --contact 4 --energy 12 --json",
         run_orbit},
        {"sweep",
         "every pattern of the scene at every energy level: table, orbits, charts",
         {scene, bar_and_mesh, out_folder, solver, all_kinds, certify, distinct, resume, quiet},
         "Examples:\n"
         "  nsma sweep problems/first-mode.toml --out out/first-mode\n"
         "  nsma sweep problems/first-mode.toml --out out/first-mode --resume",
         run_sweep},
        {"export",
         "write the tables of a folder again from what it stores",
         {folder, distinct,
          flag("--curves", &Arguments::curves, "also curves.csv: motion and force of every orbit, row by row")},
         "Example:\n  nsma export out/first-mode --curves",
         run_export},
        {"report",
         "write a folder's results as one page of HTML: click, zoom, play, share",
         {folder,
          [](CLI::App& command, Arguments& arguments) {
              command.add_option("--out", arguments.out, "file to write instead of report.html in the folder");
          }},
         "Examples:\n"
         "  nsma report out/first-mode\n"
         "  nsma report out/first-mode --out first-mode.html",
         run_report},
        {"forced",
         "sweep the frequency of a force on the tip: the response, up and down, over the modes",
         {scene, bar_and_mesh, out_folder, resume, quiet},
         "Examples:\n"
         "  nsma forced problems/forced-first-mode.toml --out out/forced\n"
         "  nsma forced problems/forced-first-mode.toml --out out/forced --resume",
         run_forced},
        {"march",
         "let the bar go from an orbit or any other state, and see what it does",
         {scene, bar_and_mesh, pattern(false),
          energy("energy of the orbit, E/E_g or in joules with a J behind it; without it its least energy", true),
          objective, start},
         "Examples:\n"
         "  nsma march problems/first-mode.toml --free 60 --contact 10 --energy 12.6\n"
         "  nsma march problems/first-mode.toml --free 60 --contact 10 --perturb 1e-3 --periods 1000",
         run_march},
        {"accuracy",
         "speed against accuracy: every method on the same work, and where each fails",
         {scene, out_folder, flag("--quick", &Arguments::quick, "small sizes and few runs: seconds instead of minutes"),
          quiet},
         "Example:\n  nsma accuracy problems/first-mode.toml --out out/accuracy",
         run_accuracy},
        {"sensitivity",
         "which condition decides, how much, and what happens when it is relaxed",
         {scene, pattern(false),
          energy("energy of one pattern, E/E_g or in joules with a J behind it; without it its least energy", true),
          objective, out_folder, solver, all_kinds, quiet},
         "Examples:\n"
         "  nsma sensitivity problems/first-mode.toml --out out/sensitivity\n"
         "  nsma sensitivity problems/first-mode.toml --free 48 --contact 16 --energy 30 --out out/one",
         run_sensitivity},
        {"plot",
         "draw the charts of a folder again, or of one orbit of a sweep",
         {folder, one_orbit, drawing, flag("--quiet", &Arguments::quiet, "print no list of charts")},
         "Examples:\n"
         "  nsma plot out/first-mode\n"
         "  nsma plot out/first-mode --orbit 60,10,12.6 --format pdf --size 480x300",
         run_plot},
        {"prove",
         "write exact certificates of the verdicts and energy intervals, one a line",
         {scene, bar_and_mesh, period, pattern(false),
          energy("energy E/E_g, or in joules with a J behind it, at which the best orbits are certified too", false),
          objective, text("--out", &Arguments::out, "file to write; until it is complete FILE.part"), resume, quiet},
         "Examples:\n"
         "  nsma prove problems/first-mode.toml --cells 6 --free 16 --contact 4 --out proof.jsonl\n"
         "  nsma prove problems/first-mode.toml --cells 24 --period 0 4 --out proofs.jsonl\n"
         "  nsma prove problems/first-mode.toml --energy 12.6 --out optima.jsonl",
         run_prove},
        {"check",
         "verify certificates from their four integers alone, in exact arithmetic",
         {text("FILE", &Arguments::input, "certificates written by nsma prove")},
         "Example:\n  nsma check proofs.jsonl",
         run_check},
    };
}

// Of what a command does not take the option, or else the first word.
std::string unknown_of(const CLI::App& command) {
    const auto words = command.remaining();
    auto word = std::find_if(words.begin(), words.end(), [](const auto& one) { return one.starts_with("--"); });
    if (word == words.end()) word = words.begin();
    std::vector<std::string> options;
    for (const CLI::Option* option : command.get_options()) {
        if (!option->get_positional()) options.push_back(option->get_name());
    }
    return fmt::format("expected an option of {}, got {}{}", command.get_name(), shortened(*word),
                       did_you_mean(*word, options));
}

// All that a command needs and was not given.
std::string missing_of(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options()) {
        if (option->get_required() && option->count() == 0) names.push_back(option->get_name());
    }
    return fmt::format("{}", fmt::join(names, ", "));
}

constexpr const char* examples_and_exit_codes =
    "Examples:\n"
    "  nsma scan problems/first-mode.toml --cells 6 --period 0 4\n"
    "  nsma orbit problems/first-mode.toml --free 48 --contact 16 --energy 37.5\n"
    "  nsma sweep problems/first-mode.toml --out out/first-mode\n"
    "  nsma sensitivity problems/first-mode.toml --out out/sensitivity\n"
    "  nsma plot out/first-mode\n"
    "  nsma prove problems/first-mode.toml --out proofs.jsonl\n"
    "  nsma check proofs.jsonl\n"
    "Exit: 0 done, 2 bad usage, scene or file, 3 nothing admissible, 4 a solver failed, the two\n"
    "disagree beyond tolerance or a proof does not hold, 130 interrupted or 143 terminated\n"
    "(what was done is kept; a second signal ends at once). At most 10 million patterns, and\n"
    "a thousand million levels over all of them.";

}  // namespace

std::string version() {
    return "nsma " NSMA_VERSION " (Ipopt " + ipopt_version() + ", NLopt " + nlopt_version() + ", CLP " + clp_version() +
           ")";
}

std::optional<Command> read_command_line(int count, const char* const* words) {
    CLI::App app{"Nonsmooth modal analysis of a bar in unilateral contact, by the Wave Finite Element Method.", "nsma"};
    app.require_subcommand(1);
    app.set_version_flag("--version", version());
    app.footer(examples_and_exit_codes);
    Command chosen;
    std::vector<const char*> names;
    for (const Entry& entry : commands()) {
        names.push_back(entry.name);
        CLI::App* command = app.add_subcommand(entry.name, entry.summary);
        for (const Option& option : entry.options) option(*command, chosen.arguments);
        command->footer(entry.examples);
        command->failure_message(CLI::FailureMessage::simple);
        command->callback([&chosen, run = entry.run] { chosen.run = run; });
    }
    const std::string_view word = count > 1 ? words[1] : "none";
    const bool asks = word == "--help" || word == "-h" || word == "--version";
    if (!asks && std::find(names.begin(), names.end(), word) == names.end()) {
        throw InputError(
            one_line(fmt::format("command line: expected one of {}, got {}{} (see nsma --help)", fmt::join(names, ", "),
                                 shortened(std::string(word)), did_you_mean(word, names))));
    }
    try {
        app.parse(count, words);
        return chosen;
    } catch (const CLI::CallForHelp&) {
        const auto named = app.get_subcommands();
        fmt::print("{}", named.empty() ? app.help() : named.front()->help());
    } catch (const CLI::CallForAllHelp&) {
        fmt::print("{}", app.help("", CLI::AppFormatMode::All));
    } catch (const CLI::CallForVersion&) {
        fmt::print("{}\n", version());
    } catch (const CLI::ParseError& error) {
        const auto named = app.get_subcommands();
        std::string message = error.what();
        while (message.ends_with(' ') || message.ends_with('\n')) message.pop_back();
        if (!named.empty() && !named.front()->remaining().empty())
            message = unknown_of(*named.front());
        else if (const std::string missing = named.empty() ? "" : missing_of(*named.front()); !missing.empty())
            message = "expected " + missing + " as well";
        throw InputError(one_line(fmt::format("command line: {} (see nsma {}--help)", message,
                                              named.empty() ? "" : named.front()->get_name() + " ")));
    }
    return std::nullopt;
}

}  // namespace nsma::app
