#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "command.hpp"
#include "kind_counts.hpp"
#include "progress.hpp"

#include "nsma/search/pattern_problem.hpp"
#include "nsma/report/input_error.hpp"
#include "report/certificate_file.hpp"

namespace nsma::app {
namespace {

struct Counts {
    long done = 0;
    long proved = 0;
    long exact = 0;  // greatest energies
    KindCounts admissible;
};

void write_proof(const Pattern& pattern, int gap_sign, std::ostream& file, Counts& counts) {
    const PatternProblem problem = pattern_problem(pattern, gap_sign);
    const Proof& proof = problem.proof;
    ++counts.done;
    if (proof.verdict_proved) {
        file << certificate_json(proof.certificate) << '\n';
        ++counts.proved;
    } else {
        fmt::print(stderr, "nsma: ({}, {}): unproved: {}\n", pattern.free_steps, pattern.contact_steps, proof.unproved);
    }
    if (problem.verdict != Verdict::admissible) return;
    if (proof.exact_greatest() || gap_sign == 0) ++counts.exact;
    counts.admissible.add(*problem.kind);
}

}  // namespace

int run_prove(const Arguments& arguments, const std::atomic<bool>& stop) {
    const Scene scene = arguments.scene();
    const auto patterns = arguments.patterns(scene);
    if (std::filesystem::exists(arguments.out))
        throw InputError(arguments.out + ": expected a new file, got an existing one");
    const std::string part = arguments.out + ".part";
    std::ofstream file(part);
    if (!file) throw InputError(part + ": expected a file that can be written, got an error");

    Progress progress("prove", arguments.quiet);
    const auto total = static_cast<long>(patterns.size());
    Counts counts;
    while (counts.done < total && !stop.load()) {
        write_proof(patterns[static_cast<std::size_t>(counts.done)], scene.bar.gap_sign(), file, counts);
        progress.show(counts.done, total);
    }
    progress.clear();
    file.close();
    if (!file) throw InputError(part + ": expected room to write, got an error");
    const bool whole = counts.done == total;
    if (whole) {
        std::error_code code;
        std::filesystem::rename(part, arguments.out, code);
        if (code) throw InputError(arguments.out + ": cannot be written: " + code.message());
    }
    fmt::print("{} patterns, {} proved; {} admissible ({}), greatest energy exact for {}\n{} {}\n", counts.done,
               counts.proved, counts.admissible.total(), counts.admissible.text(), counts.exact,
               whole ? "certificates are in" : "interrupted: those so far are in", whole ? arguments.out : part);
    if (!whole) return exit_interrupted;
    return counts.proved == total ? exit_done : exit_solver;
}

int run_check(const Arguments& arguments, const std::atomic<bool>& stop) {
    std::ifstream file(arguments.input);
    if (!file || std::filesystem::is_directory(arguments.input)) {
        throw InputError(arguments.input + ": expected a file that can be read, got none");
    }
    long line_number = 0;
    long valid = 0;
    long rejected = 0;
    std::string line;
    while (!stop.load() && std::getline(file, line)) {
        ++line_number;
        if (line.empty()) continue;
        const std::string where = fmt::format("{}:{}", arguments.input, line_number);
        const Certificate certificate = parse_certificate(line, where);
        const CheckResult result = check(certificate);
        ++(result.valid ? valid : rejected);
        if (result.valid) continue;
        fmt::print("{}: ({}, {}, {}): rejected: {}\n", where, certificate.pattern.cells, certificate.pattern.free_steps,
                   certificate.pattern.contact_steps, result.reason);
    }
    if (stop.load()) return exit_interrupted;
    if (valid + rejected == 0) throw InputError(arguments.input + ": expected certificates, got none");
    fmt::print("{} certificates valid, {} rejected\n", valid, rejected);
    return rejected == 0 ? exit_done : exit_solver;
}

}  // namespace nsma::app
