#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <utility>

#include "nsma/orbit/motion_label.hpp"
#include "nsma/search/answer.hpp"

namespace nsma {

/// The motions of the answers so far, by level.
class SeenMotions {
public:
    /// Whether an answer at this place came before with the same motion; if not, it is one from now on.
    bool before(const OrbitAnswer& answer, int place) {
        const auto motion = answer.orbit ? least_label(*answer.orbit) : std::nullopt;
        if (!motion) return false;
        bool known = false;
        const auto numbers = fingerprints(*motion);
        for (std::size_t grid = 0; grid < numbers.size(); ++grid)
            known = !seen_.at(grid).emplace(place, numbers.at(grid)).second || known;
        return known;
    }

private:
    std::array<std::set<std::pair<int, std::uint64_t>>, 2> seen_;
};

}  // namespace nsma
