// Every certificate that differs from a true one in one place is refused, or says only what is true.
#include <string>

#include <gtest/gtest.h>

#include "truth.hpp"

namespace {

using nsma::Certificate;
using nsma::check;
using nsma::Pattern;
using nsma::Rational;
using nsma::RationalVector;
using truth::for_each_problem;
using truth::largest_mesh;
using truth::proof_of;
using Claim = Certificate::Claim;

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
        for (int& column : c.chain) integers.push_back(&column);
        if (c.forcing_row) integers.push_back(&*c.forcing_row);
    }

private:
    void add(RationalVector& vector) {
        for (auto& [index, value] : vector) {
            integers.push_back(&index);
            fractions.push_back(&value);
        }
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
        "chain", [](Certificate & c) -> auto& { return c.chain; });
    edited("forcing row", [](Certificate& c) { c.forcing_row = 1; });
    edited("forcing row", [](Certificate& c) { c.forcing_row.reset(); });
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

}  // namespace
