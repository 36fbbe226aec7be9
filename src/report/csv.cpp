#include "csv.hpp"

#include <cmath>

#include <fmt/format.h>

#include "one_line.hpp"

namespace nsma {

std::string csv_text(std::string_view text) {
    std::string line = one_line(std::string(text));
    if (line.find_first_of(",\"#") == std::string::npos) return line;
    std::string quoted = "\"";
    for (const char letter : line) {
        if (letter == '"') quoted += '"';
        quoted += letter;
    }
    return quoted + '"';
}

std::string csv_number(double value) {
    return std::isfinite(value) ? fmt::format("{}", value + 0.0) : std::string();  // no negative zero
}

std::string csv_number(const std::optional<double>& value) { return value ? csv_number(*value) : std::string(); }

}  // namespace nsma
