#include "csv.hpp"

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>

#include <fmt/format.h>

#include "one_line.hpp"
#include "nsma/report/input_error.hpp"

namespace nsma {

std::string csv_text(std::string_view text) {
    const std::string line = one_line(std::string(text));
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

std::vector<std::string> csv_fields(std::string_view line) {
    std::vector<std::string> fields(1);
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const char letter = line[i];
        if (letter == '"') {
            if (quoted && i + 1 < line.size() && line[i + 1] == '"') {
                fields.back() += '"';
                ++i;
            } else {
                quoted = !quoted;
            }
        } else if (letter == ',' && !quoted) {
            fields.emplace_back();
        } else {
            fields.back() += letter;
        }
    }
    return fields;
}

CsvTable::CsvTable(const std::filesystem::path& file) : name_(file.string()) {
    errno = 0;
    std::ifstream stream(file);
    if (!stream) throw InputError(one_line(fmt::format("{}: cannot be read: {}", name_, std::strerror(errno))));
    int number = 0;
    bool header = true;
    for (std::string line; std::getline(stream, line);) {
        ++number;
        if (!line.empty() && line.back() == '\r') line.pop_back();
        if (line.empty() || line.front() == '#') continue;
        if (header) {
            const std::vector<std::string> names = csv_fields(line);
            for (std::size_t i = 0; i < names.size(); ++i) column_.emplace(names[i], i);
            header = false;
        } else {
            lines_.emplace_back(number, std::move(line));
        }
    }
    if (header) throw InputError(one_line(fmt::format("{}: expected a row of column names, got none", name_)));
}

bool CsvTable::next() {
    if (next_ >= lines_.size()) return false;
    line_ = lines_[next_].first;
    fields_ = csv_fields(lines_[next_].second);
    ++next_;
    if (fields_.size() != column_.size()) {
        throw InputError(
            one_line(fmt::format("{}:{}: expected {} fields, got {}", name_, line_, column_.size(), fields_.size())));
    }
    return true;
}

const std::string& CsvTable::text(std::string_view column) const {
    const auto found = column_.find(column);
    if (found == column_.end()) {
        throw InputError(one_line(fmt::format("{}: expected a column {}, got none", name_, column)));
    }
    return fields_.at(found->second);
}

int CsvTable::integer(std::string_view column) const {
    const std::string& field = text(column);
    int value = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size()) fail(column, "an integer");
    return value;
}

std::optional<double> CsvTable::number(std::string_view column) const {
    const std::string& field = text(column);
    if (field.empty()) return std::nullopt;
    double value = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(value)) {
        fail(column, "a number or nothing");
    }
    return value;
}

void CsvTable::fail(std::string_view column, std::string_view expected) const {
    throw InputError(
        one_line(fmt::format("{}:{}: {}: expected {}, got \"{}\"", name_, line_, column, expected, text(column))));
}

}  // namespace nsma
