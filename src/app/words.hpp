#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "nsma/report/scene_file.hpp"

/// What words of the command line mean.
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

/// One orbit as R,P or R,P,E: steps, and an energy as --energy has it.
struct OrbitWord {
    int free, contact;
    std::optional<std::pair<double, bool>> energy;
};
inline std::optional<OrbitWord> orbit_in(std::string_view word) {
    const std::size_t first = word.find(',');
    if (first == std::string_view::npos) return std::nullopt;
    const std::size_t second = word.find(',', first + 1);
    const auto free = number_in<int>(word.substr(0, first));
    const auto contact = number_in<int>(word.substr(first + 1, second - first - 1));
    if (!free || !contact || *free < 1 || *contact < 1) return std::nullopt;
    if (second == std::string_view::npos) return OrbitWord{*free, *contact, std::nullopt};
    const auto energy = energy_in(word.substr(second + 1));
    return energy ? std::optional(OrbitWord{*free, *contact, energy}) : std::nullopt;
}

/// The size of a picture as WIDTH or WIDTHxHEIGHT.
inline std::optional<std::array<std::optional<int>, 2>> size_in(std::string_view word) {
    constexpr int least = 100;
    constexpr int most = 20'000;
    const auto fits = [](const std::optional<int>& value) { return value && *value >= least && *value <= most; };
    const std::size_t cross = word.find('x');
    const auto width = number_in<int>(word.substr(0, cross));
    if (!fits(width)) return std::nullopt;
    if (cross == std::string_view::npos) return std::array{width, std::optional<int>()};
    const auto height = number_in<int>(word.substr(cross + 1));
    return fits(height) ? std::optional(std::array{width, height}) : std::nullopt;
}

/// Words between commas, each once.
inline std::vector<std::string> parts(const std::string& word) {
    std::vector<std::string> found;
    std::istringstream stream(word + ',');
    for (std::string part; std::getline(stream, part, ',');) {
        if (std::find(found.begin(), found.end(), part) == found.end()) found.push_back(part);
    }
    return found;
}

}  // namespace nsma::app
