#include <array>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "commands.hpp"
#include "progress.hpp"

#include "nsma/search/orbit_solver.hpp"
#include "nsma/report/scene_file.hpp"
#include "report/certificate_file.hpp"

namespace nsma::app {
namespace {

std::vector<Pattern> chosen_patterns(const ProveArguments& arguments, Scene& scene) {
    if (arguments.free_steps) {
        return {{scene.mesh.cells, *arguments.free_steps, *arguments.contact_steps}};
    }
    if (arguments.period) scene.patterns = PeriodSelection{*arguments.period, std::nullopt};
    try {
        return patterns_of(scene);
    } catch (const std::invalid_argument& error) {
        throw InputError("command line: " + std::string(error.what()));
    }
}

}  // namespace

int run(const ProveArguments& arguments, const std::atomic<bool>& stop) {
    Scene scene = load_scene(arguments.scene);
    const auto patterns = chosen_patterns(arguments, scene);
    if (std::filesystem::exists(arguments.out)) {
        throw InputError(arguments.out + ": expected a new file, got an existing one");
    }
    const std::string part = arguments.out + ".part";
    std::ofstream file(part);
    if (!file) throw InputError(part + ": expected a file that can be written, got an error");

    long done = 0;
    long proved = 0;
    long exact = 0;
    long admissible = 0;
    std::array<long, pattern_kinds.size()> kinds{};
    {
        Progress progress("prove", arguments.quiet);
        for (const auto& pattern : patterns) {
            if (stop.load()) break;
            const PatternProblem problem = pattern_problem(pattern, scene.bar.gap_sign());
            const Proof& proof = problem.proof;
            ++done;
            if (proof.verdict_proved) {
                file << certificate_json(proof.certificate) << '\n';
                ++proved;
            } else {
                fmt::print(stderr, "nsma: ({}, {}): unproved: {}\n", pattern.free_steps, pattern.contact_steps,
                           proof.unproved);
            }
            if (problem.verdict == Verdict::admissible) {
                ++admissible;
                if (proof.exact_greatest() || scene.bar.gap_sign() == 0) ++exact;
                ++kinds.at(static_cast<std::size_t>(*problem.kind));
            }
            progress.show(done, static_cast<long>(patterns.size()));
        }
    }
    file.close();
    if (!file) throw InputError(part + ": expected room to write, got an error");
    const bool whole = done == static_cast<long>(patterns.size());
    if (whole) {
        std::error_code code;
        std::filesystem::rename(part, arguments.out, code);
        if (code) throw InputError(arguments.out + ": cannot be written: " + code.message());
    }
    fmt::print(
        "{} patterns, {} proved; {} admissible ({} contact, {} free, {} stuck), greatest energy exact for {}\n{} {}\n",
        done, proved, admissible, kinds[0], kinds[1], kinds[2], exact,
        whole ? "certificates are in" : "interrupted: those so far are in", whole ? arguments.out : part);
    std::fflush(stdout);
    if (!whole) return exit_interrupted;
    return proved == done ? exit_done : exit_solver;
}

int run(const CheckArguments& arguments, const std::atomic<bool>& stop) {
    std::ifstream file(arguments.file);
    if (!file || std::filesystem::is_directory(arguments.file)) {
        throw InputError(arguments.file + ": expected a file that can be read, got none");
    }
    long line_number = 0;
    long valid = 0;
    long rejected = 0;
    std::string line;
    while (!stop.load() && std::getline(file, line)) {
        ++line_number;
        if (line.empty()) continue;
        const std::string where = fmt::format("{}:{}", arguments.file, line_number);
        const Certificate certificate = parse_certificate(line, where);
        const CheckResult result = check(certificate);
        if (result.valid) {
            ++valid;
        } else {
            ++rejected;
            fmt::print("{}: ({}, {}, {}): rejected: {}\n", where, certificate.pattern.cells,
                       certificate.pattern.free_steps, certificate.pattern.contact_steps, result.reason);
        }
    }
    if (stop.load()) return exit_interrupted;
    if (valid + rejected == 0) throw InputError(arguments.file + ": expected certificates, got none");
    fmt::print("{} certificates valid, {} rejected\n", valid, rejected);
    std::fflush(stdout);
    return rejected == 0 ? exit_done : exit_solver;
}

}  // namespace nsma::app
