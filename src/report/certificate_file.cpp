#include "certificate_file.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <set>

#include <nlohmann/json.hpp>

#include "nesting.hpp"
#include "one_line.hpp"

#include "nsma/report/input_error.hpp"

namespace nsma {
namespace {

// Fields keep their order, so that equal certificates are equal bytes.
using Json = nlohmann::ordered_json;
constexpr int format_version = 3;
constexpr int deepest = 16;                                        // brackets; those of a certificate go four deep
constexpr std::array claim_names{"trivial", "empty", "nonempty"};  // by Claim
constexpr std::array objective_names{"least-shock", "least-force", "nearest"};  // by Optimum::Of

// Visits the fields of a certificate in the order of the file.
template <class Fields, class Visitor>
void for_each_field(Fields& certificate, Visitor&& visit) {
    visit("cells", certificate.pattern.cells);
    visit("free_steps", certificate.pattern.free_steps);
    visit("contact_steps", certificate.pattern.contact_steps);
    visit("gap_sign", certificate.gap_sign);
    visit("claim", certificate.claim);
    visit("kind", certificate.kind);
    visit("energy_least", certificate.energy_least);
    visit("energy_attained", certificate.energy_attained);
    visit("energy_bound", certificate.energy_bound);
    visit("projection", certificate.projection);
    visit("forcing_row", certificate.forcing_row);
    visit("ray", certificate.ray);
    visit("greatest", certificate.greatest);
    visit("chain", certificate.chain);
    visit("optimum", certificate.optimum);
}

template <class Fields, class Visitor>
void for_each_optimum_field(Fields& optimum, Visitor&& visit) {
    visit("objective", optimum.objective);
    visit("energy", optimum.energy);
    visit("bound", optimum.bound);
    visit("value", optimum.value);
    visit("energy_error", optimum.energy_error);
    visit("orbit", optimum.orbit);
    visit("window", optimum.window);
    visit("multiplier", optimum.multiplier);
    if (optimum.objective != Optimum::Of::nearest) return;
    visit("level", optimum.level);
    visit("reference", optimum.reference);
}

Json json_of(int value) { return value; }
Json json_of(const Rational& value) { return to_string(value); }
Json json_of(PatternKind kind) { return name(kind); }
Json json_of(Optimum::Of objective) { return objective_names.at(static_cast<std::size_t>(objective)); }
Json json_of(Certificate::Claim claim) { return claim_names.at(static_cast<std::size_t>(claim)); }
Json json_of(const std::pair<int, Rational>& entry) { return {entry.first, to_string(entry.second)}; }

template <class Entry>
Json json_of(const std::vector<Entry>& entries) {
    Json list = Json::array();
    for (const Entry& entry : entries) list.push_back(json_of(entry));
    return list;
}

Json json_of(const Optimum& optimum) {
    auto json = Json::object();
    for_each_optimum_field(optimum, [&json](const char* key, const auto& value) { json[key] = json_of(value); });
    return json;
}

template <class Value>
Json json_of(const std::optional<Value>& value) {
    return value ? json_of(*value) : Json();
}

// Reads the fields of one object, each once, and finds those that nobody asked for.
class Reader {
public:
    Reader(const Json& json, std::string where) : json_(json), where_(std::move(where)) {
        if (!json.is_object()) fail("an object", json);
    }

    [[noreturn]] void fail(const std::string& expected, const Json& got, const char* key = nullptr) const {
        std::string text = got.is_array()    ? "a list"
                           : got.is_object() ? "an object"
                                             : got.dump(-1, ' ', true, Json::error_handler_t::replace);
        // An unknown key may hold anything.
        throw InputError(one_line(where_ + ": " + (key != nullptr ? shortened(key) + ": " : std::string()) +
                                  "expected " + expected + ", got " + shortened(std::move(text))));
    }

    void operator()(const char* key, int& value) { read(required(key), key, value); }
    void operator()(const char* key, Certificate::Claim& claim) { read(required(key), key, claim); }
    void operator()(const char* key, Optimum::Of& objective) { read(required(key), key, objective); }
    template <class Value>
    void operator()(const char* key, Value& value) {
        if (const Json* json = optional(key)) read(*json, key, value);
    }

