#include "nsma/report/scene_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "did_you_mean.hpp"
#include "input_file.hpp"
#include "nesting.hpp"
#include "one_line.hpp"
#include "results_folder.hpp"

namespace nsma {
namespace {

constexpr long max_levels = 1'000'000;
constexpr long max_frequencies = 100'000;
constexpr long max_force_periods = 10'000'000;
constexpr double max_recorded_steps = 1e8;
constexpr double max_kept_numbers = 1e8;
constexpr double least_frequency = 1e-3;  // of omega_1
constexpr double greatest_frequency = 1e3;
constexpr int deepest = 16;  // brackets, or parts of a key; those of a scene go two deep
constexpr const char* positive_number = "a finite number > 0";

using Keys = std::vector<std::string_view>;

struct SceneText {
    std::string where;                    ///< the file, in messages
    std::vector<std::string_view> lines;  ///< as written
};

/// A value of the file, or the place where it is missing; every failure leaves as one InputError.
class SceneValue {
public:
    SceneValue(const SceneText& text, std::string key, const toml::node& node)
        : text_(&text), key_(std::move(key)), node_(&node) {}

    [[noreturn]] void fail(std::string_view expected, std::string_view got) const {
        const auto line = node_->source().begin.line;
        const std::string& file = text_->where;
        const std::string place = line == 0 ? file : fmt::format("{}:{}", file, line);
        throw InputError(one_line(fmt::format("{}: {}: expected {}, got {}", place, shortened(key_), expected, got)));
    }
    [[noreturn]] void fail(std::string_view expected) const { fail(expected, description()); }

    [[nodiscard]] bool missing() const { return missing_; }
    [[nodiscard]] std::size_t size() const { return node_->as_table()->size(); }  ///< of a table

    /// A value of this table.
    [[nodiscard]] SceneValue operator[](std::string_view key) const {
        const toml::node* node = node_->as_table()->get(key);
        SceneValue value(*text_, key_.empty() ? std::string(key) : fmt::format("{}.{}", key_, key),
                         node != nullptr ? *node : *node_);
        value.missing_ = node == nullptr;
        return value;
    }
    /// A table of this table, [key].
    [[nodiscard]] SceneValue section(std::string_view key, const Keys& known) const {
        SceneValue value = (*this)[key];
        if (value.missing_ || !value.node_->is_table()) value.fail(fmt::format("a table [{}]", key));
        value.refuse_all_but(known);
        return value;
    }
    void refuse_all_but(const Keys& known) const {
        for (const auto& [key, node] : *node_->as_table()) {
            if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
            (*this)[key.str()].fail(fmt::format("one of {}", fmt::join(known, ", ")),
                                    "an unknown key" + did_you_mean(key.str(), known));
        }
    }

    [[nodiscard]] double number(std::string_view expected, double greater_than) const {
        double value = std::nan("");
        if (const auto* real = node_->as_floating_point()) value = real->get();
        if (const auto* whole = node_->as_integer()) value = static_cast<double>(whole->get());
        if (value == 0 && !is_written_zero()) fail(expected, "one that is too small for a number");
        if (!std::isfinite(value) || !(value > greater_than)) fail(expected);
        return value;
    }
    [[nodiscard]] double positive() const { return number(positive_number, 0.0); }
    /// A number > 0 within these bounds.
    [[nodiscard]] double within(double lo, double hi) const {
        const double value = positive();
        if (value < lo || value > hi) fail(fmt::format("a number from {:g} to {:g}", lo, hi));
        return value;
    }

    [[nodiscard]] long integer(long lo, long hi) const {
        return integer(lo, hi, fmt::format("an integer from {} to {}", lo, hi));
    }
    [[nodiscard]] long integer(long lo, long hi, std::string_view expected) const {
        const auto* whole = node_->as_integer();
        if (whole == nullptr || whole->get() < lo || whole->get() > hi) fail(expected);
        return whole->get();
    }

    /// One line, not empty.
    [[nodiscard]] std::string text(std::string_view expected) const {
        const auto* found = node_->as_string();
        if (found == nullptr || found->get().empty() || one_line(found->get()) != found->get()) fail(expected);
        return found->get();
    }
    /// Whether it is the second of two words.
    [[nodiscard]] bool is_second(std::string_view first, std::string_view second) const {
        const std::string expected = fmt::format("\"{}\" or \"{}\"", first, second);
        const std::string word = text(expected);
        if (word != first && word != second) fail(expected);
        return word == second;
    }

