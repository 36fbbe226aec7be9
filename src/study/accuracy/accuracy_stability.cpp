#include <cmath>
#include <optional>
#include <random>

#include <fmt/format.h>

#include "accuracy_parts.hpp"
#include "program_methods.hpp"
#include "nsma/orbit/conditions.hpp"

namespace nsma {
namespace {

constexpr double run_limit = 3.0;    // seconds a run of the maps
constexpr double easy_level = 1.35;  // in E_min
constexpr int easy_size = 8;

// What the start, unit and row maps run on, with E/E_g.
struct MappedProgram {
    Pattern pattern;
    std::optional<double> level;  // absent: the easy one
};
std::vector<MappedProgram> mapped_programs(int gap_sign, bool quick) {
    const MappedProgram easy{accuracy_pattern(easy_size, gap_sign), std::nullopt};
    if (gap_sign < 0 || quick) return {easy};
    // Contact motions of no mode, one with a closing link, at half its greatest energy, where the level begins to fall
    // into pieces.
    return {easy, {{12, 31, 9}, 12.0}, {{12, 32, 8}, 36.0}};
}

// One level of the level map.
struct Place {
    enum class From { least, middle, greatest } from;
    double distance;  // relative to that end; a share of the interval in the middle

    [[nodiscard]] std::string label() const {
        if (from == From::middle) return fmt::format("{:g} of the way", distance);
        return from == From::least ? fmt::format("E_min (1 + {:.0e})", distance)
                                   : fmt::format("E_max (1 - {:.0e})", distance);
    }
    [[nodiscard]] double level(double least, double greatest) const {
        if (from == From::middle) return least + distance * (greatest - least);
        return from == From::least ? least * (1 + distance) : greatest * (1 - distance);
    }
};
std::vector<Place> places(bool quick) {
    using From = Place::From;
    if (quick) return {{From::least, 1e-8}, {From::middle, 0.5}, {From::greatest, 1e-8}};
    return {{From::least, 1e-12},   {From::least, 1e-9},    {From::least, 1e-6},    {From::least, 1e-3},
            {From::middle, 0.1},    {From::middle, 0.3},    {From::middle, 0.5},    {From::middle, 0.9},
            {From::greatest, 1e-3}, {From::greatest, 1e-6}, {From::greatest, 1e-9}, {From::greatest, 1e-12}};
}

// One column of a map: how a program is posed and where each run begins.
struct Difficulty {
    std::string what;
    Program posed;
    std::vector<Eigen::VectorXd> starts;
};

// Every method on every difficulty, from column `first` of the map on. Whole methods bring their own start: they run
// once, or as often as the others where the map asks how sure they are.
enum class WholeRuns { one, all };
void study_map(AccuracyRun& run, const char* map, const ProgramCase& on, const std::vector<Difficulty>& difficulties,
               WholeRuns whole_runs = WholeRuns::all, int first = 0) {
    for (const auto& method : mapped_methods()) {
        MethodRunner runner(method, run_limit);
        int column = first;
        for (const Difficulty& difficulty : difficulties) {
            if (!run.go_on()) return;
            std::vector<Trial> trials;
            std::vector<double> seconds;
            for (const Eigen::VectorXd& start : difficulty.starts) {
                trials.push_back(runner.run(on, difficulty.posed, start));
                seconds.push_back(trials.back().seconds);
                if (method.whole() && whole_runs == WholeRuns::one) break;
            }
            const auto greatest = on.problem.interval.greatest;
            run.add(StabilityRecord{counted(on, method.name() + (method.polish ? "" : " raw"), trials), map, column++,
                                    difficulty.what, on.level / on.problem.interval.least.value() - 1.0,
                                    greatest ? 1.0 - on.level / *greatest : 1.0, spread(seconds).median});
        }
    }
}

Eigen::VectorXd random_unit(Eigen::Index size, std::mt19937_64& generator) {
    Eigen::VectorXd direction(size);
    for (auto& value : direction) value = static_cast<double>(generator() >> 11) * 0x1.0p-52 - 1.0;
    return direction.normalized();
}

// By size and level, from the admissible point of a segment, then from points of the level in random directions.
void level_map(AccuracyRun& run) {
    const Bar& bar = run.scene.bar;
    for (const int size : run.sizes.maps) {
        const PatternProblem problem = pattern_problem(accuracy_pattern(size, bar.gap_sign()), bar.gap_sign());
        int column = 0;
        for (const Place& place : places(run.quick)) {
            if (!run.go_on()) return;
            const double level = place.level(problem.interval.least.value(), problem.interval.greatest.value());
            const ProgramCase on = solved_case(bar, problem, run.scene.objective, level);
            std::mt19937_64 generator(1);
            Difficulty difficulty{place.label(), on.program.program, {on.program.point(on.points.start(0).value())}};
            for (int k = 1; k < run.sizes.starts; ++k) {
                difficulty.starts.push_back(random_unit(on.best_x.size(), generator));
            }
            study_map(run, "level", on, {difficulty}, WholeRuns::one, column++);
            ++run.done;
        }
    }
}

// Starts farther and farther from the optimum, in random directions.
std::vector<Difficulty> far_starts(const ProgramCase& on, bool quick) {
    const std::vector<double> radii =
        quick ? std::vector{1e-3, 1.0} : std::vector{1e-6, 1e-4, 1e-2, 0.1, 1.0, 10.0, 1e2, 1e3};
    std::vector<Difficulty> difficulties;
    for (const double radius : radii) {
        std::mt19937_64 generator(difficulties.size() + 1);
        Difficulty difficulty{fmt::format("{:g}", radius), on.program.program, {}};
        for (int k = 0; k < (quick ? 2 : 8); ++k) {
            difficulty.starts.push_back(on.best_x + radius * random_unit(on.best_x.size(), generator));
        }
        difficulties.push_back(difficulty);
    }
    return difficulties;
}

std::vector<Eigen::VectorXd> usual_starts(const ProgramCase& on, int count) {
    std::vector<Eigen::VectorXd> starts;
    for (int k = 0; k < count; ++k) {
        if (const auto gamma = on.points.start(k)) starts.push_back(on.program.point(*gamma));
    }
    return starts;
}

// The program as a careless caller would pose it. First: objective and linear rows in units 10^k of their own; the
// sphere keeps its unit radius.
std::vector<Difficulty> scaled_programs(const ProgramCase& on, const std::vector<Eigen::VectorXd>& starts, bool quick) {
    const std::vector<int> powers = quick ? std::vector{-6, 6} : std::vector{-12, -9, -6, -3, 0, 3, 6, 9, 12};
    std::vector<Difficulty> difficulties;
    for (const int power : powers) {
        const double unit = std::pow(10.0, power);
        Program posed = on.program.program;
        posed.hessian *= unit;
        posed.gradient *= unit;
        posed.constant *= unit;
        posed.equalities *= unit;
        posed.equality_values *= unit;
        posed.inequalities *= unit;
        posed.inequality_values *= unit;
        difficulties.push_back({fmt::format("1e{}", power), posed, starts});
    }
    return difficulties;
}

// Puts more rows below those of a constraint.
void append(SparseRows& rows, Eigen::VectorXd& values, const Eigen::MatrixXd& more,
            const Eigen::VectorXd& more_values) {
    Eigen::MatrixXd all_rows(rows.rows() + more.rows(), more.cols());
    all_rows << Eigen::MatrixXd(rows), more;
    rows = all_rows.sparseView();
    Eigen::VectorXd all_values(values.size() + more_values.size());
    all_values << values, more_values;
    values = all_values;
}

// COND2 once for each of the p contact steps and n = 0.
void repeat_contact(const ProgramCase& on, Program& program) {
    if (program.equalities.rows() == 0) return;
    const Eigen::MatrixXd row = Eigen::MatrixXd(program.equalities).topRows(1);
    const int times = on.problem.kernel.pattern.contact_steps;
    append(program.equalities, program.equality_values, row.replicate(times, 1),
           program.equality_values.head(1).replicate(times, 1));
}

// COND3 at each contact step as a row -gamma_j <= 0 in place of the bound.
void force_rows(const ProgramCase& on, Program& program) {
    const Kernel& kernel = on.problem.kernel;
    const Reduction& reduction = on.problem.set.reduction;
    std::vector<Eigen::Index> columns;
    for (int n = kernel.pattern.free_steps; n < kernel.pattern.period_steps(); ++n) {
        for (int j = 0; j < reduction.variables(); ++j) {
            if (j == kernel.column(n)) columns.push_back(j);
        }
    }
    const auto count = static_cast<Eigen::Index>(columns.size());
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(count, program.variables());
    for (Eigen::Index i = 0; i < count; ++i) rows(i, columns[static_cast<std::size_t>(i)]) = -1.0;
    append(program.inequalities, program.inequality_values, rows, Eigen::VectorXd::Zero(count));
    program.lower.head(reduction.variables()).setConstant(-no_bound);
}

// COND1 x_n <= delta at each step of the free flight, silent and implied ones too.
void flight_rows(const ProgramCase& on, Program& program) {
    const Reduction& reduction = on.problem.set.reduction;
    const Eigen::MatrixXi tips = tip_rows(on.problem.kernel);
    const int count = on.problem.kernel.pattern.free_steps - 1;
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(count, program.variables());
    Eigen::VectorXd values(count);
    for (int n = 0; n < count; ++n) {
        for (int j = 0; j < reduction.variables(); ++j) {
            rows(n, j) = reduction.flip * tips(n + 1, j);
        }
        const double norm = std::max(rows.row(n).norm(), 1.0);
        rows.row(n) /= norm;
        values[n] = reduction.gap_sign / (norm * on.program.scale);
    }
    append(program.inequalities, program.inequality_values, rows, values);
}

// Rows that presolve removes, put back: one kind at a time, then all of them.
std::vector<Difficulty> redundant_programs(const ProgramCase& on, const std::vector<Eigen::VectorXd>& starts) {
    using Change = void (*)(const ProgramCase&, Program&);
    const std::vector<std::pair<const char*, std::vector<Change>>> variants{
        {"presolved", {}},
        {"COND2 repeated", {repeat_contact}},
        {"COND3 as rows", {force_rows}},
        {"all COND1 rows", {flight_rows}},
        {"all of them", {repeat_contact, force_rows, flight_rows}}};
    std::vector<Difficulty> difficulties;
    for (const auto& [what, changes] : variants) {
        difficulties.push_back({what, on.program.program, starts});
        for (const Change change : changes) change(on, difficulties.back().posed);
    }
    return difficulties;
}

}  // namespace

void study_stability(AccuracyRun& run) {
    const Bar& bar = run.scene.bar;
    const auto programs = mapped_programs(bar.gap_sign(), run.quick);
    run.total += static_cast<long>(run.sizes.maps.size() * places(run.quick).size() + 3 * programs.size());
    level_map(run);
    for (const auto& [pattern, level] : programs) {
        if (!run.go_on()) return;
        const PatternProblem problem = pattern_problem(pattern, bar.gap_sign());
        const ProgramCase on =
            solved_case(bar, problem, run.scene.objective, level.value_or(easy_level * problem.interval.least.value()));
        const auto starts = usual_starts(on, run.sizes.starts);
        study_map(run, "start", on, far_starts(on, run.quick));
        ++run.done;
        study_map(run, "units", on, scaled_programs(on, starts, run.quick));
        ++run.done;
        study_map(run, "rows", on, redundant_programs(on, starts));
        ++run.done;
    }
}

}  // namespace nsma