    [[nodiscard]] const Json* optional(const char* key) {
        known_.insert(key);
        const auto found = json_.find(key);
        return found == json_.end() ? nullptr : &*found;
    }
    [[nodiscard]] const Json& required(const char* key) {
        const Json* found = optional(key);
        if (found == nullptr) throw InputError(where_ + ": " + key + ": expected a value, got none");
        return *found;
    }

    void finish() const {
        for (const auto& [key, value] : json_.items()) {
            if (!known_.contains(key)) fail("no such field", value, key.c_str());
        }
    }

private:
    void read(const Json& json, const char* key, int& value) const {
        if (!json.is_number_integer()) fail("a whole number", json, key);
        const bool fits = json.is_number_unsigned()
                              ? json.get<std::uint64_t>() <= static_cast<std::uint64_t>(std::numeric_limits<int>::max())
                              : json.get<std::int64_t>() >= std::numeric_limits<int>::min();
        if (!fits) fail("a whole number of 32 bits", json, key);
        value = json.get<int>();
    }
    void read(const Json& json, const char* key, Rational& value) const {
        if (!json.is_string()) fail("a fraction as text", json, key);
        const auto known = parse_rational(json.get<std::string>());
        if (!known) fail("a fraction such as \"-12/11\"", json, key);
        value = *known;
    }
    void read(const Json& json, const char* key, Certificate::Claim& claim) const {
        const auto* known = std::find_if(claim_names.begin(), claim_names.end(), [&](auto one) { return json == one; });
        if (known == claim_names.end()) fail("trivial, empty or nonempty", json, key);
        claim = static_cast<Certificate::Claim>(known - claim_names.begin());
    }
    void read(const Json& json, const char* key, Optimum::Of& objective) const {
        const auto* known =
            std::find_if(objective_names.begin(), objective_names.end(), [&](auto one) { return json == one; });
        if (known == objective_names.end()) fail("least-shock, least-force or nearest", json, key);
        objective = static_cast<Optimum::Of>(known - objective_names.begin());
    }
    void read(const Json& json, const char* key, Optimum& optimum) const {
        Reader reader(json, where_ + ": " + key);
        for_each_optimum_field(optimum, reader);
        reader.finish();
    }
    void read(const Json& json, const char* key, PatternKind& kind) const {
        const auto* known =
            std::find_if(pattern_kinds.begin(), pattern_kinds.end(), [&](auto one) { return json == name(one); });
        if (known == pattern_kinds.end()) fail("contact, free or stuck", json, key);
        kind = *known;
    }
    void read(const Json& json, const char* key, std::pair<int, Rational>& entry) const {
        if (!json.is_array() || json.size() != 2) fail("a pair [index, \"fraction\"]", json, key);
        read(json[0], key, entry.first);
        read(json[1], key, entry.second);
    }
    template <class Value>
    void read(const Json& json, const char* key, std::optional<Value>& value) const {
        read(json, key, value.emplace());
    }
    template <class Entry>
    void read(const Json& json, const char* key, std::vector<Entry>& entries) const {
        if (!json.is_array()) fail("a list", json, key);
        for (const Json& entry : json) read(entry, key, entries.emplace_back());
    }

    const Json& json_;
    std::string where_;
    std::set<std::string> known_;
};

}  // namespace

std::string certificate_json(const Certificate& certificate) {
    Json json{{"certificate", format_version}};
    const auto write = [&json](const char* key, const auto& value) {
        Json field = json_of(value);
        if (!field.empty()) json[key] = std::move(field);  // nothing for null and empty lists
    };
    for_each_field(certificate, write);
    return json.dump();
}

Certificate parse_certificate(std::string_view text, const std::string& where) {
    if (const auto place = too_deep(text, deepest)) {
        throw InputError(where + ": expected brackets at most " + std::to_string(deepest) + " deep, got more at byte " +
                         std::to_string(*place + 1));
    }
    const Json json = Json::parse(text, nullptr, false);
    if (json.is_discarded()) {
        throw InputError(where + ": expected one JSON object a line, got something else");
    }
    Reader reader(json, where);
    int version = 0;
    reader("certificate", version);
    if (version != format_version) reader.fail(std::to_string(format_version), json["certificate"], "certificate");
    Certificate certificate;
    for_each_field(certificate, reader);
    reader.finish();
    return certificate;
}

}  // namespace nsma
