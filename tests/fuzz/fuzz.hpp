#pragma once

#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace fuzz {

/// Ends the process as a find of the fuzzer where a claim does not hold.
inline void expect(bool holds, std::string_view claim, std::string_view seen = {}) {
    if (holds) return;
    std::fprintf(stderr, "does not hold: %.*s: %.*s\n", static_cast<int>(claim.size()), claim.data(),
                 static_cast<int>(seen.size()), seen.data());
    std::abort();
}

/// A refusal is one short line.
inline void expect_one_line(std::string_view message) {
    expect(!message.empty() && message.size() < 1000, "a refusal is short", message);
    for (const char letter : message)
        expect(static_cast<unsigned char>(letter) >= 0x20 && letter != 0x7f, "a refusal is one line", message);
}

}  // namespace fuzz
