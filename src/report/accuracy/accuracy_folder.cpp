#include "accuracy_folder.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>

#include <Eigen/Core>
#include <fmt/format.h>
#include <unistd.h>

#include "numerics/linear_program.hpp"
#include "numerics/solver.hpp"
#include "report/csv.hpp"
#include "report/one_line.hpp"
#include "report/results_folder.hpp"

namespace nsma {
namespace {

namespace fs = std::filesystem;

constexpr double rounding_error = 1e-14;  // two errors below it are the same

std::string steps(const Pattern& pattern) {
    return fmt::format("{},{},{}", pattern.cells, pattern.free_steps, pattern.contact_steps);
}

std::string times(const Spread& spread) {
    return fmt::format("{},{},{}", csv_number(spread.median), csv_number(spread.low), csv_number(spread.high));
}

std::string cpu_name() {
    std::ifstream stream("/proc/cpuinfo");
    for (std::string line; std::getline(stream, line);) {
        if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
    }
    return "unknown";
}

}  // namespace

AccuracyFolder::AccuracyFolder(const fs::path& folder, const Scene& scene) : folder_(folder) {
    prepare_results_folder(folder, scene, accuracy_files);
    open(programs_, "programs.csv",
         "cells,free_steps,contact_steps,kernel_dimension,method,setting,runs,reported,succeeded,certified,proved,"
         "seconds_median,"
         "seconds_quartile_1,seconds_quartile_3,iterations,worst_gap,worst_violation,error");
    open(kernels_, "kernels.csv",
         "cells,free_steps,contact_steps,method,seconds_median,seconds_quartile_1,seconds_quartile_3,dimension,"
         "expected,error");
    open(marching_, "marching.csv",
         "cells,method,setting,decides_contact,steps,seconds_median,seconds_quartile_1,seconds_quartile_3,tip_error,"
         "contact_error");
    open(drift_, "drift.csv", "cells,method,setting,periods,energy_drift,periodicity_defect,seconds");
    std::string outcomes;
    for (int k = 0; k < outcome_count; ++k) outcomes += fmt::format(",{}", name(static_cast<Outcome>(k)));
    open(stability_, "stability.csv",
         ("map,cells,free_steps,contact_steps,kernel_dimension,method,column,difficulty,above_least,below_greatest,"
          "runs,reported,"
          "false_success,certified,proved,iterations,seconds" +
          outcomes)
             .c_str());
    open(causes_, "causes.csv", "method,map,cause,runs,of,what");
    open(tolerance_, "tolerance.csv", "cells,free_steps,contact_steps,method,tolerance,found,expected");
    open(winners_, "winners.csv",
         "kernel_dimension,front,rank,method,setting,seconds_median,error,succeeded,certified,runs");
    open(machine_, "machine.txt", "");
}

AccuracyFolder::~AccuracyFolder() = default;

void AccuracyFolder::open(Table& table, const char* name, const char* header) {
    table.path = (folder_ / name).string() + ".part";
    errno = 0;
    table.file.reset(std::fopen(table.path.c_str(), "wb"));
    if (!table.file) fail(table.path, fmt::format("cannot be written: {}", std::strerror(errno)));
    if (*header != '\0') write(table, header);
}

void AccuracyFolder::write(Table& table, const std::string& line) {
    std::FILE* file = table.file.get();
    errno = 0;
    if (std::fwrite(line.data(), 1, line.size(), file) != line.size() || std::fputc('\n', file) == EOF ||
        std::fflush(file) != 0) {
        fail(table.path, fmt::format("cannot be written: {}", std::strerror(errno)));
    }
}

void AccuracyFolder::program(const ProgramRecord& record) {
    results_.programs.push_back(record);
    write(programs_,
          fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{}", steps(record.pattern), record.size,
                      csv_text(record.method), csv_text(record.setting), record.runs, record.reported, record.succeeded,
                      record.certified, record.proved, times(record.seconds), csv_number(record.iterations),
                      csv_number(record.worst_gap), csv_number(record.worst_violation), csv_number(record.error)));
}

