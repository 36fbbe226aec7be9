#include "nsma/program/exact.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace nsma {

std::string to_string(const Rational& value) {
    if (denominator(value) == 1) return numerator(value).str();
    return numerator(value).str() + "/" + denominator(value).str();
}

std::optional<Rational> parse_rational(const std::string& text, std::size_t digit_limit) {
    if (text.empty() || text.size() > digit_limit + 2) return std::nullopt;
    const std::size_t sign = text.front() == '-' ? 1 : 0;
    const auto slash = text.find('/');
    const auto digits = [&](std::size_t from, std::size_t to) -> std::optional<Integer> {
        if (from >= to) return std::nullopt;
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

Rational exact(double value) {
    int exponent = 0;
    const double mantissa = std::frexp(value, &exponent);
    const auto digits = static_cast<std::int64_t>(std::ldexp(mantissa, 53));
    exponent -= 53;
    Rational result(digits);
    const Integer power = Integer(1) << std::abs(exponent);
    return exponent >= 0 ? Rational(result * power) : Rational(result / power);
}

std::optional<std::vector<Rational>> solve_exactly(std::vector<std::vector<Integer>> a,
                                                   std::vector<Integer> b) {
    const std::size_t rows = a.size();
    const std::size_t columns = rows == 0 ? 0 : a.front().size();
    if (columns == 0) {
        const bool consistent = std::all_of(b.begin(), b.end(), [](const Integer& v) { return v == 0; });
        return consistent ? std::optional(std::vector<Rational>{}) : std::nullopt;
    }
    if (rows < columns) return std::nullopt;
    // Bareiss: every division is exact, so entries stay minors of the data.
    Integer previous = 1;
    for (std::size_t k = 0; k < columns; ++k) {
        std::size_t pivot = k;
        while (pivot < rows && a[pivot][k] == 0) ++pivot;
        if (pivot == rows) return std::nullopt;
        std::swap(a[pivot], a[k]);
        std::swap(b[pivot], b[k]);
        for (std::size_t i = k + 1; i < rows; ++i) {
            for (std::size_t j = k + 1; j < columns; ++j) {
                a[i][j] = (a[k][k] * a[i][j] - a[i][k] * a[k][j]) / previous;
            }
            b[i] = (a[k][k] * b[i] - a[i][k] * b[k]) / previous;
            a[i][k] = 0;
        }
        previous = a[k][k];
    }
    for (std::size_t i = columns; i < rows; ++i) {
        if (b[i] != 0) return std::nullopt;
    }
    std::vector<Rational> x(columns);
    for (std::size_t k = columns; k-- > 0;) {
        Rational sum(b[k]);
        for (std::size_t j = k + 1; j < columns; ++j) sum -= a[k][j] * x[j];
        x[k] = sum / a[k][k];
    }
    return x;
}

}  // namespace nsma
