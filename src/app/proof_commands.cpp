#include <algorithm>
#include <cmath>
#include <filesystem>
#include <tuple>

#include <fmt/format.h>

#include "command.hpp"
#include "kind_counts.hpp"
#include "progress.hpp"
#include "standard_streams.hpp"

#include "nsma/numerics/interruption.hpp"
#include "nsma/search/certified_optimum.hpp"
#include "nsma/search/orbit_solver.hpp"
#include "nsma/search/pattern_problem.hpp"
#include "nsma/report/input_error.hpp"
#include "report/certificate_file.hpp"
#include "report/input_file.hpp"
#include "report/results_folder.hpp"

namespace nsma::app {
namespace {

// Bytes; one of 10,000 columns has half a million.
constexpr std::size_t longest_certificate = 16u << 20U;

// The four integers that are the problem.
std::string problem_text(const Pattern& pattern, int gap_sign) {
    return fmt::format("({}, {}, {}, {})", pattern.cells, pattern.free_steps, pattern.contact_steps, gap_sign);
}

// Certified optima: how many, and how far the worst is from its bound.
struct OptimumCounts {
    long count = 0;
    double gap = 0;

    void add(const Optimum& optimum) {
        ++count;
        gap = std::max(gap, relative_gap(optimum));
    }
    [[nodiscard]] std::string text() const { return fmt::format("largest gap {:.1e}", gap); }
};

// The proofs of one run, in the order of its patterns.
class Proofs {
public:
    Proofs(const Scene& scene, const std::vector<Pattern>& patterns)
        : bar_(scene.bar), patterns_(patterns), gap_sign_(scene.bar.gap_sign()) {}

    /// Asks for the best orbit at an energy (E/E_unit) as well, of every contact motion that has one.
    void ask_optima(Objective objective, double energy) {
        request_.objective = objective;
        request_.level = energy;
    }

    [[nodiscard]] long done() const { return done_; }
    [[nodiscard]] long total() const { return static_cast<long>(patterns_.size()); }
    [[nodiscard]] bool finished() const { return done_ == total(); }
    [[nodiscard]] bool all_proved() const { return proved_ == total() && !open_; }
    [[nodiscard]] const Pattern& next() const { return patterns_[static_cast<std::size_t>(done_)]; }
    [[nodiscard]] std::string text() const {
        const std::string text = fmt::format("{} patterns, {} proved; {} admissible ({}), greatest energy exact for {}",
                                             done_, proved_, admissible_.total(), admissible_.text(), exact_);
        return request_.level ? fmt::format("{}\n{} best orbits proved, {}", text, optima_.count, optima_.text())
                              : text;
    }

    /// Throws unless the file, where there is one, holds nothing but certificates that this run writes again.
    void expect_replaceable(const std::string& path) const {
        if (std::error_code code; !std::filesystem::exists(path, code)) return;
        if (std::error_code code; !std::filesystem::is_regular_file(path, code))
            fail(path, "expected a file of certificates, got no regular file");
        std::vector<Pattern> own = patterns_;
        std::sort(own.begin(), own.end(), before);
        InputFile file(path, "a file of certificates");
        try {
            for (std::string line; file.line(line, longest_certificate);) {
                stop_point();
                const std::string where = fmt::format("line {}", file.line_number());
                const Certificate certificate = parse_certificate(line, where);
                if (certificate.gap_sign == gap_sign_ &&
                    std::binary_search(own.begin(), own.end(), certificate.pattern, before))
                    continue;
                throw InputError(fmt::format("{}: expected a pattern of this run, got {}", where,
                                             problem_text(certificate.pattern, certificate.gap_sign)));
            }
        } catch (const InputError& error) {
            fail(path, fmt::format("holds more than certificates of this run ({}); choose another file or remove it",
                                   error.what()));
        }
    }

