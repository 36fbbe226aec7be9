#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "nsma/wave/bar.hpp"
#include "nsma/wave/damping.hpp"
#include "nsma/wave/mesh.hpp"
#include "nsma/orbit/pattern_kind.hpp"
#include "nsma/set/objective.hpp"
#include "nsma/study/forcing.hpp"

namespace nsma {

/// Patterns of one nonsmooth mode (closed form).
struct ModeSelection {
    int mode = 1;  ///< k >= 1
};
/// Patterns by period and, if given, contact duration, both in units of tau, bounds included.
struct PeriodSelection {
    std::array<double, 2> period{0.0, 4.0};        ///< [lo, hi] of T/tau
    std::optional<std::array<double, 2>> contact;  ///< [lo, hi] of p/N; absent: any
};
/// Patterns named one by one as (r, p).
struct ListSelection {
    std::vector<std::pair<int, int>> steps;  ///< (r, p), in the order wanted
};
/// One of the three ways to name patterns.
using PatternSelection = std::variant<ModeSelection, PeriodSelection, ListSelection>;

/// What to compute: the plain data of a scene file, already checked.
struct Scene {
    std::string title;                             ///< as charts show it
    Bar bar;                                       ///< SI units
    Mesh mesh;                                     ///< N cells
    PatternSelection patterns;                     ///< which patterns
    bool all_kinds = false;                        ///< solve free and stuck patterns as well as contact motions
    std::vector<double> levels;                    ///< energy ratios E/E_g, joules for a closed gap; all > 0
    Objective objective = Objective::least_shock;  ///< of the orbits at the levels
    Damping damping;                               ///< of `forced` and `march`
    std::optional<Forcing> forcing;                ///< of `forced`
    std::string text;                              ///< the scene file as read; empty for a scene made in code
};

/// Whether a pattern of this kind is solved; of other patterns only the verdict is given.
[[nodiscard]] inline bool is_solved(bool all_kinds, const std::optional<PatternKind>& kind) {
    return kind && (all_kinds || *kind == PatternKind::contact);
}

/// Most patterns of one scene: what memory holds in any case.
inline constexpr std::int64_t max_patterns = 10'000'000;
/// Most levels of one scene over all of its patterns.
inline constexpr std::int64_t max_pattern_levels = 1'000'000'000;
/// Throws std::invalid_argument (name, expected, got) where a scene, checked otherwise, asks for more.
void expect_feasible(const Scene& scene);

/// The patterns of a scene on its mesh, those of trivial kernel included, ordered by n_T then r
/// (a list keeps its order).
[[nodiscard]] std::vector<Pattern> patterns_of(const Scene& scene);

}  // namespace nsma
