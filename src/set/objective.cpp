#include "nsma/set/objective.hpp"

#include <array>
#include <utility>

namespace nsma {
namespace {
constexpr std::array<std::pair<Objective, std::string_view>, 5> names{{
    {Objective::least_shock, "least-shock"},
    {Objective::nearest, "nearest"},
    {Objective::least_force, "least-force"},
    {Objective::min_energy, "min-energy"},
    {Objective::max_energy, "max-energy"},
}};
}  // namespace

std::string_view name(Objective objective) {
    for (const auto& [value, text] : names) {
        if (value == objective) return text;
    }
    return "unknown";
}

std::optional<Objective> objective_named(std::string_view text) {
    for (const auto& [value, known] : names) {
        if (known == text) return value;
    }
    return std::nullopt;
}

}  // namespace nsma
