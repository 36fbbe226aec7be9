#include "nsma/numerics/exact.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace {

using nsma::exact;
using nsma::Integer;
using nsma::parse_rational;
using nsma::Rational;
using nsma::to_double;
using nsma::to_string;

TEST(Exact, DecimalIsTheFractionThatIsTyped) {
    EXPECT_EQ(nsma::decimal(12.6), Rational(63, 5));
    EXPECT_EQ(nsma::decimal(1e-5), Rational(1, 100'000));
    EXPECT_EQ(nsma::decimal(3e20), Rational(3) * Rational(Integer("100000000000000000000")));
    EXPECT_EQ(nsma::decimal(-0.25), Rational(-1, 4));
    EXPECT_EQ(nsma::decimal(7), Rational(7));
    for (const double value : {0.1, 1.0 / 3.0, 2e-300, 6.02e23}) EXPECT_EQ(to_double(nsma::decimal(value)), value);
}

TEST(Exact, PrintsAndReadsTheSameFraction) {
    std::mt19937 random(1);
    for (int i = 0; i < 2000; ++i) {
        Integer top = random();
        Integer bottom = random() % 1000 + 1;
        for (int k = 0; k < i % 20; ++k) top = top * random() + random(), bottom = bottom * (random() | 1U);
        const Rational value(i % 2 == 0 ? top : Integer(-top), bottom);
        EXPECT_EQ(parse_rational(to_string(value)), value);
    }
    EXPECT_EQ(to_string(Rational(-24, 22)), "-12/11");
    EXPECT_EQ(to_string(Rational(-6, 3)), "-2");
    EXPECT_EQ(to_string(Rational(0)), "0");
}

TEST(Exact, LeadingZerosAreDecimal) {
    EXPECT_EQ(parse_rational("010"), Rational(10));  // not octal
    EXPECT_EQ(parse_rational("-0089/0020"), Rational(-89, 20));
    EXPECT_EQ(parse_rational("000"), Rational(0));
    EXPECT_EQ(parse_rational("-0"), Rational(0));
    EXPECT_EQ(parse_rational("0/5"), Rational(0));
    EXPECT_EQ(parse_rational("6/4"), Rational(3, 2));  // lowest terms are not asked for
}

TEST(Exact, JunkIsNotANumber) {
    for (const char* text :
         {"",   "-",  "/",   "1/",  "/2",   "-/2", "1/0", "1/00", "--1", "+1",  "1/-2", "1//2", "1/2/3",
          " 1", "1 ", "1.5", "1e3", "0x10", "nan", "inf", "1/+2", "١",   "1\n", "a",    "12a",  "1/2b"}) {
        EXPECT_FALSE(parse_rational(text)) << '"' << text << '"';
    }
    EXPECT_FALSE(parse_rational(std::string("1\0", 2)));
    EXPECT_FALSE(parse_rational(std::string(30'000, '1')));
    EXPECT_FALSE(parse_rational("12345678", 5));
    EXPECT_EQ(parse_rational("12345", 5), Rational(12345));
}

TEST(Exact, DoublesAreDyadicFractions) {
    EXPECT_EQ(exact(0.0), 0);
    EXPECT_EQ(exact(-0.0), 0);
    EXPECT_EQ(exact(1.0), 1);
    EXPECT_EQ(exact(-0.375), Rational(-3, 8));
    EXPECT_NE(exact(0.1), Rational(1, 10));
    EXPECT_EQ(exact(0.1), Rational(Integer("3602879701896397"), Integer(1) << 55));  // 0x1.999999999999ap-4
    const Integer one = 1;
    EXPECT_EQ(exact(std::ldexp(1.0, 1023)), Rational(one << 1023));
    EXPECT_EQ(exact(std::numeric_limits<double>::max()), Rational((one << 1024) - (one << 971)));
    EXPECT_EQ(exact(std::numeric_limits<double>::lowest()), -exact(std::numeric_limits<double>::max()));
    EXPECT_EQ(exact(std::numeric_limits<double>::min()), Rational(one, one << 1022));
    EXPECT_EQ(exact(std::numeric_limits<double>::denorm_min()), Rational(one, one << 1074));
    EXPECT_EQ(exact(-3 * std::numeric_limits<double>::denorm_min()), Rational(-3, one << 1074));
}

TEST(Exact, EveryDoubleComesBack) {
    std::mt19937_64 random(2);
    for (int i = 0; i < 5000; ++i) {
        const std::uint64_t bits = random();
        double value = 0;
        std::memcpy(&value, &bits, sizeof value);
        if (!std::isfinite(value)) continue;
        EXPECT_EQ(to_double(exact(value)), value);
    }
    for (const double value : {5e-324, 1.5e-323, 2.2250738585072009e-308, 2.2250738585072014e-308, 1e308, -1e-310}) {
        EXPECT_EQ(to_double(exact(value)), value);
    }
}

TEST(Exact, ToDoubleRoundsToTheNearest) {
    EXPECT_EQ(to_double(Rational(1, 3)), 1.0 / 3.0);  // division of two doubles is the nearest double
    EXPECT_EQ(to_double(Rational(12, 11)), 12.0 / 11.0);
    const Integer big = Integer(1) << 53;
    EXPECT_EQ(to_double(Rational(big + 1)), 0x1p53);  // a tie goes to even
    EXPECT_EQ(to_double(Rational(big + 3)), 0x1p53 + 4);
    EXPECT_EQ(to_double(Rational(2 * big + 3, 2)), 0x1p53 + 2);  // above the tie
    std::mt19937 random(3);
    for (int i = 0; i < 2000; ++i) {
        const double a = static_cast<double>(random());
        const double b = 1.0 + static_cast<double>(random());
        EXPECT_EQ(to_double(Rational(Integer(a), Integer(b))), a / b);
    }
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(to_double(Rational(Integer(1) << 1030)), infinity);
    EXPECT_EQ(to_double(Rational(-(Integer(1) << 1030))), -infinity);
}

}  // namespace
