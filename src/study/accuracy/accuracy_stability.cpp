#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <random>

#include "accuracy_parts.hpp"
#include "posed_programs.hpp"
#include "program_methods.hpp"

namespace nsma {
namespace {

constexpr double run_limit = 3.0;  // seconds a run of the maps
// The patterns of the start, unit and row maps beside a first-mode one, for a gap > 0, with E/E_g: contact motions of
// no mode, one with a closing link, at half its greatest energy, where the level begins to fall into pieces.
struct HardProgram {
    Pattern pattern;
    double level;
};
constexpr HardProgram hard_programs[] = {{{12, 31, 9}, 12.0}, {{12, 32, 8}, 36.0}};
constexpr double easy_level = 1.35;  // in E_min
constexpr int easy_size = 8;

std::string text(const char* format, double value) {
    char buffer[64];
    std::snprintf(buffer, sizeof buffer, format, value);
    return buffer;
}

// One level of the level map, by its distance from the nearer end.
struct Place {
    bool from_least;
    double distance;  // relative to that end; a share of the interval in the middle
    bool middle;
};
std::vector<Place> places(bool quick) {
    if (quick) return {{true, 1e-8, false}, {true, 0.5, true}, {false, 1e-8, false}};
    return {{true, 1e-12, false}, {true, 1e-9, false},  {true, 1e-6, false},  {true, 1e-3, false},
            {true, 0.1, true},    {true, 0.3, true},    {true, 0.5, true},    {true, 0.9, true},
            {false, 1e-3, false}, {false, 1e-6, false}, {false, 1e-9, false}, {false, 1e-12, false}};
}
std::string label(const Place& place) {
    if (place.middle) return text("%g of the way", place.distance);
    return text(place.from_least ? "E_min (1 + %.0e)" : "E_max (1 - %.0e)", place.distance);
}
double level_at(const Place& place, double least, double greatest) {
    if (place.middle) return least + place.distance * (greatest - least);
    return place.from_least ? least * (1 + place.distance) : greatest * (1 - place.distance);
}

// Collects the runs of one cell of a map.
class Cell {
public:
    Cell(const char* map, const ProgramCase& on, const ProgramMethod& method, int column, std::string difficulty) {
        record_.map = map;
        record_.pattern = on.problem.kernel.pattern;
        record_.size = on.problem.kernel.dimension();
        record_.method = method.name;
        record_.column = column;
        record_.difficulty = std::move(difficulty);
        record_.above_least = on.level / on.problem.interval.least.value() - 1.0;
        const auto greatest = on.problem.interval.greatest;
        record_.below_greatest = greatest ? 1.0 - on.level / *greatest : 1.0;
        record_.proved = on.proved;
    }
    void add(const Trial& trial) {
        ++record_.runs;
        if (trial.reported) ++record_.reported;
        if (trial.reported && trial.outcome != Outcome::success) ++record_.false_success;
        if (trial.certified) ++record_.certified;
        ++record_.outcomes.at(static_cast<std::size_t>(trial.outcome));
        iterations_.push_back(trial.iterations);
        seconds_.push_back(trial.seconds);
    }
    StabilityRecord record() {
        record_.iterations = spread(iterations_).median;
        record_.seconds = spread(seconds_).median;
        return record_;
    }

private:
    StabilityRecord record_;
    std::vector<double> iterations_;
    std::vector<double> seconds_;
};

Eigen::VectorXd random_unit(Eigen::Index size, std::mt19937_64& generator) {
    Eigen::VectorXd direction(size);
    for (auto& value : direction) value = static_cast<double>(generator() >> 11) * 0x1.0p-52 - 1.0;
    return direction.normalized();
}

void level_map(AccuracyRun& run) {
    const Bar& bar = run.scene.bar;
    const auto columns = places(run.quick);
    for (const int size : run.sizes.maps) {
        const PatternProblem problem = pattern_problem(accuracy_pattern(size, bar.gap_sign()), bar.gap_sign());
        for (std::size_t column = 0; column < columns.size(); ++column) {
            if (!run.go_on()) return;
            const double level =
                level_at(columns[column], problem.interval.least.value(), problem.interval.greatest.value());
            const ProgramCase on(bar, problem, run.scene.objective, level);
            for (const auto& method : mapped_methods()) {
                if (!run.go_on()) return;
                MethodRunner runner(method, run_limit);
                Cell cell("level", on, method, static_cast<int>(column), label(columns[column]));
                // The admissible point of a segment, then points of the level in random directions.
                std::mt19937_64 generator(1);
                const int starts = method.whole() ? 1 : run.sizes.starts;
                for (int start = 0; start < starts; ++start) {
                    const Eigen::VectorXd x = start == 0 ? on.program.point(on.points.start(0).value())
                                                         : random_unit(on.best_x.size(), generator);
                    cell.add(runner.run(on, on.program.program, x));
                }
                run.sink.stability(cell.record());
            }
            run.step();
        }
    }
}

void start_map(AccuracyRun& run, const ProgramCase& on, int starts) {
    const std::vector<double> radii =
        run.quick ? std::vector{1e-3, 1.0} : std::vector{1e-6, 1e-4, 1e-2, 0.1, 1.0, 10.0, 1e2, 1e3};
    for (const auto& method : mapped_methods()) {
        MethodRunner runner(method, run_limit);
        for (std::size_t column = 0; column < radii.size(); ++column) {
            if (!run.go_on()) return;
            std::mt19937_64 generator(column + 1);  // the same starts for every method
            Cell cell("start", on, method, static_cast<int>(column), text("%g", radii[column]));
            for (int start = 0; start < starts; ++start) {
                const Eigen::VectorXd x = on.best_x + radii[column] * random_unit(on.best_x.size(), generator);
                cell.add(runner.run(on, on.program.program, x));
            }
            run.sink.stability(cell.record());
        }
    }
    run.step();
}

// Programs posed otherwise, from the starts of the default path.
void posed_map(AccuracyRun& run, const char* map, const ProgramCase& on, const std::vector<PosedProgram>& posed) {
    for (const auto& method : mapped_methods()) {
        MethodRunner runner(method, run_limit);
        for (std::size_t column = 0; column < posed.size(); ++column) {
            if (!run.go_on()) return;
            Cell cell(map, on, method, static_cast<int>(column), posed[column].what);
            for (int start = 0; start < run.sizes.starts; ++start) {
                if (const auto gamma = on.points.start(start)) {
                    cell.add(runner.run(on, posed[column].program, on.program.point(*gamma)));
                }
            }
            run.sink.stability(cell.record());
        }
    }
    run.step();
}

}  // namespace

void study_stability(AccuracyRun& run) {
    const Bar& bar = run.scene.bar;
    const long patterns = bar.gap_sign() < 0 || run.quick ? 1 : 1 + static_cast<long>(std::size(hard_programs));
    run.expect(static_cast<long>(run.sizes.maps.size() * places(run.quick).size()) + 3 * patterns);
    level_map(run);
    const auto study = [&](const Pattern& pattern, std::optional<double> level) {
        if (!run.go_on()) return;
        const PatternProblem problem = pattern_problem(pattern, bar.gap_sign());
        const ProgramCase on(bar, problem, run.scene.objective,
                             level.value_or(easy_level * problem.interval.least.value()));
        start_map(run, on, run.quick ? 2 : 8);
        posed_map(run, "units", on, scaled_programs(on.program.program, run.quick));
        posed_map(run, "rows", on, redundant_programs(on));
    };
    study(accuracy_pattern(easy_size, bar.gap_sign()), std::nullopt);
    if (bar.gap_sign() < 0 || run.quick) return;
    for (const auto& hard : hard_programs) study(hard.pattern, hard.level);
}

}  // namespace nsma
