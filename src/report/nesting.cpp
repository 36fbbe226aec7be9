#include "nesting.hpp"

#include <algorithm>

namespace nsma {
namespace {

// The end of the string, of one line or several, that begins with a quotation mark here.
std::size_t end_of_string(std::string_view text, std::size_t begin) {
    const char mark = text[begin];
    const bool lines = text.substr(begin, 3) == std::string_view(mark == '"' ? "\"\"\"" : "'''");
    const std::string_view close = text.substr(begin, lines ? 3 : 1);
    for (std::size_t at = begin + close.size(); at < text.size(); ++at) {
        if (mark == '"' && text[at] == '\\') {
            ++at;
        } else if (text.substr(at, close.size()) == close) {
            std::size_t end = at + close.size();
            // Up to two more marks belong to the text of several lines that they end.
            for (int more = 0; lines && more < 2 && end < text.size() && text[end] == mark; ++more) ++end;
            return end;
        } else if (!lines && text[at] == '\n') {
            return at;  // left open
        }
    }
    return text.size();
}

}  // namespace

std::optional<std::size_t> too_deep(std::string_view text, int limit) {
    int brackets = 0;
    int dots = 0;  // since the last sign that ends a key
    for (std::size_t at = 0; at < text.size(); ++at) {
        switch (text[at]) {
            case '"':
            case '\'': at = end_of_string(text, at) - 1; break;
            case '#': at = std::min(text.find('\n', at), text.size()) - 1; break;
            case '[':
            case '{':
                dots = 0;
                if (++brackets > limit) return at;
                break;
            case ']':
            case '}':
                dots = 0;
                brackets = std::max(brackets - 1, 0);
                break;
            case '.':
                if (++dots >= limit) return at;
                break;
            case '=':
            case ',':
            case '\n': dots = 0; break;
            default: break;
        }
    }
    return std::nullopt;
}

}  // namespace nsma
