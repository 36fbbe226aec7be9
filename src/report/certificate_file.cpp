#include "certificate_file.hpp"

#include <array>
#include <limits>
#include <set>

#include <nlohmann/json.hpp>

#include "one_line.hpp"

#include "nsma/report/input_error.hpp"

namespace nsma {
namespace {

// Fields keep their order, so that equal certificates are equal bytes.
using Json = nlohmann::ordered_json;
constexpr int format_version = 2;
constexpr std::array<std::pair<Certificate::Claim, const char*>, 3> claims{{
    {Certificate::Claim::trivial, "trivial"},
    {Certificate::Claim::empty, "empty"},
    {Certificate::Claim::nonempty, "nonempty"},
}};

Json vector_json(const RationalVector& vector) {
    Json list = Json::array();
    for (const auto& [index, value] : vector) list.push_back({index, to_string(value)});
    return list;
}

Json combination_json(const RowCombination& combination) {
    return {{"rows", vector_json(combination.rows)}, {"contact", to_string(combination.contact)}};
}

Json bounds_json(const std::vector<FormBound>& bounds) {
    Json list = Json::array();
    for (const auto& bound : bounds) {
        Json entry{{"form", vector_json(bound.form)}};
        entry.update(combination_json(bound.proof));
        list.push_back(std::move(entry));
    }
    return list;
}

// Reads the fields of one object, each once, and finds those that nobody asked for.
class Reader {
public:
    Reader(const Json& json, std::string where) : json_(json), where_(std::move(where)) {
        if (!json.is_object()) fail("an object", json);
    }

