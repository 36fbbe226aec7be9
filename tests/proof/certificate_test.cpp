#include "nsma/check/certificate.hpp"

#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "literal.hpp"
#include "truth.hpp"

#include "nsma/orbit/backbone.hpp"

namespace {

using nsma::Certificate;
using nsma::check;
using nsma::FormBound;
using nsma::Integer;
using nsma::Pattern;
using nsma::Proof;
using nsma::Rational;
using nsma::RationalVector;
using nsma::RowCombination;
using truth::proof_of;
using Claim = Certificate::Claim;

// Under the address sanitizer the same tests look at fewer patterns.
#ifdef __SANITIZE_ADDRESS__
constexpr int largest_mesh = 5;
#else
constexpr int largest_mesh = 8;
#endif

std::string title(const Pattern& pattern, int gap_sign) {
    return "(" + std::to_string(pattern.cells) + ", " + std::to_string(pattern.free_steps) + ", " +
           std::to_string(pattern.contact_steps) + ") gap " + std::to_string(gap_sign);
}

template <typename Visit>
void for_each_problem(int from, int to, Visit visit) {
    for (int cells = from; cells <= to; ++cells) {
        for (const Pattern& pattern : truth::patterns(cells)) {
            for (const int gap_sign : {-1, 0, 1}) {
                SCOPED_TRACE(title(pattern, gap_sign));
                visit(pattern, gap_sign);
            }
        }
    }
}

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

/// Every number of a certificate, in the order of its fields.
struct Numbers {
    std::vector<Rational*> fractions;
    std::vector<int*> integers;

