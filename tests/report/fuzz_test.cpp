// 100 000 mutated certificates and scenes, with fixed seeds: no crash, no hang, no accepted forgery,
// one line for whatever is refused.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "../proof/truth.hpp"

#include "nsma/report/scene_file.hpp"
#include "report/certificate_file.hpp"

namespace {

using nsma::InputError;

constexpr int certificate_inputs = 60'000;
constexpr int scene_inputs = 40'000;

class Mutator {
public:
    explicit Mutator(unsigned seed) : random_(seed) {}

    [[nodiscard]] std::size_t below(std::size_t count) { return count == 0 ? 0 : random_() % count; }

    [[nodiscard]] std::string operator()(std::string text, const std::vector<std::string>& others) {
        // One place usually, a few sometimes.
        const std::size_t rounds = below(4) == 0 ? 1 + below(4) : 1;
        for (std::size_t i = 0; i < rounds; ++i) once(text, others);
        return text;
    }

private:
    void once(std::string& text, const std::vector<std::string>& others) {
        if (text.empty()) return;
        const std::size_t at = below(text.size());
        const std::size_t length = std::min(1 + below(12), text.size() - at);
        switch (below(10)) {
            case 0: text[at] = static_cast<char>(text[at] ^ (1 << below(8))); return;
            case 1: text[at] = "0123456789-/.,:\"[]{}=#\\ \n\t\0e"[below(29)]; return;
            case 2: text.erase(at, length); return;
            case 3: text.insert(at, text.substr(below(text.size()), length)); return;
            case 4: text.resize(at); return;
            case 5: {  // a piece of another input
                const auto& other = others[below(others.size())];
                const std::size_t from = below(other.size());
                text.replace(at, length, other.substr(from, 1 + below(40)));
                return;
            }
            case 6: {  // two values change places
                const auto a = number(text, at);
                const auto b = number(text, below(text.size()));
                if (a.first + a.second > b.first) return;
                const std::string low = text.substr(a.first, a.second);
                const std::string high = text.substr(b.first, b.second);
                text.replace(b.first, b.second, low);
                text.replace(a.first, a.second, high);
                return;
            }
            case 7: {  // depth: brackets in brackets, keys of many parts
                static const std::vector<std::string> parts{"[", "{", "]", "a.", "[[", "{a=", ".", "{\"a\":["};
                const std::string& part = parts[below(parts.size())];
                std::string deep;
                for (std::size_t k = std::size_t{1} << below(14); k > 0; --k) deep += part;
                text.insert(at, deep);
                return;
            }
            default: {  // numbers: the mutation that keeps the syntax
                const auto [from, size] = number(text, at);
                if (size == 0) return;
                static const std::vector<std::string> numbers{"0",
                                                              "1",
                                                              "-1",
                                                              "2",
                                                              "3",
                                                              "-2",
                                                              "7",
                                                              "12",
                                                              "1/2",
                                                              "-1/3",
                                                              "4294967296",
                                                              "2147483647",
                                                              "-2147483648",
                                                              "1000000",
                                                              "2000000",
                                                              "1e400",
                                                              "nan",
                                                              "inf",
                                                              "99999999999999999999999999",
                                                              "0.5",
                                                              "1e-400",
                                                              "01"};
                if (below(2) == 0) {
                    text.replace(from, size, numbers[below(numbers.size())]);
                } else {
                    const std::size_t digit = from + below(size);
                    text[digit] = static_cast<char>('0' + below(10));
                }
                return;
            }
        }
    }

    /// (from, size) of the first run of digits at or after `at`; size 0: none.
    static std::pair<std::size_t, std::size_t> number(const std::string& text, std::size_t at) {
        const auto from = text.find_first_of("0123456789", at);
        if (from == std::string::npos) return {0, 0};
        const auto end = std::min(text.find_first_not_of("0123456789", from), text.size());
        return {from, end - from};
    }

    std::mt19937 random_;
};

void expect_one_line(const std::string& message) {
    EXPECT_FALSE(message.empty());
    EXPECT_EQ(message.rfind("input", 0), 0U) << message;
    for (const char c : message) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
            ADD_FAILURE() << "control character in " << testing::PrintToString(message);
            return;
        }
    }
}