    /// Takes in the certificates that an interrupted run left; the bytes of their lines, without one that is torn.
    /// Throws where this run would have written others.
    [[nodiscard]] std::uintmax_t take(const std::string& path) {
        InputFile file(path, "the certificates so far");
        const std::uintmax_t size = std::filesystem::file_size(path);
        std::uintmax_t taken = 0;
        for (std::string line; file.line(line, longest_certificate); taken += line.size() + 1) {
            stop_point();
            if (taken + line.size() == size) break;  // without its end
            const std::string where = fmt::format("line {}", file.line_number());
            std::optional<Certificate> certificate;
            try {
                certificate = parse_certificate(line, where);
            } catch (const InputError& error) {
                fail(path, fmt::format("is damaged ({}); --fresh begins anew", error.what()));
            }
            try {
                take(*certificate, where);
            } catch (const InputError& error) {
                fail(path, fmt::format("is of another run ({}); --fresh begins anew", error.what()));
            }
        }
        return taken;
    }

    /// Proves the next pattern; without a certificate it has said why.
    [[nodiscard]] std::optional<Certificate> prove_next() {
        const Pattern& pattern = next();
        PatternProblem problem = pattern_problem(pattern, gap_sign_);
        Proof& proof = problem.proof;
        if (problem.verdict == Verdict::admissible) count(proof, *problem.kind);
        if (request_.level && has_optimum(problem)) prove_optimum(problem);
        ++done_;
        if (proof.verdict_proved) {
            ++proved_;
            return std::move(proof.certificate);
        }
        say("({}, {}): unproved: {}", pattern.free_steps, pattern.contact_steps, proof.unproved);
        return std::nullopt;
    }

private:
    static bool before(const Pattern& a, const Pattern& b) {
        return std::tie(a.cells, a.free_steps, a.contact_steps) < std::tie(b.cells, b.free_steps, b.contact_steps);
    }

    void take(const Certificate& certificate, const std::string& where) {
        const auto refuse = [&where](const std::string& expected, const std::string& got) {
            throw InputError(fmt::format("{}: expected {}, got {}", where, expected, got));
        };
        const std::string got = problem_text(certificate.pattern, certificate.gap_sign);
        // A pattern before it that left no line must be one that cannot be proved.
        while (!finished() && (certificate.pattern != next() || certificate.gap_sign != gap_sign_)) {
            const std::string expected = problem_text(next(), gap_sign_);
            if (prove_next()) refuse("a certificate of " + expected, got);
        }
        if (finished()) refuse("no more certificates", got);
        if (const CheckResult result = check(certificate); !result.valid)
            refuse("a proof", "one that fails: " + result.reason);
        const Proof proof{certificate, true, {}};
        if (proof.certificate.claim == Certificate::Claim::nonempty) count(proof, *proof.certificate.kind);
        if (proof.certificate.optimum) {
            const Optimum& optimum = *proof.certificate.optimum;
            const auto objective =
                request_.objective == Objective::least_shock ? Optimum::Of::least_shock : Optimum::Of::least_force;
            if (!request_.level || optimum.energy != decimal(*request_.level) || optimum.objective != objective)
                refuse("no optimum of another objective or energy", got + " with one");
            optima_.add(optimum);
        } else if (request_.level) {
            PatternProblem problem = pattern_problem(next(), gap_sign_);
            if (has_optimum(problem) && certified_optimum(problem, best(problem)).certificate)
                refuse("an optimum of " + got, "none");
        }
        ++done_;
        ++proved_;
    }

    [[nodiscard]] bool has_optimum(const PatternProblem& problem) const {
        return problem.kind == PatternKind::contact && !outside(problem.interval, *request_.level);
    }

    [[nodiscard]] OrbitAnswer best(const PatternProblem& problem) { return solver_.solve(bar_, problem, request_); }

