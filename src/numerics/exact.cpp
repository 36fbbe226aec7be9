#include "nsma/numerics/exact.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

namespace nsma {

std::string to_string(const Rational& value) {
    if (denominator(value) == 1) return numerator(value).str();
    return numerator(value).str() + "/" + denominator(value).str();
}

std::optional<Rational> parse_rational(const std::string& text, std::size_t digit_limit) {
    if (text.empty()) return std::nullopt;
    const std::size_t sign = text.front() == '-' ? 1 : 0;
    const auto slash = text.find('/');
    const auto digits = [&](std::size_t from, std::size_t to) -> std::optional<Integer> {
        if (from >= to || to - from > digit_limit) return std::nullopt;
        const bool all = std::all_of(text.begin() + static_cast<std::ptrdiff_t>(from),
                                     text.begin() + static_cast<std::ptrdiff_t>(to),
                                     [](unsigned char c) { return c >= '0' && c <= '9'; });
        if (!all) return std::nullopt;
        // A leading zero would be read as octal.
        const auto first = std::min(text.find_first_not_of('0', from), to - 1);
        return Integer(text.substr(first, to - first));
    };
    const auto top = digits(sign, slash == std::string::npos ? text.size() : slash);
    if (!top) return std::nullopt;
    Integer bottom = 1;
    if (slash != std::string::npos) {
        const auto read = digits(slash + 1, text.size());
        if (!read || *read == 0) return std::nullopt;
        bottom = *read;
    }
    const Rational value(*top, bottom);
    return sign == 1 ? Rational(-value) : value;
}

double to_double(const Rational& value) { return value.convert_to<double>(); }

Rational decimal(double value) {
    std::array<char, 40> text{};
    const auto* const end = std::to_chars(text.begin(), text.end(), value, std::chars_format::scientific).ptr;
    const std::string_view word(text.data(), static_cast<std::size_t>(end - text.begin()));
    const std::size_t mark = word.find('e');
    std::string digits;
    for (const char letter : word.substr(0, mark)) {
        if (letter != '.') digits += letter;
    }
    const std::size_t point = word.find('.');
    const int places = point == std::string_view::npos ? 0 : static_cast<int>(mark - point - 1);
    const int exponent = std::stoi(std::string(word.substr(mark + 1))) - places;
    Rational result = parse_rational(digits).value();
    const Integer power = boost::multiprecision::pow(Integer(10), static_cast<unsigned>(std::abs(exponent)));
    if (exponent >= 0)
        result *= power;
    else
        result /= power;
    return result;
}

Rational exact(double value) {
    int exponent = 0;
    const double mantissa = std::frexp(value, &exponent);
    const auto digits = static_cast<std::int64_t>(std::ldexp(mantissa, 53));
    exponent -= 53;
    Rational result(digits);
    const Integer power = Integer(1) << std::abs(exponent);
    return exponent >= 0 ? Rational(result * power) : Rational(result / power);
}

}  // namespace nsma