    [[noreturn]] void fail(const std::string& expected, const Json& got, const char* key = nullptr) const {
        std::string text = got.dump(-1, ' ', true, Json::error_handler_t::replace);
        if (text.size() > 60) text = text.substr(0, 57) + "...";
        // An unknown key may hold anything.
        throw InputError(one_line(where_ + ": " + (key != nullptr ? std::string(key) + ": " : std::string()) +
                                  "expected " + expected + ", got " + text));
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

    [[nodiscard]] int integer(const char* key) { return integer(required(key), key); }
    [[nodiscard]] int integer(const Json& value, const char* key) const {
        if (!value.is_number_integer()) fail("a whole number", value, key);
        const bool fits = value.is_number_unsigned() ? value.get<std::uint64_t>() <=
                                                           static_cast<std::uint64_t>(std::numeric_limits<int>::max())
                                                     : value.get<std::int64_t>() >= std::numeric_limits<int>::min();
        if (!fits) fail("a whole number of 32 bits", value, key);
        return value.get<int>();
    }
    [[nodiscard]] Rational fraction(const Json& value, const char* key) const {
        if (!value.is_string()) fail("a fraction as text", value, key);
        const auto read = parse_rational(value.get<std::string>());
        if (!read) fail("a fraction such as \"-12/11\"", value, key);
        return *read;
    }
    [[nodiscard]] const Json& list(const Json& value, const char* key) const {
        if (!value.is_array()) fail("a list", value, key);
        return value;
    }
    [[nodiscard]] RationalVector vector(const Json& value, const char* key) const {
        RationalVector result;
        for (const auto& entry : list(value, key)) {
            if (!entry.is_array() || entry.size() != 2) fail("a pair [index, \"fraction\"]", entry, key);
            result.emplace_back(integer(entry[0], key), fraction(entry[1], key));
        }
        return result;
    }
    [[nodiscard]] RowCombination combination() {
        return {vector(required("rows"), "rows"), fraction(required("contact"), "contact")};
    }
    [[nodiscard]] std::vector<FormBound> bounds(const char* key) {
        std::vector<FormBound> result;
        const Json* value = optional(key);
        if (value == nullptr) return result;
        for (const auto& entry : list(*value, key)) {
            Reader reader(entry, where_ + ": " + key);
            FormBound bound;
            bound.form = reader.vector(reader.required("form"), "form");
            bound.proof = reader.combination();
            reader.finish();
            result.push_back(std::move(bound));
        }
        return result;
    }
    void finish() const {
        for (const auto& [key, value] : json_.items()) {
            if (!known_.contains(key)) fail("no such field", value, key.c_str());
        }
    }

private:
    const Json& json_;
    std::string where_;
    std::set<std::string> known_;
};

}  // namespace

std::string certificate_json(const Certificate& certificate) {
    Json json{{"certificate", format_version},
              {"cells", certificate.pattern.cells},
              {"free_steps", certificate.pattern.free_steps},
              {"contact_steps", certificate.pattern.contact_steps},
              {"gap_sign", certificate.gap_sign}};
    for (const auto& [claim, text] : claims) {
        if (claim == certificate.claim) json["claim"] = text;
    }
    if (certificate.kind) json["kind"] = name(*certificate.kind);
    const auto add_energy = [&](const char* key, const std::optional<Rational>& energy) {
        if (energy) json[key] = to_string(*energy);
    };
    add_energy("energy_least", certificate.energy_least);
    add_energy("energy_attained", certificate.energy_attained);
    add_energy("energy_bound", certificate.energy_bound);
    const auto add = [&](const char* key, Json list) {
        if (!list.empty()) json[key] = std::move(list);
    };
    add("projection", vector_json(certificate.projection));
    add("rest", bounds_json(certificate.rest));
    add("ray", vector_json(certificate.ray));
    add("greatest", vector_json(certificate.greatest));
    const auto& proof = certificate.greatest_proof;
    add("chain", Json(proof.chain));
    add("chain_bounds", bounds_json(proof.chain_bounds));
    return json.dump();
}

Certificate parse_certificate(std::string_view text, const std::string& where) {
    const Json json = Json::parse(text, nullptr, false);
    if (json.is_discarded()) {
        throw InputError(where + ": expected one JSON object a line, got something else");
    }
    Reader reader(json, where);
    Certificate certificate;
    if (const int version = reader.integer("certificate"); version != format_version) {
        reader.fail(std::to_string(format_version), json["certificate"], "certificate");
    }
    certificate.pattern = {reader.integer("cells"), reader.integer("free_steps"), reader.integer("contact_steps")};
    certificate.gap_sign = reader.integer("gap_sign");
    const Json& claim = reader.required("claim");
    bool known = false;
    for (const auto& [value, name] : claims) {
        if (claim.is_string() && claim.get<std::string>() == name) {
            certificate.claim = value;
            known = true;
        }
    }
    if (!known) reader.fail("trivial, empty or nonempty", claim, "claim");
    if (const Json* kind = reader.optional("kind")) {
        for (const PatternKind one : pattern_kinds) {
            if (kind->is_string() && kind->get<std::string>() == name(one)) certificate.kind = one;
        }
        if (!certificate.kind) reader.fail("contact, free or stuck", *kind, "kind");
    }
    const auto energy = [&](const char* key, std::optional<Rational>& target) {
        if (const Json* value = reader.optional(key)) target = reader.fraction(*value, key);
    };
    energy("energy_least", certificate.energy_least);
    energy("energy_attained", certificate.energy_attained);
    energy("energy_bound", certificate.energy_bound);
    const auto vector = [&](const char* key, RationalVector& target) {
        if (const Json* value = reader.optional(key)) target = reader.vector(*value, key);
    };
    vector("projection", certificate.projection);
    vector("ray", certificate.ray);
    vector("greatest", certificate.greatest);
    certificate.rest = reader.bounds("rest");
    auto& proof = certificate.greatest_proof;
    proof.chain_bounds = reader.bounds("chain_bounds");
    if (const Json* chain = reader.optional("chain")) {
        for (const auto& entry : reader.list(*chain, "chain")) proof.chain.push_back(reader.integer(entry, "chain"));
    }
    reader.finish();
    return certificate;
}

}  // namespace nsma
