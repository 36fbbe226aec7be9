#pragma once

#include <array>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "cpu_time.hpp"
#include "nsma/orbit/pattern.hpp"

namespace nsma {

/// What one run of one method came to, judged by replay and by the proved best objective; the library's own word plays
/// no part.
enum class Outcome { success, worse, off_level, outside, other_motion, not_finite, limit };
inline constexpr int outcome_count = 7;
[[nodiscard]] std::string_view name(Outcome outcome);         ///< "success", "worse", ...
[[nodiscard]] std::string_view description(Outcome outcome);  ///< one line for the table of causes

/// What the runs of one method with one setting came to.
struct MethodRuns {
    Pattern pattern;
    int size = 0;  ///< m
    std::string method;
    int runs = 0;
    int reported = 0;       ///< the library claims success
    int false_success = 0;  ///< reported, but not Outcome::success
    int certified = 0;      ///< proved the best by the method's own bound
    std::array<int, outcome_count> outcomes{};
    bool proved = false;    ///< the best objective of every program is proved
    double iterations = 0;  ///< median

    [[nodiscard]] int succeeded() const { return outcomes[static_cast<std::size_t>(Outcome::success)]; }
};

/// On the programs of one size. CPU seconds a run: the mean over levels and starts, of which the repeats have the
/// spread.
struct ProgramRecord : MethodRuns {
    std::string setting;
    bool warm = false;  ///< started at the optimum of another level, whose cost is not counted
    Spread seconds;
    double worst_gap = 0;        ///< |objective - best|/best
    double worst_violation = 0;  ///< replayed
    double error = 0;            ///< worst over the runs of the larger of the two
};

/// In one cell of a stability map: on one kind of difficulty.
struct StabilityRecord : MethodRuns {
    std::string map;            ///< "level", "start", "units" or "rows"
    int column = 0;             ///< place along the map's axis, 0-based
    std::string difficulty;     ///< what is on that axis, e.g. "E_min (1 + 1e-8)"
    double above_least = 0;     ///< (E - E_min)/E_min
    double below_greatest = 0;  ///< (E_max - E)/E_max
    double seconds = 0;         ///< median, CPU
};

/// One way to the kernel. CPU seconds.
struct KernelRecord {
    Pattern pattern;
    std::string method;
    Spread seconds;
    int dimension = 0;  ///< found
    int expected = 0;   ///< closed form
    double error = 0;   ///< sine of the largest angle to the exact space; 1: wrong dimension
};

/// One way to march one period of the exact first-mode orbit. CPU seconds a period.
struct MarchRecord {
    int cells = 0;  ///< N, or finite elements
    std::string method;
    std::string setting;
    bool decides_contact = false;  ///< false: is told the contact steps
    int steps = 0;                 ///< a period
    Spread seconds;
    double tip_error = 0;      ///< largest over the period, in units of |d|
    double contact_error = 0;  ///< of the duration of contact, relative
};

/// One march over many periods.
struct DriftRecord {
    int cells = 0;
    std::string method;
    std::string setting;
    int periods = 0;
    double energy_drift = 0;        ///< |E - E_0|/E_0 at the end
    double periodicity_defect = 0;  ///< energy norm of Q - Q_0 over that of Q_0, at the end
    double seconds = 0;             ///< CPU
};

/// Dimension that a dense method finds at one tolerance.
struct ToleranceRecord {
    Pattern pattern;
    std::string method;
    double tolerance = 0;
    int found = 0;
    int expected = 0;
};

using AccuracyRecord =
    std::variant<ProgramRecord, KernelRecord, MarchRecord, DriftRecord, StabilityRecord, ToleranceRecord>;

/// Everything that one accuracy study found, in the order it was found.
struct AccuracyResults {
    std::vector<ProgramRecord> programs;
    std::vector<KernelRecord> kernels;
    std::vector<MarchRecord> marches;
    std::vector<DriftRecord> drifts;
    std::vector<StabilityRecord> stability;
    std::vector<ToleranceRecord> tolerances;

    void add(const AccuracyRecord& record);
};

}  // namespace nsma
