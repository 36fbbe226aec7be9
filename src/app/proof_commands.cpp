#include <filesystem>

#include <fmt/format.h>

#include "command.hpp"
#include "kind_counts.hpp"
#include "progress.hpp"
#include "standard_streams.hpp"

#include "nsma/numerics/interruption.hpp"
#include "nsma/search/pattern_problem.hpp"
#include "nsma/report/input_error.hpp"
#include "report/certificate_file.hpp"
#include "report/input_file.hpp"
#include "report/results_folder.hpp"

namespace nsma::app {
namespace {

// Bytes: of a chain of some 2,500 columns.
constexpr std::size_t longest_certificate = 256u << 20U;

struct Counts {
    long done = 0;
    long proved = 0;
    long exact = 0;  // greatest energies
    KindCounts admissible;
};

void write_proof(const Pattern& pattern, int gap_sign, PartFile& file, Counts& counts) {
    const PatternProblem problem = pattern_problem(pattern, gap_sign);
    const Proof& proof = problem.proof;
    ++counts.done;
    if (proof.verdict_proved) {
        file.write(certificate_json(proof.certificate) + "\n");
        ++counts.proved;
    } else {
        say("({}, {}): unproved: {}", pattern.free_steps, pattern.contact_steps, proof.unproved);
    }
    if (problem.verdict != Verdict::admissible) return;
    if (proof.exact_greatest() || gap_sign == 0) ++counts.exact;
    counts.admissible.add(*problem.kind);
}

}  // namespace

int run_prove(const Arguments& arguments) {
    const Scene scene = arguments.scene();
    const auto patterns = arguments.patterns(scene);
    if (std::error_code code; std::filesystem::exists(arguments.out, code))
        throw InputError(arguments.out + ": expected a new file, got an existing one");
    PartFile file(arguments.out);

    Progress progress("prove", arguments.quiet);
    const auto total = static_cast<long>(patterns.size());
    Counts counts;
    try {
        while (counts.done < total) {
            stop_point();
            write_proof(patterns[static_cast<std::size_t>(counts.done)], scene.bar.gap_sign(), file, counts);
            progress.show(static_cast<double>(counts.done), static_cast<double>(total));
        }
    } catch (const Interrupted&) {
    }
    progress.clear();
    file.close();
    const bool whole = counts.done == total;
    if (whole) file.put_in_place();
    fmt::print("{} patterns, {} proved; {} admissible ({}), greatest energy exact for {}\n{} {}\n", counts.done,
               counts.proved, counts.admissible.total(), counts.admissible.text(), counts.exact,
               whole ? "certificates are in" : "interrupted: those so far are in",
               whole ? arguments.out : arguments.out + ".part");
    if (!whole) return exit_interrupted;
    return counts.proved == total ? exit_done : exit_solver;
}

int run_check(const Arguments& arguments) {
    InputFile file(arguments.input, "a file of certificates");
    long valid = 0;
    long rejected = 0;
    std::string line;
    while (file.line(line, longest_certificate)) {
        stop_point();
        if (line.empty()) continue;
        const std::string where = fmt::format("{}:{}", arguments.input, file.line_number());
        const Certificate certificate = parse_certificate(line, where);
        const CheckResult result = check(certificate);
        ++(result.valid ? valid : rejected);
        if (result.valid) continue;
        fmt::print("{}: ({}, {}, {}): rejected: {}\n", where, certificate.pattern.cells, certificate.pattern.free_steps,
                   certificate.pattern.contact_steps, result.reason);
    }
    if (valid + rejected == 0) throw InputError(arguments.input + ": expected certificates, got none");
    fmt::print("{} certificates valid, {} rejected\n", valid, rejected);
    return rejected == 0 ? exit_done : exit_solver;
}

}  // namespace nsma::app