    explicit Numbers(Certificate& c) {
        integers = {&c.pattern.cells, &c.pattern.free_steps, &c.pattern.contact_steps, &c.gap_sign};
        for (auto* energy : {&c.energy_least, &c.energy_attained, &c.energy_bound}) {
            if (*energy) fractions.push_back(&**energy);
        }
        for (auto* vector : {&c.projection, &c.ray, &c.greatest}) add(*vector);
        for (auto* bounds : {&c.rest, &c.greatest_proof.chain_bounds}) {
            for (auto& bound : *bounds) {
                add(bound.form);
                add(bound.proof);
            }
        }
        for (int& column : c.greatest_proof.chain) integers.push_back(&column);
    }

private:
    void add(RationalVector& vector) {
        for (auto& [index, value] : vector) {
            integers.push_back(&index);
            fractions.push_back(&value);
        }
    }
    void add(RowCombination& combination) {
        add(combination.rows);
        fractions.push_back(&combination.contact);
    }
};

/// Calls `visit` with every certificate that differs from `original` in one place.
template <typename Visit>
void for_each_forgery(const Certificate& original, Visit visit) {
    Certificate counted = original;
    const Numbers places(counted);
    for (std::size_t i = 0; i < places.fractions.size(); ++i) {
        const Rational value = *places.fractions[i];
        for (const Rational& other :
             {Rational(value + 1), Rational(-value), Rational(0), Rational(2 * value), Rational(value / 2),
              Rational(value - Rational(1, 1'000'003)), Rational(value + Rational(1, 1'000'003))}) {
            if (other == value) continue;
            Certificate forged = original;
            *Numbers(forged).fractions[i] = other;
            visit(forged, "fraction " + std::to_string(i));
        }
    }
    for (std::size_t i = 0; i < places.integers.size(); ++i) {
        for (const int other : {*places.integers[i] + 1, *places.integers[i] - 1, -1, 1 << 30}) {
            Certificate forged = original;
            *Numbers(forged).integers[i] = other;
            visit(forged, "integer " + std::to_string(i));
        }
    }
    const auto edited = [&](const char* what, auto edit) {
        Certificate forged = original;
        edit(forged);
        visit(forged, what);
    };
    for (const Claim claim : {Claim::trivial, Claim::empty, Claim::nonempty}) {
        if (claim != original.claim) edited("claim", [&](Certificate& c) { c.claim = claim; });
    }
    for (const auto kind : {std::optional<nsma::PatternKind>(), std::optional(nsma::PatternKind::contact),
                            std::optional(nsma::PatternKind::free), std::optional(nsma::PatternKind::stuck)}) {
        if (kind != original.kind) edited("kind", [&](Certificate& c) { c.kind = kind; });
    }
    // Vectors lose, double and swap entries; lists too.
    const auto shuffle = [&](const char* what, auto list_of) {
        const std::size_t size = list_of(counted).size();
        for (std::size_t i = 0; i < size; ++i) {
            const auto at = static_cast<std::ptrdiff_t>(i);
            edited(what, [&](Certificate& c) { list_of(c).erase(list_of(c).begin() + at); });
            edited(what, [&](Certificate& c) {
                auto entry = list_of(c)[i];
                list_of(c).insert(list_of(c).begin() + at, std::move(entry));
            });
            if (i + 1 < size) edited(what, [&](Certificate& c) { std::swap(list_of(c)[i], list_of(c)[i + 1]); });
        }
        if (size > 0) edited(what, [&](Certificate& c) { list_of(c).clear(); });
    };
    shuffle(
        "projection", [](Certificate & c) -> auto& { return c.projection; });
    shuffle(
        "ray", [](Certificate & c) -> auto& { return c.ray; });
    shuffle(
        "greatest", [](Certificate & c) -> auto& { return c.greatest; });
    shuffle(
        "rest", [](Certificate & c) -> auto& { return c.rest; });
    shuffle(
        "chain", [](Certificate & c) -> auto& { return c.greatest_proof.chain; });
    shuffle(
        "chain bounds", [](Certificate & c) -> auto& { return c.greatest_proof.chain_bounds; });
    // Energies invented, forgotten and moved.
    const auto energy = [&](const char* what, auto energy_of) {
        edited(what, [&](Certificate& c) { energy_of(c) = Rational(7, 3); });
        edited(what, [&](Certificate& c) { energy_of(c).reset(); });
    };
    energy(
        "least energy", [](Certificate & c) -> auto& { return c.energy_least; });
    energy(
        "attained energy", [](Certificate & c) -> auto& { return c.energy_attained; });
    energy(
        "energy bound", [](Certificate & c) -> auto& { return c.energy_bound; });
}

TEST(Check, AcceptsNoForgery) {
    truth::Facts facts;
    long rejected = 0;
    long harmless = 0;
    const auto attack = [&](const Certificate& original) {
        for_each_forgery(original, [&](const Certificate& forged, const std::string& what) {
            const auto result = check(forged);
            if (!result.valid) {
                EXPECT_FALSE(result.reason.empty()) << what;
                EXPECT_EQ(result.reason.find('\n'), std::string::npos) << what;
                ++rejected;
                return;
            }
            ++harmless;
            EXPECT_EQ(facts.lie(forged), "") << what << " was accepted";
        });
    };
    for_each_problem(1, largest_mesh == 8 ? 4 : 2,
                     [&](const Pattern& pattern, int gap_sign) { attack(proof_of(pattern, gap_sign).certificate); });
    attack(proof_of({6, 16, 4}, 1).certificate);
    RecordProperty("rejected", static_cast<int>(rejected));
    RecordProperty("harmless", static_cast<int>(harmless));
    EXPECT_GT(rejected, 2 * harmless);
}

TEST(Check, EveryClaimedEnergyIsTied) {
    const auto original = proof_of({6, 16, 4}, 1).certificate;
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
    const auto original = proof_of({6, 16, 4}, 1).certificate;
    auto forged = original;
    ASSERT_FALSE(forged.projection.empty() && forged.greatest.empty());
    forged.projection = {{3, Rational(-1)}};
    EXPECT_EQ(check(forged).reason, "COND1 row 3: multiplier is negative");
    forged.projection = {{16, Rational(1)}};
    EXPECT_EQ(check(forged).reason, "rows: expected increasing steps in 1..15, got 16");

    // Points moved off the set: the step named is the first the literal scheme finds.
    int named = 0;
    for (const Pattern& pattern : {Pattern{6, 16, 4}, {6, 23, 1}, {5, 12, 3}, {8, 20, 7}}) {
        const auto certificate = proof_of(pattern, 1).certificate;
        if (certificate.claim != Claim::nonempty || certificate.greatest.empty()) continue;
        const auto problem = literal::problem(pattern, 1);
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
    const auto original = proof_of({6, 16, 4}, 1).certificate;
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
    for (const auto& certificate : {proof_of({1, 1, 2}, 1).certificate, proof_of({6, 16, 4}, -1).certificate}) {
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
