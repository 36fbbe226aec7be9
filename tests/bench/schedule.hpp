#pragma once

#include <vector>

namespace nsma {

/// How a sweep on many ranks would go, from recorded times of its units.
struct ScheduleOptions {
    int workers = 1;     ///< processes that compute, >= 1
    double service = 0;  ///< [s] rank 0 needs for one result: store it, choose and send the next unit
    double latency = 0;  ///< [s] of one message, each way
};

struct Schedule {
    double seconds = 0;       ///< until the last result is stored
    double message_rate = 0;  ///< results per second that rank 0 takes in
    double busy = 0;          ///< share of that time in which rank 0 works
    double efficiency = 0;    ///< work / (workers * seconds)
};

/// Rank 0 hands the units out in their order, one to a worker, and serves one result at a time,
/// first come first served. Throws std::invalid_argument on no unit, a time that is negative or
/// not finite, or no worker.
[[nodiscard]] Schedule simulated_schedule(const std::vector<double>& unit_seconds, const ScheduleOptions& options);

}  // namespace nsma
