// How time grows with the mesh: run by run.sh, which fits the exponents. The number after the slash is what the time
// is fitted against.

#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <numeric>
#include <sstream>
#include <utility>

#include <benchmark/benchmark.h>

#include "../orbit/dense_kernel.hpp"
#include "../support/sieve_all.hpp"
#include "nsma/wave/marcher.hpp"
#include "wave/dense_wfem.hpp"
#include "wave/driven_bar.hpp"
#include "nsma/orbit/sieve.hpp"
#include "numerics/freed_memory.hpp"
#include "numerics/solver.hpp"
#include "set/level_points.hpp"
#include "nsma/search/certified_optimum.hpp"
#include "nsma/search/orbit_solver.hpp"
#include "nsma/search/pattern_problem.hpp"
#include "search/orbit_program.hpp"
#include "nsma/study/scan.hpp"
#include "study/accuracy/accuracy.hpp"
#include "study/sweep/sweep_queue.hpp"
#include "study/sweep/work_messages.hpp"
#include "report/sweep/sweep_store.hpp"

namespace {

using namespace nsma;

// What a run came to. Not counters: the table of CSV refuses those that not every benchmark has.
void label(benchmark::State& state, std::initializer_list<std::pair<const char*, double>> values) {
    std::ostringstream text;
    for (const auto& [name, value] : values) text << (text.str().empty() ? "" : " ") << name << ' ' << value;
    state.SetLabel(text.str());
}

const bool as_in_the_program = (keep_freed_memory(), true);

// Every pattern with n_T <= 4N: 8 N^2 of them.
void sieve(benchmark::State& state) {
    const int cells = static_cast<int>(state.range(0));
    long patterns = 0;
    for (auto _ : state) patterns = sieve_all(cells, 1, 4 * cells).patterns();
    label(state, {{"patterns", static_cast<double>(patterns)}});
}
BENCHMARK(sieve)->Arg(125)->Arg(250)->Arg(500)->Arg(1000)->Unit(benchmark::kMillisecond);

// Verdict and energy interval of each of them that the sieve leaves; of each with an exact proof.
void scan_all(benchmark::State& state, const PatternSelection& patterns, ScanMethod method) {
    Scene scene;
    scene.mesh.cells = static_cast<int>(state.range(0));
    scene.patterns = patterns;
    long admissible = 0, failed = 0;
    for (auto _ : state) {
        admissible = failed = 0;
        scan(
            scene,
            [&](const PatternRecord& record) {
                admissible += record.verdict == Verdict::admissible;
                failed += record.verdict == Verdict::failed;
            },
            [] { return true; }, method);
    }
    label(state, {{"admissible", static_cast<double>(admissible)}, {"failed", static_cast<double>(failed)}});
}
const PatternSelection spectrum = PeriodSelection{{0.0, 4.0}, std::nullopt};
const PatternSelection first_mode = ModeSelection{1};
void scan_integers(benchmark::State& state) { scan_all(state, spectrum, ScanMethod::integers); }
void scan_certified(benchmark::State& state) { scan_all(state, spectrum, ScanMethod::certified); }
void mode_integers(benchmark::State& state) { scan_all(state, first_mode, ScanMethod::integers); }
void mode_certified(benchmark::State& state) { scan_all(state, first_mode, ScanMethod::certified); }
BENCHMARK(scan_integers)->Arg(25)->Arg(50)->Arg(64)->Arg(100)->Unit(benchmark::kMillisecond);
BENCHMARK(scan_certified)->Arg(25)->Arg(50)->Arg(64)->Arg(100)->Unit(benchmark::kMillisecond);
BENCHMARK(mode_integers)->Arg(250)->Arg(500)->Arg(1000)->Unit(benchmark::kMillisecond);
BENCHMARK(mode_certified)->Arg(250)->Arg(500)->Arg(1000)->Unit(benchmark::kMillisecond);

// The kernel of (16 N/6, 4 N/6), m = N/1.5, by cycles and by singular values of the literal matrix.
Pattern proportional(int cells) { return {cells, 16 * cells / 6, 4 * cells / 6}; }

void kernel_exact(benchmark::State& state) {
    const Pattern pattern = proportional(static_cast<int>(state.range(0)));
    for (auto _ : state) benchmark::DoNotOptimize(exact_kernel(pattern).dimension());
}
BENCHMARK(kernel_exact)->Arg(12)->Arg(24)->Arg(48)->Arg(96)->Arg(768)->Unit(benchmark::kMicrosecond);

void kernel_dense(benchmark::State& state) {
    const Pattern pattern = proportional(static_cast<int>(state.range(0)));
    for (auto _ : state) benchmark::DoNotOptimize(dense::svd_kernel(Bar{}, pattern).cols());
}
BENCHMARK(kernel_dense)->Arg(12)->Arg(24)->Arg(48)->Arg(96)->Unit(benchmark::kMicrosecond);

// One period of 4 tau from the least-energy orbit of mode 1: the queue, and matrix times vector.
Orbit some_orbit(int cells) {
    const Kernel kernel = exact_kernel(proportional(cells));
    const Eigen::VectorXd row = contact_row(kernel).cast<double>();
    return make_orbit(Bar{}, kernel, row / row.squaredNorm());
}

void march_queue(benchmark::State& state) {
    const int cells = static_cast<int>(state.range(0));
    const Orbit orbit = some_orbit(cells);
    const State start = initial_state(orbit);
    for (auto _ : state) {
        benchmark::DoNotOptimize(march(orbit.bar, Mesh{cells}, start, orbit.kernel.pattern.period_steps()).periods);
    }
}
BENCHMARK(march_queue)->Arg(24)->Arg(48)->Arg(96)->Arg(192)->Unit(benchmark::kMicrosecond);

// The same steps of a bar under a force, with a dashpot and with damped cells; and of the literal cell update, without.
void march_driven(benchmark::State& state, Damping::Kind kind) {
    const int cells = static_cast<int>(state.range(0));
    const Orbit orbit = some_orbit(cells);
    DrivenBar bar(orbit.bar, Mesh{cells}, initial_state(orbit), {kind, 0.01});
    for (auto _ : state) {
        for (int n = 0; n < orbit.kernel.pattern.period_steps(); ++n)
            benchmark::DoNotOptimize(bar.step(n % 2 == 0 ? 0.01 : -0.01).tip_velocity);
    }
}
void march_tip(benchmark::State& state) { march_driven(state, Damping::Kind::tip); }
void march_distributed(benchmark::State& state) { march_driven(state, Damping::Kind::distributed); }
void march_cells(benchmark::State& state) {
    const int cells = static_cast<int>(state.range(0));
    const Orbit orbit = some_orbit(cells);
    const Pattern& pattern = orbit.kernel.pattern;
    State now = initial_state(orbit);
    for (auto _ : state) {
        for (int n = 0; n < pattern.period_steps(); ++n)
            dense::cell_step(orbit.bar, Mesh{cells}, n >= pattern.free_steps, now);
        benchmark::DoNotOptimize(now.data());
    }
}
BENCHMARK(march_tip)->Arg(24)->Arg(48)->Arg(96)->Arg(192)->Unit(benchmark::kMicrosecond);
BENCHMARK(march_distributed)->Arg(24)->Arg(48)->Arg(96)->Arg(192)->Unit(benchmark::kMicrosecond);
BENCHMARK(march_cells)->Arg(24)->Arg(48)->Arg(96)->Arg(192)->Unit(benchmark::kMicrosecond);

void march_dense(benchmark::State& state) {
    const int cells = static_cast<int>(state.range(0));
    const Orbit orbit = some_orbit(cells);
    const State start = initial_state(orbit);
    const Eigen::MatrixXd free = dense::free_step_matrix(orbit.bar, Mesh{cells});
    const Eigen::MatrixXd contact = dense::contact_step_matrix(orbit.bar, Mesh{cells});
    for (auto _ : state) {
        State now = start;
        for (int n = 0; n < orbit.kernel.pattern.free_steps; ++n) now = free * now;
        for (int n = 0; n < orbit.kernel.pattern.contact_steps; ++n) now = contact * now;
        benchmark::DoNotOptimize(now.data());
    }
}
BENCHMARK(march_dense)->Arg(24)->Arg(48)->Arg(96)->Arg(192)->Unit(benchmark::kMicrosecond);

// One call of one solver on the first-mode pattern of m amplitudes at half its interval (in logarithm).
void solve(benchmark::State& state, bool with_ipopt) {
    const PatternProblem problem =
        pattern_problem(accuracy_pattern(static_cast<int>(state.range(0)), 1), 1, {.prove = false});
    const double level = std::sqrt(*problem.interval.least * *problem.interval.greatest);
    const OrbitProgram program = orbit_program(problem.set.reduction, problem.kernel, Objective::least_shock, level);
    const LevelPoints points(problem.set, level);
    const Eigen::VectorXd start = program.point(*points.start(1));
    IpoptSolver ipopt;
    int iterations = 0;
    for (auto _ : state) {
        iterations = with_ipopt ? ipopt.solve(program.program, start).iterations
                                : solve_with_nlopt(NloptMethod::slsqp, program.program, start).iterations;
    }
    label(state, {{"iterations", static_cast<double>(iterations)}});
}
void solve_ipopt(benchmark::State& state) { solve(state, true); }
void solve_nlopt(benchmark::State& state) { solve(state, false); }
BENCHMARK(solve_ipopt)->Arg(8)->Arg(16)->Arg(32)->Arg(64)->Unit(benchmark::kMillisecond);
BENCHMARK(solve_nlopt)->Arg(8)->Arg(16)->Arg(32)->Arg(64)->Unit(benchmark::kMillisecond);

// The same patterns from end to end: verdict and interval with their proof, then the level.
void whole_orbit(benchmark::State& state) {
    const Pattern pattern = accuracy_pattern(static_cast<int>(state.range(0)), 1);
    OrbitAnswer answer;
    for (auto _ : state) {
        const PatternProblem problem = pattern_problem(pattern, 1);
        OrbitSolver solver;
        answer = solver.solve(Bar{}, problem, {.level = 1.3 * *problem.interval.least, .reference = {}});
    }
    label(state, {{"admissible", answer.verdict == Verdict::admissible},
                  {"gap", answer.optimality ? answer.optimality->gap : 1.0}});
}
BENCHMARK(whole_orbit)->Arg(50)->Arg(100)->Arg(200)->Arg(400)->Unit(benchmark::kMillisecond)->Iterations(1);

// The certificate of that orbit of least shock: making it, and checking it.
OrbitAnswer level_of(const PatternProblem& problem) {
    return OrbitSolver().solve(Bar{}, problem, {.level = 1.3 * *problem.interval.least, .reference = {}});
}
void certify_orbit(benchmark::State& state) {
    const PatternProblem problem = pattern_problem(accuracy_pattern(static_cast<int>(state.range(0)), 1), 1);
    const OrbitAnswer answer = level_of(problem);
    OptimumProof proof;
    for (auto _ : state) proof = certified_optimum(problem, answer);
    label(state, {{"gap", proof.certificate ? proof.gap : 1.0}});
}
void check_orbit(benchmark::State& state) {
    const PatternProblem problem = pattern_problem(accuracy_pattern(static_cast<int>(state.range(0)), 1), 1);
    const OptimumProof proof = certified_optimum(problem, level_of(problem));
    bool valid = false;
    for (auto _ : state) valid = check(proof.certificate.value()).valid;
    label(state, {{"valid", valid}});
}
BENCHMARK(certify_orbit)->Arg(8)->Arg(64)->Arg(400)->Arg(2000)->Unit(benchmark::kMillisecond);
BENCHMARK(check_orbit)->Arg(8)->Arg(64)->Arg(400)->Arg(2000)->Unit(benchmark::kMillisecond);

// What rank 0 does for one answer: read the message, store it, choose the next unit, pack it. The number is N.
void serve(benchmark::State& state) {
    Scene scene;
    scene.mesh.cells = static_cast<int>(state.range(0));
    scene.patterns =
        ListSelection{{{proportional(scene.mesh.cells).free_steps, proportional(scene.mesh.cells).contact_steps}}};
    scene.levels.resize(1'000'000, 12.0);
    scene.text = "benchmark";
    SweepWorker worker(scene, {});
    SweepQueue queue(scene, {}, SweepQueue::Order::longest_first);
    const auto folder = std::filesystem::temp_directory_path() / ("nsma-bench-" + std::to_string(state.range(0)));
    std::filesystem::remove_all(folder);
    {
        SweepStore store(folder, scene, {"", ""}, SweepStore::Mode::fresh);
        queue.done(worker.run(queue.next(0).at(0)));
        std::vector<WorkUnit> units = queue.next(0);
        const std::vector<WorkResult> answer{worker.run(WorkUnit{0, 1, {}})};
        const std::string message = packed(answer);
        for (auto _ : state) {
            auto got = unpacked_results(message, scene.bar);
            got[0].place = units.at(0).place;
            store.put(got);
            queue.done(got[0]);
            units = queue.next(0);
            benchmark::DoNotOptimize(packed(units).data());
        }
    }
    std::filesystem::remove_all(folder);
}
BENCHMARK(serve)->Arg(12)->Arg(48)->Unit(benchmark::kMicrosecond);

// The same for the messages of verdicts, with the levels that they bring, of all patterns up to 4 tau at 12 levels.
void serve_verdicts(benchmark::State& state) {
    Scene scene;
    scene.mesh.cells = static_cast<int>(state.range(0));
    scene.patterns = PeriodSelection{{0.0, 4.0}, std::nullopt};
    for (int k = 0; k < 12; ++k) scene.levels.push_back(1.05 * std::pow(100 / 1.05, k / 11.0));
    scene.text = "benchmark";
    SweepWorker worker(scene, {});
    std::vector<std::string> messages;
    {
        SweepQueue queue(scene, {}, SweepQueue::Order::longest_first);
        for (int helper = 0;; ++helper) {
            const auto units = queue.next(helper);
            if (units.empty()) break;
            messages.push_back(packed(worker.run(units)));
        }
    }
    const auto folder = std::filesystem::temp_directory_path() / ("nsma-bench-" + std::to_string(state.range(0)));
    for (auto _ : state) {
        state.PauseTiming();
        std::filesystem::remove_all(folder);
        auto store = std::make_unique<SweepStore>(folder, scene, StoreVersions{"", ""}, SweepStore::Mode::fresh);
        state.ResumeTiming();
        for (const std::string& message : messages) store->put(unpacked_results(message, scene.bar));
        state.PauseTiming();
        store.reset();
        state.ResumeTiming();
    }
    std::filesystem::remove_all(folder);
    label(state, {{"messages", static_cast<double>(messages.size())}});
}
BENCHMARK(serve_verdicts)->Arg(12)->Arg(48)->Unit(benchmark::kMillisecond);

}  // namespace
