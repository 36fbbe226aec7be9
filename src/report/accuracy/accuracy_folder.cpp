#include "accuracy_folder.hpp"

#include <algorithm>
#include <fstream>
#include <map>

#include <Eigen/Core>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "numerics/linear_program.hpp"
#include "numerics/solver.hpp"
#include "report/csv.hpp"
#include "report/csv_metadata.hpp"
#include "report/one_line.hpp"
#include "report/study_records.hpp"

namespace nsma {
namespace {

namespace fs = std::filesystem;

constexpr double rounding_error = 1e-14;  // two errors below it are the same

std::string field(int value) { return std::to_string(value); }
std::string field(bool value) { return value ? "true" : "false"; }
std::string field(double value) { return csv_number(value); }
std::string field(std::string_view text) { return csv_text(text); }
std::string field(const Pattern& pattern) {
    return fmt::format("{},{},{}", pattern.cells, pattern.free_steps, pattern.contact_steps);
}
std::string field(const Spread& spread) {
    return fmt::format("{},{},{}", field(spread.median), field(spread.low), field(spread.high));
}
std::string field(const std::array<int, outcome_count>& outcomes) {
    return fmt::format("{}", fmt::join(outcomes, ","));
}

// One row of a table under the names of its columns.
struct Row {
    template <typename... Values>
    explicit Row(std::string columns, const Values&... values)
        : header(std::move(columns)), fields(fmt::format("{}", fmt::join({field(values)...}, ","))) {}

    std::string header;
    std::string fields;
};

const std::string pattern_columns = "cells,free_steps,contact_steps";
const std::string seconds_columns = "seconds_median,seconds_quartile_1,seconds_quartile_3";

Row row(const ProgramRecord& one) {
    return Row(pattern_columns + ",kernel_dimension,method,setting,runs,reported,succeeded,certified,proved," +
                   seconds_columns + ",iterations,worst_gap,worst_violation,error",
               one.pattern, one.size, one.method, one.setting, one.runs, one.reported, one.succeeded(), one.certified,
               one.proved, one.seconds, one.iterations, one.worst_gap, one.worst_violation, one.error);
}

Row row(const KernelRecord& one) {
    return Row(pattern_columns + ",method," + seconds_columns + ",dimension,expected,error", one.pattern, one.method,
               one.seconds, one.dimension, one.expected, one.error);
}

Row row(const MarchRecord& one) {
    return Row("cells,method,setting,decides_contact,steps," + seconds_columns + ",tip_error,contact_error", one.cells,
               one.method, one.setting, one.decides_contact, one.steps, one.seconds, one.tip_error, one.contact_error);
}

Row row(const DriftRecord& one) {
    return Row("cells,method,setting,periods,energy_drift,periodicity_defect,seconds", one.cells, one.method,
               one.setting, one.periods, one.energy_drift, one.periodicity_defect, one.seconds);
}

Row row(const StabilityRecord& one) {
    std::string columns = "map," + pattern_columns +
                          ",kernel_dimension,method,column,difficulty,above_least,below_greatest,runs,reported,"
                          "false_success,certified,proved,iterations,seconds";
    for (int k = 0; k < outcome_count; ++k) columns += fmt::format(",{}", name(static_cast<Outcome>(k)));
    return Row(columns, one.map, one.pattern, one.size, one.method, one.column, one.difficulty, one.above_least,
               one.below_greatest, one.runs, one.reported, one.false_success, one.certified, one.proved, one.iterations,
               one.seconds, one.outcomes);
}

Row row(const ToleranceRecord& one) {
    return Row(pattern_columns + ",method,tolerance,found,expected", one.pattern, one.method, one.tolerance, one.found,
               one.expected);
}

Row row_of(const AccuracyRecord& record) {
    return std::visit([](const auto& one) { return row(one); }, record);
}

std::string winners_table(const std::vector<ProgramRecord>& programs) {
    std::string text = "kernel_dimension,front,rank,method,setting,seconds_median,error,succeeded,certified,runs\n";
    std::vector<int> sizes;
    for (const auto& one : programs) {
        if (std::find(sizes.begin(), sizes.end(), one.size) == sizes.end()) sizes.push_back(one.size);
    }
    for (const int size : sizes) {
        for (const bool certified : {false, true}) {
            int rank = 0;
            for (const ProgramRecord* one : pareto_front(programs, size, certified)) {
                text += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", size, certified ? "certified" : "any", ++rank,
                                    field(one->method), field(one->setting), field(one->seconds.median),
                                    field(one->error), one->succeeded(), one->certified, one->runs);
            }
        }
    }
    return text;
}

std::string causes_table(const std::vector<StabilityRecord>& cells) {
    struct Counts {
        std::array<int, outcome_count> outcomes{};
        int runs = 0;
    };
    std::map<std::pair<std::string, std::string>, Counts> causes;  // by method and map
    for (const auto& cell : cells) {
        Counts& counts = causes[{cell.method, cell.map}];
        counts.runs += cell.runs;
        for (std::size_t k = 0; k < cell.outcomes.size(); ++k) counts.outcomes[k] += cell.outcomes[k];
    }
    std::string text = "method,map,cause,runs,of,what\n";
    for (const auto& [key, counts] : causes) {
        for (std::size_t k = 0; k < counts.outcomes.size(); ++k) {
            if (counts.outcomes[k] == 0) continue;
            const auto outcome = static_cast<Outcome>(k);
            text += fmt::format("{},{},{},{},{},{}\n", field(key.first), key.second, name(outcome), counts.outcomes[k],
                                counts.runs, field(description(outcome)));
        }
    }
    return text;
}

// What follows from all records.
void write_derived(const fs::path& folder, const std::string& title, const AccuracyResults& results) {
    write_whole(folder / "causes.csv", causes_table(results.stability));
    write_whole(folder / "winners.csv", winners_table(results.programs));
    write_csv_metadata(folder, title);
}

std::string cpu_name() {
    std::ifstream stream("/proc/cpuinfo");
    for (std::string line; std::getline(stream, line);) {
        if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
    }
    return "unknown";
}

// CPU, compiler, build options and library versions, one line each.
std::string machine_text() {
#ifdef NDEBUG
    const char* build = "release (NDEBUG)";
#else
    const char* build = "debug (assertions on)";
#endif
    return fmt::format(
        "cpu: {}\ncompiler: {}\nbuild: {}\nIpopt: {}\nNLopt: {}\nCLP: {}\nEigen: {}.{}.{}\ntimes: CPU seconds of one "
        "thread",
        one_line(cpu_name()),
#ifdef __clang__
        "clang " __clang_version__,
#else
        "g++ " __VERSION__,
#endif
        build, ipopt_version(), nlopt_version(), clp_version(), EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION,
        EIGEN_MINOR_VERSION);
}

}  // namespace

