#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace nsma {

/// The file that describes the CSV tables of a folder, whatever study wrote them, as the W3C's "CSV on the Web" has it:
/// title, notes and, for each table that is there, its columns with their units.
inline constexpr const char* csv_metadata_name = "csv-metadata.json";
/// Throws InputError (one line).
void write_csv_metadata(const std::filesystem::path& folder, const std::string& title);

/// Unit of a column, which the end of its name tells: "s", "m", "N", ...; empty for a pure number or a word.
[[nodiscard]] std::string unit_of_column(std::string_view column);

}  // namespace nsma
