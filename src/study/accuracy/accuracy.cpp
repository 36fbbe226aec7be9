#include "accuracy.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "accuracy_parts.hpp"
#include "program_methods.hpp"
#include "nsma/orbit/backbone.hpp"

namespace nsma {
namespace {

// Levels of the programs: at the first two no amplitude is zero and a polished answer is proved by the Lagrangian, at
// the last all but two are zero and only the closed form proves it.
constexpr double levels_of_least[] = {1.1, 1.3};  // times E_min
constexpr double levels_of_greatest[] = {0.8};    // times E_max
// Beyond this size a derivative-free method only meets its limit.
constexpr int derivative_free_limit = 32;
constexpr int quick_derivative_free_limit = 2;
constexpr double slow_run = 0.2;  // seconds; such work is not repeated

bool derivative_free(const ProgramMethod& method) {
    return method.kind == ProgramMethod::Kind::nlopt &&
           (method.nlopt == NloptMethod::cobyla || method.nlopt == NloptMethod::isres);
}

ProgramRecord measure(const ProgramMethod& method, const std::vector<ProgramCase>& cases, const AccuracySizes& sizes) {
    MethodRunner runner(method);
    ProgramRecord record;
    record.method = method.name;
    record.setting = method.setting();
    record.warm = method.warm;
    record.pattern = cases.front().problem.kernel.pattern;
    record.size = cases.front().problem.kernel.dimension();
    record.proved = true;
    std::vector<double> seconds;  // of a run, the mean over levels and starts; one for each repeat
    std::vector<double> iterations;
    const bool own_start = method.warm || method.whole();
    for (const auto& one : cases) record.proved = record.proved && one.proved;
    for (int repeat = 0; repeat < sizes.repeats; ++repeat) {
        double total = 0;
        int runs = 0;
        for (const auto& one : cases) {
            for (int start = 0; start < (own_start ? 1 : sizes.starts); ++start) {
                const Trial trial =
                    runner.run(one, one.program.program, one.program.point(one.points.start(start).value()));
                total += trial.seconds;
                ++runs;
                if (repeat > 0) continue;
                ++record.runs;
                if (trial.reported) ++record.reported;
                if (trial.outcome == Outcome::success) ++record.succeeded;
                if (trial.certified) ++record.certified;
                iterations.push_back(trial.iterations);
                record.worst_gap = std::max(record.worst_gap, trial.gap);
                record.worst_violation = std::max(record.worst_violation, trial.violation);
                record.error = std::max(record.error, trial.error());
            }
        }
        seconds.push_back(total / runs);
        if (seconds.back() > slow_run) break;
    }
    record.seconds = spread(seconds);
    record.iterations = spread(iterations).median;
    return record;
}

}  // namespace

AccuracySizes accuracy_sizes(const AccuracyOptions& options) {
    if (options.quick) return {{2, 8}, {2, 8}, {5, 10, 20}, {2, 8}, {10, 100}, 10, 1, 2};
    return {{2, 8, 32, 128},
            {2, 4, 8, 16, 32},
            {5, 10, 20, 40, 80, 160, 320},
            {2, 8, 32, 64},
            {10, 1'000, 100'000},
            20,
            5,
            3};
}

Pattern accuracy_pattern(int size, int gap_sign) {
    if (size < 2 || size % 2 != 0 || size > 2 * max_cells / 5) {
        throw std::invalid_argument("size: expected an even number >= 2, got " + std::to_string(size));
    }
    if (gap_sign == 0) throw std::invalid_argument("gap: expected one that is not zero, got 0");
    const int cells = 5 * size / 2;
    const int period = (gap_sign > 0 ? 8 : 7) * size;
    return {cells, 2 * (period - 2 * cells), 4 * cells - period};
}

void study_programs(AccuracyRun& run) {
    const auto methods = program_methods(run.quick);
    for (const int size : run.sizes.programs) {
        if (!run.go_on()) return;
        const PatternProblem problem =
            pattern_problem(accuracy_pattern(size, run.scene.bar.gap_sign()), run.scene.bar.gap_sign());
        const double least = problem.interval.least.value();
        const double greatest = problem.interval.greatest.value();
        std::vector<ProgramCase> cases;
        cases.reserve(std::size(levels_of_least) + std::size(levels_of_greatest));
        for (const double factor : levels_of_least) {
            cases.emplace_back(run.scene.bar, problem, run.scene.objective, factor * least);
        }
        for (const double factor : levels_of_greatest) {
            cases.emplace_back(run.scene.bar, problem, run.scene.objective, factor * greatest);
        }
        run.step();
        for (const auto& method : methods) {
            if (!run.go_on()) return;
            const int limit = run.quick ? quick_derivative_free_limit : derivative_free_limit;
            if (!derivative_free(method) || size <= limit) {
                run.sink.program(measure(method, cases, run.sizes));
            }
            run.step();
        }
    }
}

bool accuracy(const Scene& scene, const AccuracyOptions& options, AccuracySink& sink,
              const std::function<bool()>& keep_going) {
    validate(scene.bar);
    if (scene.bar.gap_sign() == 0) {
        throw std::invalid_argument(
            "gap: expected one that is not zero: a closed gap has no energy interval to study, got 0");
    }
    if (is_extreme(scene.objective)) {
        throw std::invalid_argument("objective: expected one at a given energy, got " +
                                    std::string(name(scene.objective)));
    }
    AccuracyRun run(scene, options, sink, keep_going);
    run.expect(static_cast<long>(run.sizes.programs.size() * (1 + program_methods(run.quick).size())));
    study_kernels(run);
    study_marching(run);
    study_programs(run);
    study_stability(run);
    return !run.ended;
}

}  // namespace nsma
