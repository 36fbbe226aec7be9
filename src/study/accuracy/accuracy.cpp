#include "accuracy.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "accuracy_parts.hpp"
#include "program_methods.hpp"

namespace nsma {
namespace {

// Beyond this size a derivative-free method only meets its limit.
constexpr int derivative_free_limit = 32;
constexpr int quick_derivative_free_limit = 2;
constexpr double slow_solve = 0.2;  // seconds; such work is not repeated

AccuracySizes accuracy_sizes(bool quick) {
    if (quick) {
        return {.programs = {2, 8},
                .maps = {2, 8},
                .cells = {5, 10, 20},
                .kernels = {2, 8},
                .periods = {10, 100},
                .drift_cells = 10,
                .repeats = 1,
                .starts = 2};
    }
    return {.programs = {2, 8, 32, 128},
            .maps = {2, 4, 8, 16, 32},
            .cells = {5, 10, 20, 40, 80, 160, 320},
            .kernels = {2, 8, 32, 64},
            .periods = {10, 1'000, 100'000},
            .drift_cells = 20,
            .repeats = 5,
            .starts = 3};
}

ProgramRecord measure(const ProgramMethod& method, const std::vector<ProgramCase>& cases, const AccuracySizes& sizes) {
    std::vector<std::pair<const ProgramCase*, Eigen::VectorXd>> work;  // with the start
    for (const ProgramCase& on : cases) {
        if (method.warm) work.emplace_back(&on, warm_start(on));
        const int starts = method.warm ? 0 : method.whole() ? 1 : sizes.starts;
        for (int k = 0; k < starts; ++k) work.emplace_back(&on, on.program.point(on.points.start(k).value()));
    }
    MethodRunner runner(method);
    std::vector<Trial> trials;
    const auto seconds_a_run = [&] {
        trials.clear();
        double total = 0;
        for (const auto& [on, start] : work) {
            trials.push_back(runner.run(*on, on->program.program, start));
            total += trials.back().seconds;
        }
        return total / static_cast<double>(work.size());
    };
    ProgramRecord record;
    record.seconds = repeated(sizes.repeats, seconds_a_run, slow_solve);
    static_cast<MethodRuns&>(record) = counted(cases.front(), method.name(), trials);
    record.proved = std::all_of(cases.begin(), cases.end(), [](const auto& on) { return on.proved; });
    record.setting = method.setting();
    record.warm = method.warm;
    for (const Trial& trial : trials) {
        record.worst_gap = std::max(record.worst_gap, trial.gap);
        record.worst_violation = std::max(record.worst_violation, trial.violation);
        record.error = std::max(record.error, trial.error());
    }
    return record;
}

}  // namespace

Pattern accuracy_pattern(int size, int gap_sign) {
    if (size < 2 || size % 2 != 0 || size > 2 * max_cells / 5) {
        throw std::invalid_argument(fmt::format("size: expected an even number >= 2, got {}", size));
    }
    if (gap_sign == 0) throw std::invalid_argument("gap: expected one that is not zero, got 0");
    const int cells = 5 * size / 2;
    const int period = (gap_sign > 0 ? 8 : 7) * size;
    return {cells, 2 * (period - 2 * cells), 4 * cells - period};
}

void study_programs(AccuracyRun& run) {
    const Bar& bar = run.scene.bar;
    for (const int size : run.sizes.programs) {
        if (!run.go_on()) return;
        const PatternProblem problem = pattern_problem(accuracy_pattern(size, bar.gap_sign()), bar.gap_sign());
        const double least = problem.interval.least.value();
        const double greatest = problem.interval.greatest.value();
        // At the first two levels no amplitude is zero and a polished answer is proved by the Lagrangian, at the last
        // all but two are zero and only the closed form proves it.
        std::vector<ProgramCase> cases;
        for (const double level : {1.1 * least, 1.3 * least, 0.8 * greatest}) {
            cases.push_back(solved_case(bar, problem, run.scene.objective, level));
        }
        ++run.done;
        const int limit = run.quick ? quick_derivative_free_limit : derivative_free_limit;
        for (const auto& method : program_methods(run.quick)) {
            if (!run.go_on()) return;
            if (!method.derivative_free() || size <= limit) run.add(measure(method, cases, run.sizes));
            ++run.done;
        }
    }
}

bool accuracy(const Scene& scene, bool quick, const std::function<void(const AccuracyRecord&)>& add,
              const std::function<bool(long done, long total)>& go_on) {
    validate(scene.bar);
    if (scene.bar.gap_sign() == 0) {
        throw std::invalid_argument(
            "gap: expected one that is not zero: a closed gap has no energy interval to study, got 0");
    }
    if (is_extreme(scene.objective)) {
        throw std::invalid_argument(
            fmt::format("objective: expected one at a given energy, got {}", name(scene.objective)));
    }
    AccuracyRun run{scene, quick, accuracy_sizes(quick), add, go_on};
    run.total = static_cast<long>(run.sizes.programs.size() * (1 + program_methods(quick).size()));
    study_kernels(run);
    study_marching(run);
    study_programs(run);
    study_stability(run);
    return !run.ended;
}

}  // namespace nsma
