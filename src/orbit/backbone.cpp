#include "nsma/orbit/backbone.hpp"

#include <cmath>
#include <cstdint>
#include <stdexcept>

#include <fmt/format.h>

#include "gap_sign.hpp"
#include "nsma/wave/mesh.hpp"

namespace nsma {

namespace {

void require_mode(int mode) {
    if (mode < 1) {
        throw std::invalid_argument(fmt::format("mode: expected at least 1, got {}", mode));
    }
}

}  // namespace

double backbone_energy_ratio(int mode, double period_ratio) {
    require_mode(mode);
    if (!std::isfinite(period_ratio) || period_ratio <= 0.0) {
        throw std::invalid_argument(fmt::format("period_ratio: expected a finite value > 0, got {}", period_ratio));
    }
    const double k = mode;
    const double denominator = k * k * period_ratio - (2.0 * k + 1.0);
    if (denominator == 0.0) {
        throw std::invalid_argument(
            fmt::format("period_ratio: expected other than (2k+1)/k^2, where mode {} has no finite "
                        "energy, got {}",
                        mode, period_ratio));
    }
    return 1.0 / (denominator * denominator);
}

PeriodInterval backbone_period_interval(int mode, int gap_sign) {
    require_mode(mode);
    validate_gap_sign(gap_sign);
    const double k = mode;
    const double singular = (2.0 * k + 1.0) / (k * k);
    if (gap_sign > 0) {
        return {singular, 4.0 / (2.0 * k - 1.0)};
    }
    if (gap_sign < 0) {
        return {2.0 / k, singular};
    }
    return {singular, singular};
}

std::vector<Pattern> mode_patterns(int mode, int cells, int gap_sign) {
    require_mode(mode);
    validate_gap_sign(gap_sign);
    validate(Mesh{cells});
    std::vector<Pattern> patterns;
    const std::int64_t k = mode;
    const std::int64_t n = cells;
    // r >= 1 needs n_T > 2N/k, p >= 1 needs n_T < 4N/(2k - 1).
    for (std::int64_t period = 2 * n / k + 1; period * (2 * k - 1) < 4 * n; ++period) {
        const std::int64_t balance = k * k * period - (2 * k + 1) * n;  // sign of d
        if ((balance > 0) - (balance < 0) != gap_sign) {
            continue;
        }
        const std::int64_t free_steps = 2 * (k * period - 2 * n);
        const std::int64_t contact_steps = 4 * n - (2 * k - 1) * period;
        patterns.push_back({cells, static_cast<int>(free_steps), static_cast<int>(contact_steps)});
    }
    return patterns;
}

std::optional<int> mode_of(const Pattern& pattern) {
    validate(pattern);
    // r = 2(k n_T - 2N) for an integer k; p = n_T - r then has its formula too.
    if (pattern.free_steps % 2 != 0) {
        return std::nullopt;
    }
    const std::int64_t product = std::int64_t{pattern.free_steps} / 2 + 2 * std::int64_t{pattern.cells};
    if (product % pattern.period_steps() != 0) {
        return std::nullopt;
    }
    return static_cast<int>(product / pattern.period_steps());
}

}  // namespace nsma
