#include "schedule.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <queue>
#include <stdexcept>
#include <string>

namespace nsma {

Schedule simulated_schedule(const std::vector<double>& unit_seconds, const ScheduleOptions& options) {
    if (unit_seconds.empty()) throw std::invalid_argument("unit_seconds: expected at least one, got none");
    if (options.workers < 1) {
        throw std::invalid_argument("workers: expected >= 1, got " + std::to_string(options.workers));
    }
    const auto expect_time = [](const char* name, double time) {
        if (!(std::isfinite(time) && time >= 0)) {
            throw std::invalid_argument(std::string(name) + ": expected a finite time >= 0, got " +
                                        std::to_string(time));
        }
    };
    expect_time("service", options.service);
    expect_time("latency", options.latency);
    for (const double time : unit_seconds) expect_time("unit_seconds", time);

    // Times at which results reach rank 0. The first units need choosing and sending too.
    std::priority_queue<double, std::vector<double>, std::greater<>> arrivals;
    double free_at = 0;
    double served = 0;
    std::size_t next = 0;
    const auto hand_out = [&] {
        free_at += options.service;
        served += options.service;
        if (next < unit_seconds.size()) arrivals.push(free_at + 2 * options.latency + unit_seconds[next++]);
    };
    while (next < unit_seconds.size() && next < static_cast<std::size_t>(options.workers)) hand_out();
    while (!arrivals.empty()) {
        free_at = std::max(free_at, arrivals.top());
        arrivals.pop();
        hand_out();
    }
    const double work = std::accumulate(unit_seconds.begin(), unit_seconds.end(), 0.0);
    Schedule schedule;
    schedule.seconds = free_at;
    if (free_at > 0) {
        schedule.message_rate = static_cast<double>(unit_seconds.size()) / free_at;
        schedule.busy = served / free_at;
        schedule.efficiency = work / (options.workers * free_at);
    }
    return schedule;
}

}  // namespace nsma
