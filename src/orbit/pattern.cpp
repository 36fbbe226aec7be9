#include "nsma/orbit/pattern.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>

#include "nsma/wave/mesh.hpp"

namespace nsma {

int Pattern::class_count() const { return std::gcd(2 * cells, period_steps()); }

double Pattern::frequency_ratio() const { return 4.0 * cells / period_steps(); }

double Pattern::period_ratio() const { return static_cast<double>(period_steps()) / cells; }

void validate(const Pattern& pattern) {
    validate(Mesh{pattern.cells});
    if (pattern.free_steps < 1) {
        throw std::invalid_argument(fmt::format("free_steps: expected at least 1, got {}", pattern.free_steps));
    }
    if (pattern.contact_steps < 1) {
        throw std::invalid_argument(fmt::format("contact_steps: expected at least 1, got {}", pattern.contact_steps));
    }
    const std::int64_t period_steps = std::int64_t{pattern.free_steps} + std::int64_t{pattern.contact_steps};
    if (period_steps > max_period_steps) {
        throw std::invalid_argument(
            fmt::format("period_steps: expected at most {}, got {}", max_period_steps, period_steps));
    }
}

int kernel_dimension(const Pattern& pattern) {
    validate(pattern);
    const int classes = pattern.class_count();
    const int rounds = pattern.free_steps / classes;     // q
    const int remainder = pattern.free_steps % classes;  // s
    return rounds % 2 == 0 ? classes - remainder : remainder;
}

std::vector<Pattern> patterns_in(int cells, const PatternRange& range) {
    validate(Mesh{cells});
    if (range.period_hi > max_period_steps) {
        throw std::invalid_argument(
            fmt::format("period_hi: expected at most {}, got {}", max_period_steps, range.period_hi));
    }
    std::vector<Pattern> patterns;
    for (int period = std::max(range.period_lo, 2); period <= range.period_hi; ++period) {
        const int contact_lo = std::max(range.contact_lo, 1);
        const int contact_hi = std::min(range.contact_hi, period - 1);
        for (int contact = contact_hi; contact >= contact_lo; --contact) {
            patterns.push_back({cells, period - contact, contact});
        }
    }
    return patterns;
}

}  // namespace nsma