TEST(Fuzz, NoForgedCertificateIsAccepted) {
    std::vector<std::string> lines;
    for (int cells = 1; cells <= 3; ++cells) {
        for (const auto& pattern : truth::patterns(cells)) {
            for (const int gap_sign : {-1, 0, 1}) {
                lines.push_back(nsma::certificate_json(truth::proof_of(pattern, gap_sign).certificate));
            }
        }
    }
    for (const auto& pattern : {nsma::Pattern{6, 16, 4}, {5, 14, 3}}) {
        lines.push_back(nsma::certificate_json(truth::proof_of(pattern, 1).certificate));
    }
    for (const auto& line : lines) {
        ASSERT_TRUE(nsma::check(nsma::parse_certificate(line, "input")).valid) << line;
    }
    Mutator mutate(1);
    truth::Facts facts;
    int refused = 0;
    int rejected = 0;
    int accepted = 0;
    int not_judged = 0;
    for (int i = 0; i < certificate_inputs; ++i) {
        const std::string text = mutate(lines[mutate.below(lines.size())], lines);
        nsma::Certificate said;
        try {
            said = nsma::parse_certificate(text, "input");
        } catch (const InputError& error) {
            expect_one_line(error.what());
            ++refused;
            continue;
        }
        const auto result = nsma::check(said);
        if (!result.valid) {
            EXPECT_FALSE(result.reason.empty());
            EXPECT_EQ(result.reason.find('\n'), std::string::npos);
            ++rejected;
            continue;
        }
        ++accepted;
        // The truth about a huge mesh is out of reach of dense tables, unless it is trivial.
        if (said.claim != nsma::Certificate::Claim::trivial &&
            (said.pattern.cells > 200 || said.pattern.period_steps() > 200)) {
            ++not_judged;
            continue;
        }
        EXPECT_EQ(facts.lie(said), "") << "accepted: " << text;
        // What was read is what is written.
        const auto again = nsma::parse_certificate(nsma::certificate_json(said), "input");
        EXPECT_EQ(nsma::certificate_json(again), nsma::certificate_json(said));
        if (HasFailure()) return;
    }
    RecordProperty("refused", refused);
    RecordProperty("rejected", rejected);
    RecordProperty("accepted", accepted);
    RecordProperty("not_judged", not_judged);
    EXPECT_GT(refused, certificate_inputs / 10);
    EXPECT_GT(rejected, certificate_inputs / 20);  // mutations must get past the reader
    EXPECT_LT(not_judged, certificate_inputs / 100);
}

TEST(Fuzz, ABadSceneIsOneLine) {
    std::vector<std::string> scenes;
    for (const auto& entry : std::filesystem::directory_iterator(NSMA_PROBLEMS)) {
        if (entry.path().extension() != ".toml") continue;
        std::ifstream stream(entry.path(), std::ios::binary);
        std::ostringstream text;
        text << stream.rdbuf();
        scenes.push_back(text.str());
    }
    std::sort(scenes.begin(), scenes.end());  // folders have no order
    ASSERT_GE(scenes.size(), 5U);
    for (const auto& scene : scenes) EXPECT_NO_THROW((void)nsma::parse_scene(scene, "input"));
    Mutator mutate(2);
    int refused = 0;
    int accepted = 0;
    for (int i = 0; i < scene_inputs; ++i) {
        const std::string text = mutate(scenes[mutate.below(scenes.size())], scenes);
        try {
            const nsma::Scene scene = nsma::parse_scene(text, "input");
            ++accepted;
            // Whatever is accepted can be used.
            EXPECT_NO_THROW(nsma::validate(scene.bar));
            EXPECT_NO_THROW(nsma::validate(scene.mesh));
            EXPECT_FALSE(scene.title.empty());
            EXPECT_FALSE(scene.levels.empty());
            for (const double level : scene.levels) {
                if (std::isfinite(level) && level > 0) continue;
                ADD_FAILURE() << "level " << level << " from:\n" << text;
                break;
            }
        } catch (const InputError& error) {
            expect_one_line(error.what());
            ++refused;
        }
        if (HasFailure()) {
            ADD_FAILURE() << "input " << i << ":\n" << text;
            return;
        }
    }
    RecordProperty("refused", refused);
    RecordProperty("accepted", accepted);
    EXPECT_GT(refused, scene_inputs / 5);
    EXPECT_GT(accepted, scene_inputs / 20);  // comments and digits may change freely
}

}  // namespace
