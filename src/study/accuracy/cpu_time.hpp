#pragma once

#include <functional>
#include <limits>
#include <vector>

namespace nsma {

/// Median of repeated runs and their quartiles.
struct Spread {
    double median = 0;
    double low = 0;   ///< first quartile
    double high = 0;  ///< third quartile
};
/// Throws std::invalid_argument on no value.
[[nodiscard]] Spread spread(std::vector<double> values);

/// CPU seconds of this process that a piece of work costs: other work on the machine does not count.
[[nodiscard]] double cpu_seconds_of(const std::function<void()>& work);

/// Spread of the seconds that `run` returns over so many repeats of the same work; one longer than `slow` is the last.
[[nodiscard]] Spread repeated(int repeats, const std::function<double()>& run,
                              double slow = std::numeric_limits<double>::infinity());

}  // namespace nsma
