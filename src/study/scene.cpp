#include "nsma/study/scene.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "nsma/orbit/backbone.hpp"

namespace nsma {
namespace {

// Bounds given in tau are met exactly by steps n = ratio N; decimals such as 3.3 are not exact
// in binary, so a bound missed by rounding only is met.
constexpr double bound_rounding = 1e-9;

int first_step(double ratio, int cells) { return static_cast<int>(std::ceil(ratio * cells - bound_rounding)); }
int last_step(double ratio, int cells) { return static_cast<int>(std::floor(ratio * cells + bound_rounding)); }

struct Visit {
    const Scene& scene;

    std::vector<Pattern> operator()(const ModeSelection& selection) const {
        return mode_patterns(selection.mode, scene.mesh.cells, scene.bar.gap_sign());
    }
    std::vector<Pattern> operator()(const PeriodSelection& selection) const {
        const int cells = scene.mesh.cells;
        if (!(std::abs(selection.period[1]) * cells < max_period_steps)) {
            throw std::invalid_argument("period: expected at most " + std::to_string(max_period_steps) +
                                        " steps, got " + std::to_string(selection.period[1] * cells));
        }
        PatternRange range;
        range.period_lo = std::max(2, first_step(selection.period[0], cells));
        range.period_hi = last_step(selection.period[1], cells);
        if (selection.contact) {
            range.contact_lo = std::max(1, first_step((*selection.contact)[0], cells));
            range.contact_hi =
                std::min(range.period_hi, last_step(std::min((*selection.contact)[1], selection.period[1]), cells));
        }
        return patterns_in(cells, range);
    }
    std::vector<Pattern> operator()(const ListSelection& selection) const {
        std::vector<Pattern> patterns;
        for (const auto& [free, contact] : selection.steps) {
            patterns.push_back({scene.mesh.cells, free, contact});
        }
        return patterns;
    }
};

}  // namespace

std::vector<Pattern> patterns_of(const Scene& scene) { return std::visit(Visit{scene}, scene.patterns); }

}  // namespace nsma
