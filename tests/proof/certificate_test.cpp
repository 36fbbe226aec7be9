#include "nsma/check/certificate.hpp"

#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "../check/literal.hpp"
#include "truth.hpp"

#include "nsma/orbit/backbone.hpp"

namespace {

using nsma::Certificate;
using nsma::check;
using nsma::Pattern;
using nsma::Proof;
using nsma::Rational;
using truth::for_each_problem;
using truth::largest_mesh;
using truth::proof_of;
using truth::title;
using Claim = Certificate::Claim;

/// 1/(k^2 T/tau - (2k + 1))^2.
Rational backbone(int mode, const Pattern& pattern) {
    const Rational root = Rational(mode * mode * pattern.period_steps(), pattern.cells) - (2 * mode + 1);
    return 1 / (root * root);
}

TEST(Certificate, EveryPatternOfSmallMeshesIsProved) {
    int bounded = 0;
    for_each_problem(1, largest_mesh, [&](const Pattern& pattern, int gap_sign) {
        const Proof proof = proof_of(pattern, gap_sign);
        const auto& certificate = proof.certificate;
        EXPECT_TRUE(proof.verdict_proved) << proof.unproved;
        EXPECT_TRUE(proof.unproved.empty()) << proof.unproved;
        const auto result = check(certificate);
        EXPECT_TRUE(result.valid) << result.reason;
        EXPECT_EQ(certificate.claim == Claim::trivial, nsma::kernel_dimension(pattern) == 0);
        if (certificate.claim != Claim::nonempty || gap_sign == 0) return;
        ASSERT_TRUE(certificate.energy_least);
        EXPECT_TRUE(proof.exact_greatest());
        EXPECT_EQ(certificate.kind, nsma::pattern_kind(pattern));
        if (!certificate.ray.empty()) return;
        ++bounded;
        ASSERT_TRUE(certificate.energy_attained);
        EXPECT_LE(*certificate.energy_least, *certificate.energy_attained);
    });
    EXPECT_GT(bounded, 50);
}

TEST(Certificate, LeastEnergyOfModesIsTheFormula) {
    int patterns = 0;
    int simplices = 0;
    for (int cells = 1; cells <= largest_mesh + 4; ++cells) {
        for (int mode = 1; mode <= 3; ++mode) {
            for (const int gap_sign : {-1, 1}) {
                for (const Pattern& pattern : nsma::mode_patterns(mode, cells, gap_sign)) {
                    SCOPED_TRACE(title(pattern, gap_sign) + " mode " + std::to_string(mode));
                    const auto certificate = proof_of(pattern, gap_sign).certificate;
                    ASSERT_EQ(certificate.claim, Claim::nonempty);
                    ASSERT_TRUE(certificate.energy_least);
                    ++patterns;
                    const Rational formula = backbone(mode, pattern);
                    // The uniform orbit of the mode is in the set; on mode 1 it is its nearest point.
                    if (mode > 1) {
                        EXPECT_LE(*certificate.energy_least, formula);
                        continue;
                    }
                    EXPECT_EQ(*certificate.energy_least, formula);
                    const int m = nsma::kernel_dimension(pattern);
                    ASSERT_TRUE(certificate.energy_attained && certificate.energy_bound);
                    EXPECT_EQ(*certificate.energy_attained, m * formula);
                    EXPECT_EQ(*certificate.energy_bound, m * formula);
                    if (m > 1) ++simplices;
                }
            }
        }
    }
    EXPECT_GT(patterns, 40);
    EXPECT_GT(simplices, 5);
}

TEST(Certificate, PublicNumbers) {
    EXPECT_EQ(proof_of({6, 23, 1}, 1).certificate.energy_least, Rational(12, 11));
    const auto certificate = proof_of({6, 16, 4}, 1).certificate;
    EXPECT_EQ(certificate.energy_least, Rational(9));
    EXPECT_EQ(certificate.energy_attained, Rational(36));
    EXPECT_EQ(certificate.energy_bound, Rational(36));
    EXPECT_EQ(proof_of({6, 16, 4}, -1).certificate.claim, Claim::empty);
    EXPECT_EQ(proof_of({1, 1, 2}, 1).certificate.claim, Claim::trivial);
}

/// Believes a certificate from the literal scheme alone: points by their tip history and forces,
/// E_min and emptiness by weak duality with the literal rows.
void expect_literally_true(const Certificate& certificate) {
    const auto problem = literal::problem(certificate.pattern, certificate.gap_sign);
    const auto m = static_cast<std::size_t>(problem.dimension);
    if (certificate.claim == Claim::trivial) {
        EXPECT_EQ(m, 0U);
        return;
    }
    ASSERT_GT(m, 0U);
    if (!certificate.ray.empty()) {
        const auto ray = literal::dense(certificate.ray, problem.dimension);
        EXPECT_FALSE(problem.failing_step(ray, 0));
        EXPECT_GT(problem.energy(ray), 0);
    }
    if (certificate.gap_sign == 0) return;
    // rho: what is left of delta x_0 after the rows, without what COND3 can only make smaller.
    std::vector<Rational> unit(m);
    std::vector<Rational> rho(m);
    for (std::size_t c = 0; c < m; ++c) {
        unit.assign(m, Rational(0));
        unit[c] = 1;
        rho[c] = certificate.gap_sign * problem.tip(unit, 0);
    }
    for (const auto& [n, y] : certificate.projection) {
        ASSERT_GE(y, 0);
        const auto row = literal::rise(problem, n);
        // Half the rise: the certificate counts sum eps beta, the tip moves twice that.
        for (std::size_t c = 0; c < m; ++c) rho[c] -= y * row[c] / 2;
    }
    std::vector<int> up(m, 0);
    std::vector<int> down(m, 0);
    for (int n = certificate.pattern.free_steps; n < problem.period; ++n) {
        const int column = problem.column[static_cast<std::size_t>(n)];
        if (column < 0) continue;
        (problem.sign[static_cast<std::size_t>(n)] > 0 ? up : down)[static_cast<std::size_t>(column)] = 1;
    }
    for (std::size_t c = 0; c < m; ++c) {
        if ((up[c] != 0 && rho[c] < 0) || (down[c] != 0 && rho[c] > 0) || (up[c] != 0 && down[c] != 0)) rho[c] = 0;
    }
    Rational length;
    for (const auto& value : rho) length += value * value;
    if (certificate.claim == Claim::empty) {
        EXPECT_EQ(length, 0);  // delta x_0 <= 0 on the cone, but COND2 wants 1
        return;
    }
    ASSERT_GT(length, 0);
    std::vector<Rational> least(m);
    for (std::size_t c = 0; c < m; ++c) least[c] = rho[c] / length;
    EXPECT_FALSE(problem.failing_step(least, certificate.gap_sign));
    EXPECT_EQ(problem.energy(least), certificate.energy_least);
    if (!certificate.greatest.empty()) {
        const auto point = literal::dense(certificate.greatest, problem.dimension);
        EXPECT_FALSE(problem.failing_step(point, certificate.gap_sign));
        EXPECT_EQ(problem.energy(point), certificate.energy_attained);
    }
}

TEST(Certificate, HoldsInTheLiteralScheme) {
    for_each_problem(1, 4, [](const Pattern& pattern, int gap_sign) {
        expect_literally_true(proof_of(pattern, gap_sign).certificate);
    });
    for (const Pattern& pattern : {Pattern{6, 16, 4}, {6, 23, 1}, {20, 48, 16}, {9, 5, 13}, {12, 40, 2}}) {
        for (const int gap_sign : {-1, 1}) expect_literally_true(proof_of(pattern, gap_sign).certificate);
    }
}

}  // namespace
