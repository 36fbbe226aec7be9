#pragma once

#include <filesystem>
#include <string>

namespace nsma {

/// The report that a sweep leaves in its folder.
inline constexpr const char* report_name = "report.html";

/// One page of HTML, for itself, with what a folder holds of a sweep (and the shadow prices of its orbits) and of an
/// accuracy study: data, program and styles, nothing from elsewhere. Every number is as it was computed; `program`
/// says what wrote the page. Throws InputError (one line) where the folder holds neither or cannot be read.
[[nodiscard]] std::string report_page(const std::filesystem::path& folder, const std::string& program);

}  // namespace nsma
