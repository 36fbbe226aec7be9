#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

namespace nsma {

/// Integer of any size: all data of a pattern are small integers, so every proof can be checked without rounding.
using Integer = boost::multiprecision::cpp_int;
/// Fraction of such integers in lowest terms.
using Rational = boost::multiprecision::cpp_rational;

/// Sparse vector: (index, value) with increasing index.
using RationalVector = std::vector<std::pair<int, Rational>>;

/// "12/11", "-3"; the inverse of parse_rational.
[[nodiscard]] std::string to_string(const Rational& value);

/// Reads an optional minus sign, digits and optionally "/digits" (not zero); absent on anything else
/// or where either part has more than `digit_limit` digits.
[[nodiscard]] std::optional<Rational> parse_rational(const std::string& text, std::size_t digit_limit = 256);

/// Nearest double; overflows to infinity.
[[nodiscard]] double to_double(const Rational& value);

/// The shortest decimal that reads back to this finite double, as a fraction: 12.6 is 63/5.
[[nodiscard]] Rational decimal(double value);

/// The exact value of a finite double.
[[nodiscard]] Rational exact(double value);

}  // namespace nsma