AccuracyFolder::AccuracyFolder(const fs::path& folder, const Scene& scene) : folder_(folder), title_(scene.title) {
    prepare_results_folder(folder, scene, accuracy_files);
    for (const AccuracyRecord& empty : std::initializer_list<AccuracyRecord>{
             ProgramRecord(), KernelRecord(), MarchRecord(), DriftRecord(), StabilityRecord(), ToleranceRecord()}) {
        tables_.emplace_back(folder / accuracy_files[empty.index()]).write(row_of(empty).header + "\n");
    }
}

void AccuracyFolder::add(const AccuracyRecord& record) {
    results_.add(record);
    tables_[record.index()].write(row_of(record).fields + "\n");
}

void AccuracyFolder::finish() {
    for (PartFile& table : tables_) table.put_in_place();
    write_derived(folder_, title_, results_);
    write_whole(folder_ / "machine.txt", machine_text() + "\n");
    write_records(folder_, results_);
}

void write_accuracy(const fs::path& folder, const Scene& scene, const AccuracyResults& results) {
    std::size_t place = 0;
    const auto write = [&]<class Record>(const std::vector<Record>& records) {
        std::string text = row(Record()).header + "\n";
        for (const Record& record : records) text += row(record).fields + "\n";
        write_whole(folder / accuracy_files.at(place++), text);
    };
    write(results.programs);
    write(results.kernels);
    write(results.marches);
    write(results.drifts);
    write(results.stability);
    write(results.tolerances);
    write_derived(folder, scene.title, results);
}

bool all_certified(const ProgramRecord& record) { return record.runs > 0 && record.certified == record.runs; }

std::vector<const ProgramRecord*> pareto_front(const std::vector<ProgramRecord>& records, int size, bool certified) {
    const auto beats = [](const ProgramRecord& a, const ProgramRecord& b) {
        return a.seconds.high < b.seconds.low && std::max(a.error, rounding_error) <= std::max(b.error, rounding_error);
    };
    std::vector<const ProgramRecord*> front;
    for (const auto& record : records) {
        if (record.size == size && !record.warm && (!certified || all_certified(record))) front.push_back(&record);
    }
    const std::vector<const ProgramRecord*> rivals = front;
    std::erase_if(front, [&](const auto* record) {
        return std::any_of(rivals.begin(), rivals.end(), [&](const auto* other) { return beats(*other, *record); });
    });
    std::stable_sort(front.begin(), front.end(),
                     [](const auto* a, const auto* b) { return a->seconds.median < b->seconds.median; });
    return front;
}

}  // namespace nsma