    void prove_optimum(PatternProblem& problem) {
        OptimumProof found = certified_optimum(problem, best(problem));
        if (!found.certificate) {
            open_ = true;
            const Pattern& pattern = problem.kernel.pattern;
            say("({}, {}): best orbit unproved: {}", pattern.free_steps, pattern.contact_steps, found.unproved);
            return;
        }
        optima_.add(*found.certificate->optimum);
        problem.proof.certificate = std::move(*found.certificate);
    }

    void count(const Proof& proof, PatternKind kind) {
        if (proof.exact_greatest() || gap_sign_ == 0) ++exact_;
        admissible_.add(kind);
    }

    const Bar& bar_;
    const std::vector<Pattern>& patterns_;
    int gap_sign_;
    long done_ = 0;
    long proved_ = 0;
    long exact_ = 0;  // greatest energies
    OrbitSolver solver_;
    OrbitRequest request_;  // of the optima; without a level none are asked for
    OptimumCounts optima_;
    bool open_ = false;  // an optimum could not be proved
    KindCounts admissible_;
};

}  // namespace

int run_prove(const Arguments& arguments) {
    const Scene scene = arguments.scene();
    const auto patterns = arguments.patterns(scene);
    const std::string part = arguments.out + ".part";
    Proofs proofs(scene, patterns);
    if (arguments.energy) {
        if (scene.objective != Objective::least_shock && scene.objective != Objective::least_force) {
            throw InputError(fmt::format("command line: --objective: expected least-shock or least-force, got {}",
                                         name(scene.objective)));
        }
        proofs.ask_optima(scene.objective, *arguments.level(scene));
    }
    if (std::error_code code; !arguments.resume && !arguments.fresh && std::filesystem::exists(part, code)) {
        throw InputError(
            part + ": is an interrupted run: expected --resume to go on with it or --fresh to begin anew, got none");
    }
    proofs.expect_replaceable(arguments.out);
    PartFile file(arguments.out, PartFile::Old::kept);
    try {
        file.cut(arguments.resume ? proofs.take(part) : 0);
        Progress progress("prove", arguments.quiet, static_cast<double>(proofs.done()));
        while (!proofs.finished()) {
            stop_point();
            progress.show(static_cast<double>(proofs.done()), static_cast<double>(proofs.total()), proofs.next());
            if (const auto certificate = proofs.prove_next()) file.write(certificate_json(*certificate) + "\n");
        }
    } catch (const Interrupted&) {
    }
    file.close();
    const bool whole = proofs.finished();
    if (whole) file.put_in_place();
    fmt::print("{}\n{} {}\n", proofs.text(), whole ? "certificates are in" : "interrupted: those so far are in",
               whole ? arguments.out : part);
    if (!whole) return exit_interrupted;
    return proofs.all_proved() ? exit_done : exit_solver;
}

int run_check(const Arguments& arguments) {
    InputFile file(arguments.input, "a file of certificates");
    long valid = 0;
    long rejected = 0;
    OptimumCounts optima;
    std::string line;
    while (file.line(line, longest_certificate)) {
        stop_point();
        if (line.empty()) continue;
        const std::string where = fmt::format("{}:{}", arguments.input, file.line_number());
        const Certificate certificate = parse_certificate(line, where);
        const CheckResult result = check(certificate);
        ++(result.valid ? valid : rejected);
        if (result.valid && certificate.optimum) optima.add(*certificate.optimum);
        if (result.valid) continue;
        fmt::print("{}: ({}, {}, {}): rejected: {}\n", where, certificate.pattern.cells, certificate.pattern.free_steps,
                   certificate.pattern.contact_steps, result.reason);
    }
    if (valid + rejected == 0) throw InputError(arguments.input + ": expected certificates, got none");
    fmt::print("{} certificates valid, {} rejected\n", valid, rejected);
    if (optima.count > 0) fmt::print("{} best orbits among them, {}\n", optima.count, optima.text());
    return rejected == 0 ? exit_done : exit_solver;
}

}  // namespace nsma::app
