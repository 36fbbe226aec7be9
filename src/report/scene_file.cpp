#include "nsma/report/scene_file.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <span>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "one_line.hpp"

namespace nsma {
namespace {

constexpr std::size_t max_scene_bytes = 16u << 20;
constexpr long max_levels = 1'000'000;
constexpr const char* positive_number = "a finite number > 0";

using Names = std::span<const std::string_view>;

/// What stands in the file instead of what was expected.
std::string describe(const toml::node& node) {
    if (const auto* text = node.as_string()) {
        const std::string& value = text->get();
        return value.size() > 60 ? fmt::format("\"{}...\"", value.substr(0, 60)) : fmt::format("\"{}\"", value);
    }
    if (const auto* number = node.as_integer()) return fmt::format("{}", number->get());
    if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
    if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
    if (const auto* list = node.as_array()) return fmt::format("a list of {} values", list->size());
    if (node.is_table()) return "a table";
    return "a date or time";
}

/// Walks one scene; every failure leaves as one InputError.
class Reader {
public:
    explicit Reader(const std::string& where) : where_(where) {}

    [[noreturn]] void fail(const toml::node& node, const std::string& key, std::string_view expected,
                           std::string_view got) const {
        const auto line = node.source().begin.line;
        throw InputError(
            one_line(line == 0 ? fmt::format("{}: {}: expected {}, got {}", where_, key, expected, got)
                               : fmt::format("{}:{}: {}: expected {}, got {}", where_, line, key, expected, got)));
    }
    [[noreturn]] void fail(const toml::node& node, const std::string& key, std::string_view expected) const {
        fail(node, key, expected, describe(node));
    }

    /// Refuses every key of `table` that is not in `known`.
    void only(const toml::table& table, const std::string& path, Names known) const {
        for (const auto& [key, node] : table) {
            if (std::find(known.begin(), known.end(), key.str()) == known.end()) {
                fail(node, path.empty() ? std::string(key.str()) : path + "." + std::string(key.str()),
                     fmt::format("one of {}", fmt::join(known, ", ")), "an unknown key");
            }
        }
    }

    [[nodiscard]] const toml::node& need(const toml::table& table, const std::string& path, std::string_view key,
                                         std::string_view expected) const {
        if (const toml::node* node = table.get(key)) return *node;
        fail(table, path.empty() ? std::string(key) : fmt::format("{}.{}", path, key), expected,
             "nothing: the key is missing");
    }

    [[nodiscard]] const toml::table& table(const toml::table& root, std::string_view key) const {
        const toml::node& node = need(root, "", key, fmt::format("a table [{}]", key));
        if (const toml::table* found = node.as_table()) return *found;
        fail(node, std::string(key), fmt::format("a table [{}]", key));
    }

    [[nodiscard]] double number(const toml::node& node, const std::string& key, std::string_view expected,
                                double greater_than) const {
        double value = std::nan("");
        if (const auto* real = node.as_floating_point()) value = real->get();
        if (const auto* whole = node.as_integer()) value = static_cast<double>(whole->get());
        if (!std::isfinite(value) || !(value > greater_than)) fail(node, key, expected);
        return value;
    }
    [[nodiscard]] double positive(const toml::table& table, const std::string& path, std::string_view key) const {
        return number(need(table, path, key, positive_number), fmt::format("{}.{}", path, key), positive_number, 0.0);
    }

    [[nodiscard]] long integer(const toml::node& node, const std::string& key, long lo, long hi) const {
        const auto* whole = node.as_integer();
        if (whole == nullptr || whole->get() < lo || whole->get() > hi) {
            fail(node, key, fmt::format("an integer from {} to {}", lo, hi));
        }
        return static_cast<long>(whole->get());
    }
    [[nodiscard]] long integer(const toml::table& table, const std::string& path, std::string_view key, long lo,
                               long hi) const {
        const auto& node = need(table, path, key, fmt::format("an integer from {} to {}", lo, hi));
        return integer(node, fmt::format("{}.{}", path, key), lo, hi);
    }

    [[nodiscard]] std::string text(const toml::table& table, const std::string& path, std::string_view key,
                                   std::string_view expected) const {
        const auto& node = need(table, path, key, expected);
        const auto* found = node.as_string();
        const std::string name = path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
        if (found == nullptr || found->get().empty() || one_line(found->get()) != found->get()) {
            fail(node, name, expected);
        }
        return found->get();
    }

