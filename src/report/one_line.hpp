#pragma once

#include <string>

namespace nsma {

/// The text with every control character replaced by a blank, so that a message stays one line.
[[nodiscard]] inline std::string one_line(std::string text) {
    for (char& letter : text) {
        if (static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f) letter = ' ';
    }
    return text;
}

/// What a message shows of a text that may be of any length.
[[nodiscard]] inline std::string shortened(std::string text, std::size_t shown = 60) {
    if (text.size() <= shown) return text;
    std::size_t end = shown - 3;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0U) == 0x80) --end;  // no half letter
    return text.replace(end, std::string::npos, "...");
}

}  // namespace nsma
