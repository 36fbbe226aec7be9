// The checker alone: certificates written by hand, true ones and false ones.
#include <numeric>
#include <string>

#include <gtest/gtest.h>

#include "literal.hpp"

namespace {

using nsma::Certificate;
using nsma::check;
using nsma::Integer;
using nsma::Pattern;
using nsma::PatternKind;
using nsma::Rational;
using nsma::RationalVector;
using Claim = Certificate::Claim;

Certificate claimed(const Pattern& pattern, int gap_sign, Claim claim) {
    Certificate certificate;
    certificate.pattern = pattern;
    certificate.gap_sign = gap_sign;
    certificate.claim = claim;
    return certificate;
}

/// A nonempty set at a gap > 0 of m columns whose weights in COND2 are all -1.
Certificate bounded_set(const Pattern& pattern, PatternKind kind, int m, const Rational& least, int greatest_square,
                        bool chain) {
    Certificate certificate = claimed(pattern, 1, Claim::nonempty);
    certificate.kind = kind;
    certificate.energy_least = least;
    certificate.energy_attained = certificate.energy_bound = greatest_square * m * least;
    for (int column = 0; column < greatest_square; ++column)
        certificate.greatest.emplace_back(column, column % 2 == 0 ? -1 : 1);
    if (!chain) return certificate;
    certificate.chain.resize(static_cast<std::size_t>(m));
    std::iota(certificate.chain.begin(), certificate.chain.end(), 0);
    return certificate;
}

/// Every column pushes one way: a simplex.
Certificate simplex() { return bounded_set({6, 16, 4}, PatternKind::contact, 4, 9, 1, false); }
/// No contact step carries a wave: 0 >= P_k >= P_m = -1 for the partial sums of beta.
Certificate chain() { return bounded_set({2, 7, 1}, PatternKind::free, 3, Rational(4, 3), 3, true); }
Certificate long_chain() { return bounded_set({6, 23, 1}, PatternKind::free, 11, Rational(12, 11), 11, true); }

Certificate trivial() { return claimed({1, 1, 2}, 1, Claim::trivial); }
/// COND3 keeps the tip on the other side.
Certificate wrong_side() { return claimed({6, 16, 4}, -1, Claim::empty); }
/// The whole sum is <= 0 by its COND1 row, where COND2 wants it positive.
Certificate empty_chain() {
    Certificate certificate = claimed({2, 7, 1}, -1, Claim::empty);
    certificate.projection = {{3, 1}};
    return certificate;
}

Certificate closed_ray() {
    Certificate certificate = claimed({8, 16, 8}, 0, Claim::nonempty);
    certificate.kind = PatternKind::contact;
    for (int column = 0; column < 8; ++column) certificate.ray.emplace_back(column, -1);
    return certificate;
}
Certificate closed_simplex() { return claimed({6, 16, 4}, 0, Claim::empty); }
Certificate closed_chain() {
    Certificate certificate = claimed({2, 7, 1}, 0, Claim::empty);
    certificate.chain = {0, 1, 2};
    return certificate;
}
/// COND1 lets COND3's columns be zero only.
Certificate closed_forced() {
    Certificate certificate = claimed({12, 8, 2}, 0, Claim::empty);
    certificate.forcing_row = 2;
    return certificate;
}

TEST(Check, AcceptsWhatIsTrue) {
    for (const auto& certificate : {simplex(), chain(), long_chain(), trivial(), wrong_side(), empty_chain(),
                                    closed_ray(), closed_simplex(), closed_chain(), closed_forced()}) {
        EXPECT_EQ(check(certificate).reason, "")
            << certificate.pattern.cells << ' ' << certificate.pattern.free_steps << ' ' << certificate.gap_sign;
        EXPECT_TRUE(check(certificate).valid);
    }
}

/// The reason with which a changed certificate is refused.
template <class Change>
std::string reason_after(Certificate certificate, Change change) {
    change(certificate);
    const auto result = check(certificate);
    EXPECT_FALSE(result.valid);
    return result.reason;
}

TEST(Check, SaysWhatDoesNotHold) {
    EXPECT_EQ(reason_after(simplex(), [](auto& c) { c.claim = Claim::trivial; }),
              "kind: expected none but for a nonempty set");
    EXPECT_EQ(reason_after(wrong_side(), [](auto& c) { c.claim = Claim::trivial; }),
              "claim: expected a kernel of dimension 0, got 4");
    EXPECT_EQ(reason_after(trivial(), [](auto& c) { c.claim = Claim::empty; }),
              "claim: expected a nontrivial kernel, got dimension 0");
    EXPECT_EQ(reason_after(wrong_side(), [](auto& c) { c.gap_sign = 1; }), "Farkas vector: column 0 is left over");
    EXPECT_EQ(reason_after(empty_chain(), [](auto& c) { c.projection.clear(); }),
              "Farkas vector: column 0 is left over");
    EXPECT_EQ(reason_after(simplex(), [](auto& c) { c.gap_sign = -1; }), "least-energy point: the projection is zero");
    EXPECT_EQ(reason_after(simplex(), [](auto& c) { c.kind = PatternKind::free; }),
              "kind: a contact step carries a wave, so free is not proved");
    EXPECT_EQ(reason_after(simplex(), [](auto& c) { c.kind = PatternKind::stuck; }),
              "kind: a free step carries a wave, so stuck is not proved");
    EXPECT_EQ(reason_after(chain(), [](auto& c) { c.kind = PatternKind::contact; }),
              "kind: the point does not press against the wall");
    EXPECT_EQ(reason_after(simplex(), [](auto& c) { c.kind.reset(); }),
              "kind: expected contact, free or stuck, got none");
    EXPECT_EQ(reason_after(simplex(), [](auto& c) { c.ray = {{0, -1}}; }), "ray: expected none where there is a gap");
    EXPECT_EQ(reason_after(closed_ray(), [](auto& c) { c.ray.clear(); }), "ray: expected a nonzero direction");
    EXPECT_EQ(reason_after(closed_ray(), [](auto& c) { c.ray[0].second = 1; }), "ray: COND3 fails at column 0");
    EXPECT_EQ(reason_after(closed_chain(), [](auto& c) { c.chain.clear(); }),
              "rest: COND2 and COND3 alone leave more, and neither a row nor a chain is given");
    EXPECT_EQ(reason_after(closed_chain(), [](auto& c) { c.chain.pop_back(); }), "chain: column 2 is missing");
    EXPECT_EQ(reason_after(closed_chain(), [](auto& c) { std::swap(c.chain[0], c.chain[1]); }),
              "chain: COND1 does not bound the sum of its first 1 columns");
    EXPECT_EQ(reason_after(closed_forced(), [](auto& c) { c.forcing_row = *c.forcing_row - 1; }),
              "forcing row: column 1 is left");
    EXPECT_EQ(reason_after(closed_forced(), [](auto& c) { c.forcing_row = c.pattern.free_steps; }),
              "forcing row: expected a step in 1..7, got 8");
    EXPECT_EQ(reason_after(chain(), [](auto& c) { c.chain.pop_back(); }), "chain: column 2 is missing");
    EXPECT_EQ(reason_after(chain(), [](auto& c) { c.chain.back() = 0; }), "chain: column 0 twice");
    EXPECT_EQ(reason_after(chain(), [](auto& c) { c.chain.back() = 3; }), "chain: unknown column 3");
    EXPECT_EQ(reason_after(chain(), [](auto& c) { c.chain.clear(); }), "chain: column 0 is missing");
    EXPECT_EQ(reason_after(simplex(), [](auto& c) { c.energy_bound = 35; }), "energy_bound: proved only 36");
    EXPECT_EQ(reason_after(long_chain(), [](auto& c) { c.energy_bound = 131; }), "energy_bound: proved only 132");
    EXPECT_EQ(reason_after(simplex(), [](auto& c) { c.greatest[0].second = Rational(1, Integer(1) << 50); }),
              "numbers: expected all over a common denominator below 2^40");
    EXPECT_EQ(reason_after(chain(), [](auto& c) { c.energy_bound = 11; }), "energy_bound: proved only 12");
}

TEST(Check, EveryClaimedEnergyIsTied) {
    const auto original = simplex();
    const Rational little(1, Integer(1) << 200);  // far below any double
    for (const int side : {-1, 1}) {
        auto forged = original;
        *forged.energy_least += side * little;
        EXPECT_FALSE(check(forged).valid);
        forged = original;
        *forged.energy_attained += side * little;
        EXPECT_FALSE(check(forged).valid);
        forged = original;
        *forged.energy_bound += side * little;
        EXPECT_EQ(check(forged).valid, side > 0);  // a weaker bound is still true
    }
}

TEST(Check, NamesTheRowThatFails) {
    const auto original = simplex();
    auto forged = original;
    forged.projection = {{3, Rational(-1)}};
    EXPECT_EQ(check(forged).reason, "COND1 row 3: multiplier is negative");
    forged.projection = {{16, Rational(1)}};
    EXPECT_EQ(check(forged).reason, "rows: expected increasing steps in 1..15, got 16");

    // Points moved off the set: the step named is the first the literal scheme finds.
    int named = 0;
    for (const auto& certificate : {simplex(), chain(), long_chain()}) {
        const auto problem = literal::problem(certificate.pattern, 1);
        for (int column = 0; column < problem.dimension; ++column) {
            for (const int move : {-1, 1}) {
                auto moved = literal::dense(certificate.greatest, problem.dimension);
                moved[static_cast<std::size_t>(column)] += move;
                auto attempt = certificate;
                attempt.greatest.clear();
                for (int c = 0; c < problem.dimension; ++c) {
                    const auto& value = moved[static_cast<std::size_t>(c)];
                    if (value != 0) attempt.greatest.emplace_back(c, value);
                }
                const auto result = check(attempt);
                EXPECT_FALSE(result.valid);
                const std::string lead = "greatest-energy point: COND1 row ";
                if (result.reason.rfind(lead, 0) != 0) continue;
                ++named;
                const int row = std::stoi(result.reason.substr(lead.size()));
                // COND1 alone: the rise over x_0, whatever COND2 says.
                for (int n = 1; n <= row; ++n) {
                    EXPECT_EQ(problem.tip(moved, n) - problem.tip(moved, 0) > 0, n == row)
                        << result.reason << " at " << n;
                }
            }
        }
    }
    EXPECT_GT(named, 3);
    forged = original;
    forged.energy_least = Rational(8);
    EXPECT_EQ(check(forged).reason, "energy_least: expected 9");
}

TEST(Check, RefusesSizesAndSignsItCannotMean) {
    const auto original = simplex();
    for (const int wrong : {0, -1, 2'000'001, 1 << 30}) {
        auto forged = original;
        forged.pattern.cells = wrong;
        EXPECT_FALSE(check(forged).valid);
        forged = original;
        forged.pattern.free_steps = wrong;
        EXPECT_FALSE(check(forged).valid);
        forged = original;
        forged.pattern.contact_steps = wrong;
        EXPECT_FALSE(check(forged).valid);
    }
    for (const int wrong : {-2, 2, 1 << 30}) {
        auto forged = original;
        forged.gap_sign = wrong;
        EXPECT_FALSE(check(forged).valid);
    }
}

TEST(Check, TrivialAndEmptyHaveNoEnergies) {
    for (const auto& certificate : {trivial(), wrong_side()}) {
        ASSERT_TRUE(check(certificate).valid);
        auto forged = certificate;
        forged.energy_least = Rational(1);
        EXPECT_FALSE(check(forged).valid);
        forged = certificate;
        forged.energy_bound = Rational(1);
        EXPECT_FALSE(check(forged).valid);
    }
}

}  // namespace
