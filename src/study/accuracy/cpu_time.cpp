#include "cpu_time.hpp"

#include <algorithm>
#include <ctime>
#include <stdexcept>

namespace nsma {
namespace {

double quartile(const std::vector<double>& sorted, double share) {
    const double place = share * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

double cpu_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

Spread spread(std::vector<double> values) {
    if (values.empty()) throw std::invalid_argument("values: expected at least one, got none");
    std::sort(values.begin(), values.end());
    return {quartile(values, 0.5), quartile(values, 0.25), quartile(values, 0.75)};
}

double cpu_seconds_of(const std::function<void()>& work) {
    const double begin = cpu_seconds();
    work();
    return cpu_seconds() - begin;
}

Spread repeated(int repeats, const std::function<double()>& run, double slow) {
    std::vector<double> seconds;
    do {
        seconds.push_back(run());
    } while (static_cast<int>(seconds.size()) < repeats && seconds.back() <= slow);
    return spread(seconds);
}

}  // namespace nsma