void AccuracyFolder::kernel(const KernelRecord& record) {
    results_.kernels.push_back(record);
    write(kernels_, fmt::format("{},{},{},{},{},{}", steps(record.pattern), csv_text(record.method),
                                times(record.seconds), record.dimension, record.expected, csv_number(record.error)));
}

void AccuracyFolder::march(const MarchRecord& record) {
    results_.marches.push_back(record);
    write(marching_, fmt::format("{},{},{},{},{},{},{},{}", record.cells, csv_text(record.method),
                                 csv_text(record.setting), record.decides_contact, record.steps, times(record.seconds),
                                 csv_number(record.tip_error), csv_number(record.contact_error)));
}

void AccuracyFolder::drift(const DriftRecord& record) {
    results_.drifts.push_back(record);
    write(drift_, fmt::format("{},{},{},{},{},{},{}", record.cells, csv_text(record.method), csv_text(record.setting),
                              record.periods, csv_number(record.energy_drift), csv_number(record.periodicity_defect),
                              csv_number(record.seconds)));
}

void AccuracyFolder::stability(const StabilityRecord& record) {
    results_.stability.push_back(record);
    std::string outcomes;
    for (const int count : record.outcomes) outcomes += fmt::format(",{}", count);
    write(stability_, fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}{}", record.map, steps(record.pattern),
                                  record.size, csv_text(record.method), record.column, csv_text(record.difficulty),
                                  csv_number(record.above_least), csv_number(record.below_greatest), record.runs,
                                  record.reported, record.false_success, record.certified, record.proved,
                                  csv_number(record.iterations), csv_number(record.seconds), outcomes));
}

void AccuracyFolder::tolerance(const ToleranceRecord& record) {
    results_.tolerances.push_back(record);
    write(tolerance_, fmt::format("{},{},{},{},{}", steps(record.pattern), csv_text(record.method),
                                  csv_number(record.tolerance), record.found, record.expected));
}

void AccuracyFolder::progress(long, long) {}

void AccuracyFolder::finish() {
    std::vector<int> sizes;
    for (const auto& record : results_.programs) {
        if (std::find(sizes.begin(), sizes.end(), record.size) == sizes.end()) sizes.push_back(record.size);
    }
    for (const int size : sizes) {
        for (const bool certified : {false, true}) {
            int rank = 0;
            for (const auto* record : pareto_front(results_.programs, size, certified)) {
                write(winners_, fmt::format("{},{},{},{},{},{},{},{},{},{}", size, certified ? "certified" : "any",
                                            ++rank, csv_text(record->method), csv_text(record->setting),
                                            csv_number(record->seconds.median), csv_number(record->error),
                                            record->succeeded, record->certified, record->runs));
            }
        }
    }
    // method, map -> outcome counts and runs
    std::map<std::pair<std::string, std::string>, std::pair<std::array<int, outcome_count>, int>> causes;
    for (const auto& record : results_.stability) {
        auto& [counts, runs] = causes[{record.method, record.map}];
        runs += record.runs;
        for (std::size_t k = 0; k < counts.size(); ++k) counts[k] += record.outcomes[k];
    }
    for (const auto& [key, value] : causes) {
        for (std::size_t k = 0; k < value.first.size(); ++k) {
            if (value.first[k] == 0) continue;
            const auto outcome = static_cast<Outcome>(k);
            write(causes_, fmt::format("{},{},{},{},{},{}", csv_text(key.first), key.second, name(outcome),
                                       value.first[k], value.second, csv_text(description(outcome))));
        }
    }
    write(machine_, machine_text());
    for (Table* table :
         {&programs_, &kernels_, &marching_, &drift_, &stability_, &causes_, &tolerance_, &winners_, &machine_}) {
        std::FILE* file = table->file.get();
        errno = 0;
        if (std::fflush(file) != 0 || (fsync(fileno(file)) != 0 && errno != EINVAL))
            fail(table->path, fmt::format("cannot be written: {}", std::strerror(errno)));
        table->file.reset();
        fs::path final_name = table->path;
        final_name.replace_extension();
        std::error_code code;
        fs::rename(table->path, final_name, code);
        if (code) fail(final_name, fmt::format("cannot be written: {}", code.message()));
    }
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

}  // namespace nsma
