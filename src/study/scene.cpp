#include "nsma/study/scene.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "nsma/orbit/backbone.hpp"

namespace nsma {
namespace {

// Bounds given in tau are met exactly by steps n = ratio N; decimals such as 3.3 are not exact
// in binary, so a bound missed by rounding only is met.
constexpr double bound_rounding = 1e-9;

// Beyond the longest period all steps are alike, and a whole number could not hold them.
int whole_step(double step) { return static_cast<int>(std::clamp(step, -1.0, max_period_steps + 1.0)); }
int first_step(double ratio, int cells) { return whole_step(std::ceil(ratio * cells - bound_rounding)); }
int last_step(double ratio, int cells) { return whole_step(std::floor(ratio * cells + bound_rounding)); }

PatternRange range_of(const PeriodSelection& selection, int cells) {
    if (!(std::abs(selection.period[1]) * cells <= max_period_steps)) {
        throw std::invalid_argument(
            fmt::format("period: expected at most {} steps, got {:g}", max_period_steps, selection.period[1] * cells));
    }
    PatternRange range;
    range.period_lo = std::max(2, first_step(selection.period[0], cells));
    range.period_hi = last_step(selection.period[1], cells);
    if (selection.contact) {
        range.contact_lo = std::max(1, first_step((*selection.contact)[0], cells));
        range.contact_hi =
            std::min(range.period_hi, last_step(std::min((*selection.contact)[1], selection.period[1]), cells));
    }
    return range;
}

struct Patterns {
    const Scene& scene;

    std::vector<Pattern> operator()(const ModeSelection& selection) const {
        return mode_patterns(selection.mode, scene.mesh.cells, scene.bar.gap_sign());
    }
    std::vector<Pattern> operator()(const PeriodSelection& selection) const {
        return patterns_in(scene.mesh.cells, range_of(selection, scene.mesh.cells));
    }
    std::vector<Pattern> operator()(const ListSelection& selection) const {
        std::vector<Pattern> patterns;
        for (const auto& [free, contact] : selection.steps) {
            patterns.push_back({scene.mesh.cells, free, contact});
        }
        return patterns;
    }
};

// How many there are, without listing them.
struct Count {
    const Scene& scene;

    std::int64_t operator()(const ModeSelection& selection) const {
        return static_cast<std::int64_t>(Patterns{scene}(selection).size());  // at most two a cell
    }
    std::int64_t operator()(const PeriodSelection& selection) const {
        const PatternRange range = range_of(selection, scene.mesh.cells);
        std::int64_t count = 0;
        for (int period = std::max(range.period_lo, 2); period <= range.period_hi; ++period)
            count += std::max(0, std::min(range.contact_hi, period - 1) - std::max(range.contact_lo, 1) + 1);
        return count;
    }
    std::int64_t operator()(const ListSelection& selection) const {
        return static_cast<std::int64_t>(selection.steps.size());
    }
};

}  // namespace

void expect_feasible(const Scene& scene) {
    const std::int64_t patterns = std::visit(Count{scene}, scene.patterns);
    if (patterns > max_patterns) {
        throw std::invalid_argument(fmt::format(
            "patterns: expected at most {}, got {}: fewer cells, shorter periods or fewer contact durations "
            "make fewer",
            max_patterns, patterns));
    }
    const auto levels = static_cast<std::int64_t>(scene.levels.size());
    if (patterns * levels > max_pattern_levels) {
        throw std::invalid_argument(fmt::format("levels: expected at most {} over all patterns, got {}",
                                                max_pattern_levels, patterns * levels));
    }
}

std::vector<Pattern> patterns_of(const Scene& scene) { return std::visit(Patterns{scene}, scene.patterns); }

}  // namespace nsma