    [[nodiscard]] std::array<double, 2> range(const toml::node& node, const std::string& key) const {
        constexpr const char* expected = "[lo, hi] with 0 <= lo <= hi and hi > 0, in units of tau";
        const auto* list = node.as_array();
        if (list == nullptr || list->size() != 2) fail(node, key, expected);
        const auto* lowest = std::as_const(*list).get(0);
        const double lo = number(*lowest, key, expected, -1e-300);
        const double hi = number(*std::as_const(*list).get(1), key, expected, 0.0);
        if (lo > hi) fail(node, key, expected, fmt::format("[{}, {}]", lo, hi));
        return {lo, hi};
    }

private:
    std::string where_;
};

Bar read_bar(const Reader& reader, const toml::table& root) {
    static constexpr std::array<std::string_view, 5> known{"length", "young_modulus", "density", "area", "gap"};
    const toml::table& table = reader.table(root, "bar");
    reader.only(table, "bar", known);
    Bar bar;
    bar.length = reader.positive(table, "bar", "length");
    bar.young_modulus = reader.positive(table, "bar", "young_modulus");
    bar.density = reader.positive(table, "bar", "density");
    bar.area = reader.positive(table, "bar", "area");
    bar.gap = reader.number(reader.need(table, "bar", "gap", "a finite number"), "bar.gap", "a finite number",
                            -std::numeric_limits<double>::infinity());
    try {
        validate(bar);
    } catch (const std::invalid_argument& error) {
        reader.fail(table, "bar", "derived quantities that are finite and > 0", error.what());
    }
    return bar;
}

PatternSelection read_patterns(const Reader& reader, const toml::table& root, int cells) {
    static constexpr std::array<std::string_view, 5> known{"mode", "period", "contact", "list", "kinds"};
    constexpr const char* one_of = "exactly one of mode, period, list";
    const toml::table& table = reader.table(root, "patterns");
    reader.only(table, "patterns", known);
    const toml::node* mode = table.get("mode");
    const toml::node* period = table.get("period");
    const toml::node* list = table.get("list");
    const int count = (mode != nullptr) + (period != nullptr) + (list != nullptr);
    if (count != 1) reader.fail(table, "patterns", one_of, count == 0 ? "none" : fmt::format("{} of them", count));
    const toml::node* contact = table.get("contact");
    if (contact != nullptr && period == nullptr) {
        reader.fail(*contact, "patterns.contact", "it beside patterns.period only", "it without");
    }
    if (mode != nullptr) {
        return ModeSelection{static_cast<int>(reader.integer(*mode, "patterns.mode", 1, max_cells))};
    }
    if (period != nullptr) {
        PeriodSelection selection{reader.range(*period, "patterns.period"), std::nullopt};
        if (contact != nullptr) selection.contact = reader.range(*contact, "patterns.contact");
        if (selection.period[1] * cells > max_period_steps) {
            reader.fail(*period, "patterns.period", fmt::format("at most {} time steps", max_period_steps),
                        fmt::format("{} x {} cells", selection.period[1], cells));
        }
        return selection;
    }
    constexpr const char* rows = "rows [free steps, contact steps] of two positive integers";
    ListSelection selection;
    const auto* array = list->as_array();
    if (array == nullptr || array->empty()) reader.fail(*list, "patterns.list", rows);
    for (const toml::node& row : *array) {
        const auto* pair = row.as_array();
        if (pair == nullptr || pair->size() != 2) reader.fail(row, "patterns.list", rows);
        std::array<long, 2> steps{};
        for (std::size_t i = 0; i < 2; ++i) {
            const toml::node& entry = *pair->get(i);
            const auto* whole = entry.as_integer();
            if (whole == nullptr || whole->get() < 1) reader.fail(entry, "patterns.list", rows);
            steps[i] = reader.integer(entry, "patterns.list", 1, max_period_steps);
        }
        if (steps[0] + steps[1] > max_period_steps) {
            reader.fail(row, "patterns.list", fmt::format("at most {} time steps", max_period_steps),
                        fmt::format("{} + {}", steps[0], steps[1]));
        }
        selection.steps.emplace_back(static_cast<int>(steps[0]), static_cast<int>(steps[1]));
    }
    return selection;
}

/// Whether free and stuck patterns are to be solved too: kinds = "all"; without the key contact motions only.
bool read_all_kinds(const Reader& reader, const toml::table& root) {
    constexpr const char* words = "\"contact\" or \"all\"";
    const toml::table& table = reader.table(root, "patterns");
    if (!table.contains("kinds")) return false;
    const std::string text = reader.text(table, "patterns", "kinds", words);
    if (text != "contact" && text != "all") reader.fail(*table.get("kinds"), "patterns.kinds", words);
    return text == "all";
}

std::vector<double> spaced(double from, double to, long count, bool logarithmic) {
    std::vector<double> levels;
    for (long i = 0; i < count; ++i) {
        const double part = count == 1 ? 0.0 : static_cast<double>(i) / static_cast<double>(count - 1);
        levels.push_back(logarithmic ? from * std::pow(to / from, part) : from + (to - from) * part);
    }
    levels.front() = from;
    levels.back() = to;
    return levels;
}

std::vector<double> read_levels(const Reader& reader, const toml::table& root) {
    static constexpr std::array<std::string_view, 5> known{"list", "from", "to", "count", "spacing"};
    const toml::table& table = reader.table(root, "levels");
    reader.only(table, "levels", known);
    if (const toml::node* list = table.get("list")) {
        if (table.size() != 1) reader.fail(table, "levels", "either list or from, to, count, spacing", "both");
        const auto* array = list->as_array();
        if (array == nullptr || array->empty()) reader.fail(*list, "levels.list", "a list of finite numbers > 0");
        std::vector<double> levels;
        for (const toml::node& entry : *array) {
            levels.push_back(reader.number(entry, "levels.list", positive_number, 0.0));
        }
        return levels;
    }
    if (table.empty()) reader.fail(table, "levels", "either list or from, to, count, spacing", "neither");
    const double from = reader.positive(table, "levels", "from");
    const double to = reader.positive(table, "levels", "to");
    const long count = reader.integer(table, "levels", "count", 1, max_levels);
    const std::string spacing = reader.text(table, "levels", "spacing", "\"log\" or \"linear\"");
    if (spacing != "log" && spacing != "linear") {
        reader.fail(*table.get("spacing"), "levels.spacing", "\"log\" or \"linear\"");
    }
    if (from > to) {
        reader.fail(*table.get("to"), "levels.to", fmt::format("a number >= levels.from = {}", from));
    }
    if (from == to && count != 1) reader.fail(*table.get("count"), "levels.count", "1, since from = to");
    if (from != to && count == 1) reader.fail(*table.get("count"), "levels.count", "at least 2, since from < to");
    return spaced(from, to, count, spacing == "log");
}

Objective read_objective(const Reader& reader, const toml::table& root) {
    static constexpr std::array<std::string_view, 1> known{"objective"};
    constexpr const char* names = "\"least-shock\", \"nearest\", \"least-force\", \"min-energy\" or \"max-energy\"";
    const toml::table& table = reader.table(root, "program");
    reader.only(table, "program", known);
    const std::string text = reader.text(table, "program", "objective", names);
    const std::optional<Objective> objective = objective_named(text);
    if (!objective) reader.fail(*table.get("objective"), "program.objective", names);
    return *objective;
}

}  // namespace

Scene parse_scene(std::string_view text, const std::string& where) {
    static constexpr std::array<std::string_view, 6> known{"title", "bar", "mesh", "patterns", "levels", "program"};
    static constexpr std::array<std::string_view, 1> mesh_keys{"cells"};
    if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) {
        throw InputError(one_line(fmt::format("{}: expected a scene, got an empty file", where)));
    }
    toml::table root;
    try {
        root = toml::parse(text, std::string_view(where));
    } catch (const toml::parse_error& error) {
        throw InputError(one_line(fmt::format("{}:{}: expected TOML, got a syntax error: {}", where,
                                              error.source().begin.line, error.description())));
    }
    const Reader reader(where);
    reader.only(root, "", known);
    Scene scene;
    scene.title = reader.text(root, "", "title", "one line of text");
    scene.bar = read_bar(reader, root);
    const toml::table& mesh = reader.table(root, "mesh");
    reader.only(mesh, "mesh", mesh_keys);
    scene.mesh.cells = static_cast<int>(reader.integer(mesh, "mesh", "cells", 1, max_cells));
    scene.patterns = read_patterns(reader, root, scene.mesh.cells);
    scene.all_kinds = read_all_kinds(reader, root);
    scene.levels = read_levels(reader, root);
    scene.objective = read_objective(reader, root);
    scene.text = text;
    return scene;
}

Scene read_scene(const std::filesystem::path& file) {
    const std::string where = file.string();
    std::error_code code;
    if (std::filesystem::is_directory(file, code)) {
        throw InputError(one_line(fmt::format("{}: expected a scene file, got a directory", where)));
    }
    errno = 0;
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw InputError(one_line(fmt::format("{}: cannot be read: {}", where, std::strerror(errno))));
    std::string text(max_scene_bytes + 1, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (stream.bad()) throw InputError(one_line(fmt::format("{}: cannot be read: {}", where, std::strerror(errno))));
    text.resize(static_cast<std::size_t>(stream.gcount()));
    if (text.size() > max_scene_bytes) {
        throw InputError(one_line(fmt::format("{}: expected at most {} bytes, got more", where, max_scene_bytes)));
    }
    return parse_scene(text, where);
}

}  // namespace nsma