    /// The entries of a list that is not empty, or has `size` of them.
    [[nodiscard]] std::vector<SceneValue> list(std::string_view expected, std::size_t size = 0) const {
        const auto* array = node_->as_array();
        if (array == nullptr || array->empty() || (size > 0 && array->size() != size)) fail(expected);
        std::vector<SceneValue> entries;
        for (const toml::node& entry : *array) entries.emplace_back(*text_, key_, entry);
        return entries;
    }
    [[nodiscard]] std::array<double, 2> range() const {
        constexpr const char* expected = "[lo, hi] with 0 <= lo <= hi and hi > 0, in units of tau";
        const auto bounds = list(expected, 2);
        const double lo = bounds[0].number(expected, -1e-300);
        const double hi = bounds[1].number(expected, 0.0);
        if (lo > hi) fail(expected, fmt::format("[{}, {}]", lo, hi));
        return {lo, hi};
    }

private:
    // The library reads 1e-400 as zero; no digit but 0 stands before the exponent of a zero.
    [[nodiscard]] bool is_written_zero() const {
        const toml::source_region& source = node_->source();
        if (source.begin.line == 0 || source.begin.line > text_->lines.size()) return true;
        const std::string_view line = text_->lines[source.begin.line - 1];
        const std::string_view from = line.substr(std::min<std::size_t>(source.begin.column - 1, line.size()));
        const std::size_t end = std::min(from.find_first_not_of("+-_.0123456789"), from.size());
        return from.substr(0, end).find_first_of("123456789") == std::string_view::npos;
    }
    [[nodiscard]] std::string description() const {
        if (missing_) return "nothing: the key is missing";
        if (const auto* text = node_->as_string()) return fmt::format("\"{}\"", shortened(text->get()));
        if (const auto* number = node_->as_integer()) return fmt::format("{}", number->get());
        if (const auto* number = node_->as_floating_point()) return fmt::format("{}", number->get());
        if (const auto* flag = node_->as_boolean()) return flag->get() ? "true" : "false";
        if (const auto* list = node_->as_array()) return fmt::format("a list of {} values", list->size());
        if (node_->is_table()) return "a table";
        return "a date or time";
    }

