#pragma once

#include <algorithm>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

namespace nsma {

/// ", did you mean WORD?" where one of the words differs from `given` by two letters at most, and by less than half;
/// else nothing.
template <class Words>
[[nodiscard]] std::string did_you_mean(std::string_view given, const Words& words) {
    std::string_view nearest;
    std::size_t least = std::min<std::size_t>(3, (given.size() + 1) / 2);
    if (given.size() > 100) return {};
    for (const std::string_view word : words) {
        // Letters to insert, leave out or change, row by row of the table of prefixes.
        std::vector<std::size_t> row(word.size() + 1);
        std::iota(row.begin(), row.end(), std::size_t{0});
        for (std::size_t i = 0; i < given.size(); ++i) {
            std::size_t before = row[0]++;
            for (std::size_t j = 0; j < word.size(); ++j) {
                const std::size_t changed = before + (given[i] == word[j] ? 0 : 1);
                before = row[j + 1];
                row[j + 1] = std::min({changed, row[j] + 1, before + 1});
            }
        }
        if (row.back() >= least) continue;
        least = row.back();
        nearest = word;
    }
    return nearest.empty() ? std::string() : ", did you mean " + std::string(nearest) + "?";
}

}  // namespace nsma
