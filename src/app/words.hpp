#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

#include "nsma/report/scene_file.hpp"

/// Words of the command line as numbers.
namespace nsma::app {

/// The number that a word is from its first to its last character, decimal whatever it begins with.
template <class Value>
std::optional<Value> number_in(std::string_view word) {
    if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
    Value value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc() && end == word.data() + word.size() ? std::optional(value) : std::nullopt;
}

/// An energy and whether it is in joules: 12.6, 0.8J.
inline std::optional<std::pair<double, bool>> energy_in(std::string_view word) {
    const bool joules = word.ends_with('J');
    if (joules) word.remove_suffix(1);
    const auto value = number_in<double>(word);
    if (!value || !(*value >= least_level && *value <= greatest_level)) return std::nullopt;
    return std::pair{*value, joules};
}

}  // namespace nsma::app
