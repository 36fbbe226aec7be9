// No level gets a wrong verdict and none is lost: random patterns and levels against the exact interval.
// NSMA_LONG_TESTS=1 in the environment asks for 2000 levels instead of 60.
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <map>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "nsma/search/orbit_solver.hpp"
#include "nsma/search/pattern_problem.hpp"

namespace {

using nsma::exact;
using nsma::Pattern;
using nsma::pattern_problem;
using nsma::Verdict;

TEST(RandomLevels, NoWrongVerdictAndNoneLost) {
    const char* wanted = std::getenv("NSMA_LONG_TESTS");
    const bool longer = wanted != nullptr && std::string(wanted) == "1";
#ifdef __SANITIZE_ADDRESS__
    const int count = longer ? 2000 : 20;
#else
    const int count = longer ? 2000 : 60;
#endif
    constexpr int cells = 24;
    std::mt19937_64 random(20'160'307);
    const auto uniform = [&](double lo, double hi) {
        return lo + (hi - lo) * (static_cast<double>(random() >> 11) * 0x1p-53);
    };
    nsma::OrbitSolverOptions options;
    options.starts = 3;
    nsma::OrbitSolver solver(options);

    std::map<std::string, int> verdicts;
    int solved = 0;
    int global = 0;
    int contact_levels = 0;
    int bounded_gap = 0;
    double worst = 0;
    double widest = 0;
    const auto begin = std::chrono::steady_clock::now();
    for (int done = 0; done < count;) {
        // Every admissible pattern is as likely as any other; the others decide without a level.
        const int period = 2 + static_cast<int>(random() % (4 * cells - 1));
        const int contact = 1 + static_cast<int>(random() % static_cast<unsigned>(period - 1));
        const int gap_sign = random() % 2 == 0 ? 1 : -1;
        const Pattern pattern{cells, period - contact, contact};
        const double where = uniform(0, 1);
        const double share = uniform(0, 1);
        if (nsma::kernel_dimension(pattern) == 0) continue;
        const auto problem = pattern_problem(pattern, gap_sign);
        SCOPED_TRACE(testing::Message() << "(" << pattern.free_steps << ", " << contact << ") gap " << gap_sign);
        EXPECT_TRUE(problem.proof.verdict_proved) << problem.proof.unproved;
        nsma::Bar bar;
        bar.gap = gap_sign;
        if (problem.verdict != Verdict::admissible) {
            // One in eight inadmissible patterns is asked too: most patterns are.
            if (share > 0.125) continue;
            const auto answer = solver.solve(bar, problem, {.level = 1.0, .reference = {}});
            EXPECT_EQ(answer.verdict, Verdict::inadmissible);
            EXPECT_TRUE(answer.verdict_proved);
            ++verdicts["inadmissible"];
            ++done;
            continue;
        }
        const auto& certificate = problem.proof.certificate;
        ASSERT_TRUE(certificate.energy_least);
        const bool bounded = certificate.ray.empty();
        ASSERT_TRUE(!bounded || certificate.energy_attained);
        const double low = nsma::to_double(*certificate.energy_least);
        const double high = bounded ? nsma::to_double(*certificate.energy_attained) : 50 * low;
        // A fifth below, three fifths inside, a fifth above.
        double level = low * std::pow(high / low, share);
        if (where < 0.2) level = low * (1 - std::pow(10.0, -12 * share));
        if (where > 0.8) level = high * (1 + std::pow(10.0, -12 * share));
        if (!(level > 0)) continue;
        const auto answer = solver.solve(bar, problem, {.level = level, .reference = {}});
        ++done;
        ++verdicts[std::string(nsma::name(answer.verdict))];
        // The truth, in fractions: a level within one rounding of an end is at the end.
        const nsma::Rational rounding(1, nsma::Integer("1000000000000000"));
        const nsma::Rational ratio_low = exact(level) / *certificate.energy_least - 1;
        const bool below = ratio_low < -rounding;
        const bool above = bounded && exact(level) / *certificate.energy_bound - 1 > rounding;
        const bool open = bounded && !above && exact(level) / *certificate.energy_attained - 1 > rounding;
        EXPECT_FALSE(open) << "the greatest energy is not exact";
        const Verdict expected = below ? Verdict::below : above ? Verdict::above : Verdict::admissible;
        EXPECT_EQ(answer.verdict, expected)
            << "level " << level << " of [" << low << ", " << high << "]: " << answer.reason;
        EXPECT_TRUE(answer.verdict_proved);
        if (expected != Verdict::admissible || answer.verdict != Verdict::admissible) continue;
        ++solved;
        ASSERT_TRUE(answer.orbit && answer.optimality);
        const auto judged = nsma::replay(*answer.orbit, answer.level);
        EXPECT_TRUE(judged.accepted);
        EXPECT_LE(judged.violations.worst(), 1e-9);  // the acceptance of the project
        worst = std::max(worst, judged.violations.worst());
        if (problem.kind == nsma::PatternKind::contact) {
            EXPECT_TRUE(answer.optimality->global);
            ++contact_levels;
        }
        if (answer.optimality->global) {
            ++global;
        } else if (answer.optimality->lower_bound) {
            ++bounded_gap;
            widest = std::max(widest, answer.optimality->gap);
        }
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    for (const auto& [verdict, number] : verdicts) RecordProperty(verdict, number);
    RecordProperty("solved", solved);
    RecordProperty("global", global);
    RecordProperty("with_a_gap", bounded_gap);
    RecordProperty("widest_gap", std::to_string(widest));
    RecordProperty("worst_violation", testing::PrintToString(worst));
    RecordProperty("seconds", std::to_string(seconds));
    RecordProperty("contact", contact_levels);
    EXPECT_GT(solved, count / 4);
    EXPECT_GT(contact_levels, solved / 4);
}

}  // namespace
