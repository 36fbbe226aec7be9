#pragma once

#include <array>
#include <numeric>
#include <string>

#include <fmt/format.h>

#include "nsma/orbit/pattern_kind.hpp"

namespace nsma::app {

/// Admissible patterns by kind.
class KindCounts {
public:
    void add(PatternKind kind) { ++counts_.at(static_cast<std::size_t>(kind)); }
    [[nodiscard]] long total() const { return std::accumulate(counts_.begin(), counts_.end(), 0L); }
    [[nodiscard]] std::string text() const {
        return fmt::format("{} contact, {} free, {} stuck", counts_[0], counts_[1], counts_[2]);
    }

private:
    std::array<long, pattern_kinds.size()> counts_{};
};

}  // namespace nsma::app
