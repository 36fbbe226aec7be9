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

}  // namespace nsma
