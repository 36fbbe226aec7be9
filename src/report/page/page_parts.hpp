#pragma once

#include <string_view>
#include <vector>

namespace nsma {

/// The files of the page, joined into the program when it is built (embed.cmake): each part is its files one after
/// another.
extern const std::vector<std::string_view> page_html, page_style, page_licence, page_vendor, page_script;

}  // namespace nsma