    const SceneText* text_;
    std::string key_;  ///< with its table, "bar.gap"
    const toml::node* node_;
    bool missing_ = false;  ///< then the node is the table without it
};

Bar read_bar(const SceneValue& root) {
    const SceneValue section = root.section("bar", {"length", "young_modulus", "density", "area", "gap"});
    Bar bar;
    for (const BarQuantity& quantity : bar_quantities)
        bar.*quantity.value = section[quantity.name].within(quantity.least, quantity.greatest);
    const SceneValue gap = section["gap"];
    bar.gap = gap.number("a finite number", -std::numeric_limits<double>::infinity());
    try {
        validate(bar);
    } catch (const std::invalid_argument&) {
        gap.fail(gap_expected());
    }
    return bar;
}

PeriodSelection read_period(const SceneValue& period, const SceneValue& contact, int cells) {
    PeriodSelection selection{period.range(), std::nullopt};
    if (!contact.missing()) selection.contact = contact.range();
    if (selection.period[1] * cells > max_period_steps) {
        period.fail(fmt::format("at most {} time steps", max_period_steps),
                    fmt::format("{} x {} cells", selection.period[1], cells));
    }
    return selection;
}

ListSelection read_list(const SceneValue& list) {
    constexpr const char* rows = "rows [free steps, contact steps] of two positive integers";
    ListSelection selection;
    for (const SceneValue& row : list.list(rows)) {
        std::vector<long> steps;
        for (const SceneValue& entry : row.list(rows, 2)) {
            (void)entry.integer(1, std::numeric_limits<long>::max(), rows);
            steps.push_back(entry.integer(1, max_period_steps));
        }
        if (steps[0] + steps[1] > max_period_steps) {
            row.fail(fmt::format("at most {} time steps", max_period_steps),
                     fmt::format("{} + {}", steps[0], steps[1]));
        }
        selection.steps.emplace_back(static_cast<int>(steps[0]), static_cast<int>(steps[1]));
    }
    return selection;
}

PatternSelection read_patterns(const SceneValue& section, int cells) {
    const SceneValue mode = section["mode"];
    const SceneValue period = section["period"];
    const SceneValue list = section["list"];
    const SceneValue contact = section["contact"];
    const int count = !mode.missing() + !period.missing() + !list.missing();
    if (count != 1) {
        section.fail("exactly one of mode, period, list", count == 0 ? "none" : fmt::format("{} of them", count));
    }
    if (!contact.missing() && period.missing()) contact.fail("it beside patterns.period only", "it without");
    if (!mode.missing()) return ModeSelection{static_cast<int>(mode.integer(1, max_cells))};
    if (!period.missing()) return read_period(period, contact, cells);
    return read_list(list);
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

std::vector<double> read_level_numbers(const SceneValue& section) {
    constexpr const char* either = "either list or from, to, count, spacing";
    const std::size_t keys = section.size() - (section["unit"].missing() ? 0 : 1);
    if (keys == 0) section.fail(either, "neither");
    if (const SceneValue list = section["list"]; !list.missing()) {
        if (keys != 1) section.fail(either, "both");
        std::vector<double> levels;
        for (const SceneValue& entry : list.list("a list of finite numbers > 0"))
            levels.push_back(entry.within(least_level, greatest_level));
        return levels;
    }
    const double from = section["from"].within(least_level, greatest_level);
    const double to = section["to"].within(least_level, greatest_level);
    const SceneValue count_value = section["count"];
    const long count = count_value.integer(1, max_levels);
    const bool linear = section["spacing"].is_second("log", "linear");
    if (from > to) section["to"].fail(fmt::format("a number >= levels.from = {}", from));
    if (from == to && count != 1) count_value.fail("1, since from = to");
    if (from != to && count == 1) count_value.fail("at least 2, since from < to");
    return spaced(from, to, count, !linear);
}

void read_levels(const SceneValue& section, Scene& scene) {
    scene.levels = read_level_numbers(section);
    const SceneValue unit = section["unit"];
    const bool closed = scene.bar.gap_sign() == 0;
    const bool in_joules = unit.missing() ? closed : unit.is_second("E_g", "J");
    if (closed && !in_joules) unit.fail("\"J\", as a closed gap has no E_g");
    if (closed || !in_joules) return;
    for (double& level : scene.levels) {
        const double joules = level;
        level /= scene.bar.energy_unit();
        if (level < least_level || level > greatest_level) {
            section.fail(fmt::format("levels from {:g} to {:g} E_g", least_level, greatest_level),
                         fmt::format("{} J = {} E_g", joules, level));
        }
    }
}

// From, to, count: at least two where they differ.
std::vector<double> read_frequencies(const SceneValue& section, double unit) {
    const auto number = [&](const char* key) {
        const SceneValue value = section[key];
        const double ratio = value.positive() / unit;
        if (!(ratio >= least_frequency && ratio <= greatest_frequency))
            value.fail(fmt::format("{:g} to {:g} omega_1", least_frequency, greatest_frequency),
                       fmt::format("{:g} omega_1", ratio));
        return ratio;
    };
    const double from = number("from");
    const double to = number("to");
    const SceneValue count_value = section["count"];
    const long count = count_value.integer(1, max_frequencies);
    if (from > to) section["to"].fail("a number >= forcing.from");
    if ((from == to) != (count == 1))
        count_value.fail(from == to ? "1, since from = to" : "at least 2, since from < to");
    return spaced(from, to, count, false);
}

Forcing read_forcing(const SceneValue& section, const Bar& bar, int cells) {
    Forcing forcing;
    forcing.amplitude = section["amplitude"].within(1e-9 * bar.force_unit(), 1e9 * bar.force_unit());
    const auto one_of = [&](const char* key, const Keys& words, std::size_t otherwise) {
        const SceneValue value = section[key];
        if (value.missing()) return otherwise;
        const std::string word = value.text(fmt::format("one of {}", fmt::join(words, ", ")));
        const auto found = std::find(words.begin(), words.end(), word);
        if (found == words.end()) value.fail(fmt::format("one of {}", fmt::join(words, ", ")));
        return static_cast<std::size_t>(found - words.begin());
    };
    (void)one_of("at", {"tip"}, 0);
    (void)one_of("shape", {"cosine"}, 0);
    const bool hertz = one_of("unit", {"omega_1", "Hz"}, 0) == 1;
    forcing.frequencies = read_frequencies(section, hertz ? 0.25 / bar.travel_time() : 1.0);
    if (forcing.frequencies.back() > 0.5 * cells) {
        section["to"].fail(fmt::format("at most {:g} omega_1 on {} cells: a period needs 8 steps", 0.5 * cells, cells),
                           fmt::format("{:g} omega_1", forcing.frequencies.back()));
    }
    const std::size_t direction = one_of("direction", {"up", "down", "both"}, 2);
    forcing.up = direction != 1;
    forcing.down = direction != 0;
    forcing.settle = static_cast<int>(section["settle"].integer(0, max_force_periods));
    forcing.record = static_cast<int>(section["record"].integer(2, max_force_periods));
    forcing.from_rest = one_of("start", {"last", "rest"}, 0) == 1;
    // What memory holds: the tip over a record, and each point's section and waves.
    const double longest = 4.0 * cells / forcing.frequencies.front();
    if (forcing.record * longest > max_recorded_steps) {
        section["record"].fail(
            fmt::format("at most {:.0f} periods, which have {:g} steps", max_recorded_steps / longest, longest));
    }
    const double numbers = 2.0 * static_cast<double>(forcing.frequencies.size()) * (2.0 * cells + 2.0 * forcing.record);
    if (numbers > max_kept_numbers) {
        section["count"].fail(fmt::format("at most {:.0f} frequencies of so many cells and recorded periods",
                                          max_kept_numbers / (4.0 * cells + 4.0 * forcing.record)));
    }
    return forcing;
}

Damping read_damping(const SceneValue& section) {
    const bool distributed = section["kind"].is_second("tip", "distributed");
    const double value = section["value"].within(1e-12, distributed ? 1e12 : 1e3);
    return {distributed ? Damping::Kind::distributed : Damping::Kind::tip, value};
}

Objective read_objective(const SceneValue& value) {
    constexpr const char* names = "\"least-shock\", \"nearest\", \"least-force\", \"min-energy\" or \"max-energy\"";
    const std::optional<Objective> objective = objective_named(value.text(names));
    if (!objective) value.fail(names);
    return *objective;
}

}  // namespace

namespace {

std::vector<std::string_view> lines_of(std::string_view text) {
    std::vector<std::string_view> lines;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        lines.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return lines;
}

// Where a line of TOML that cannot be read seems to hold a text without its quotation marks.
std::string_view quotes_hint(std::string_view line) {
    const std::size_t equals = line.find('=');
    const std::size_t value = equals == std::string_view::npos ? equals : line.find_first_not_of(" \t[", equals + 1);
    const bool word = value != std::string_view::npos && std::isalpha(static_cast<unsigned char>(line[value])) != 0;
    return word ? "; a text stands in \"quotation marks\"" : "";
}

}  // namespace

Scene parse_scene(std::string_view text, const std::string& where) {
    if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) {
        throw InputError(one_line(fmt::format("{}: expected a scene, got an empty file", where)));
    }
    if (const auto place = too_deep(text, deepest)) {
        const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(*place), '\n');
        throw InputError(
            one_line(fmt::format("{}:{}: expected brackets and keys at most {} deep, got more", where, line, deepest)));
    }
    const SceneText source{where, lines_of(text)};
    toml::table table;
    try {
        table = toml::parse(text, std::string_view(where));
    } catch (const toml::parse_error& error) {
        const auto number = error.source().begin.line;
        const std::string_view line = number >= 1 && number <= source.lines.size() ? source.lines[number - 1] : "";
        throw InputError(one_line(fmt::format("{}:{}: expected TOML, got a syntax error: {}{}", where, number,
                                              shortened(std::string(error.description()), 200), quotes_hint(line))));
    }
    const SceneValue root(source, "", table);
    root.refuse_all_but({"title", "bar", "mesh", "patterns", "levels", "program", "damping", "forcing"});
    Scene scene;
    scene.title = root["title"].text("one line of text");
    scene.bar = read_bar(root);
    scene.mesh.cells = static_cast<int>(root.section("mesh", {"cells"})["cells"].integer(1, max_cells));
    const SceneValue patterns = root.section("patterns", {"mode", "period", "contact", "list", "kinds"});
    scene.patterns = read_patterns(patterns, scene.mesh.cells);
    if (const SceneValue kinds = patterns["kinds"]; !kinds.missing())
        scene.all_kinds = kinds.is_second("contact", "all");
    read_levels(root.section("levels", {"list", "from", "to", "count", "spacing", "unit"}), scene);
    scene.objective = read_objective(root.section("program", {"objective"})["objective"]);
    if (!root["damping"].missing()) scene.damping = read_damping(root.section("damping", {"kind", "value"}));
    if (!root["forcing"].missing()) {
        scene.forcing = read_forcing(root.section("forcing", {"amplitude", "at", "shape", "from", "to", "count", "unit",
                                                              "direction", "settle", "record", "start"}),
                                     scene.bar, scene.mesh.cells);
    }
    scene.text = text;
    return scene;
}

Scene with_changes(const Scene& scene, std::optional<int> cells, std::optional<double> gap, const std::string& where) {
    const toml::table table = toml::parse(scene.text);
    // From the last to the first, so that places stay where they are.
    struct Change {
        toml::source_region place;
        std::string value;
    };
    std::vector<Change> changes;
    if (cells) changes.push_back({table["mesh"]["cells"].node()->source(), fmt::format("{}", *cells)});
    if (gap) changes.push_back({table["bar"]["gap"].node()->source(), fmt::format("{}", *gap)});
    std::sort(changes.begin(), changes.end(),
              [](const Change& a, const Change& b) { return a.place.begin > b.place.begin; });
    std::string text = scene.text;
    for (const auto& [place, value] : changes) {
        std::size_t line = 0;
        for (auto number = place.begin.line; number > 1; --number) line = text.find('\n', line) + 1;
        text.replace(line + place.begin.column - 1, place.end.column - place.begin.column, value);
    }
    return parse_scene(text, where);
}

Scene read_scene(const std::filesystem::path& file) {
    return parse_scene(InputFile(file, "a scene file").text(max_scene_bytes), file.string());
}

}  // namespace nsma
