#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nsma {

/// One CSV field, quoted if it has to be (RFC 4180); control characters become blanks.
[[nodiscard]] std::string csv_text(std::string_view text);
/// The shortest decimal that reads back to the same double; empty unless finite.
[[nodiscard]] std::string csv_number(double value);
[[nodiscard]] std::string csv_number(const std::optional<double>& value);
/// The fields of one CSV line.
[[nodiscard]] std::vector<std::string> csv_fields(std::string_view line);

/// Reads a CSV file with '#' comment lines and a header row, one row at a time. Every failure
/// is an InputError naming file, line and column.
class CsvTable {
public:
    explicit CsvTable(const std::filesystem::path& file);

    /// Moves to the next row; false at the end.
    bool next();
    [[nodiscard]] const std::string& text(std::string_view column) const;
    [[nodiscard]] int integer(std::string_view column) const;
    [[nodiscard]] std::optional<double> number(std::string_view column) const;
    [[noreturn]] void fail(std::string_view column, std::string_view expected) const;

private:
    std::string name_;
    std::vector<std::pair<int, std::string>> lines_;  // line number and line, header excluded
    std::map<std::string, std::size_t, std::less<>> column_;
    std::size_t next_ = 0;
    int line_ = 0;
    std::vector<std::string> fields_;
};

}  // namespace nsma
