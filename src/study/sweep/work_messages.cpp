#include "work_messages.hpp"

#include <algorithm>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "record_fields.hpp"

template <>
struct nlohmann::adl_serializer<nsma::FieldValue> {
    static void to_json(json& target, const nsma::FieldValue& value) {
        std::visit([&target](const auto& held) { assign(target, held); }, value);
    }
    static void from_json(const json& source, nsma::FieldValue& value) {
        switch (source.type()) {
            case json::value_t::null: value = {}; break;
            case json::value_t::boolean: value = source.get<bool>(); break;
            case json::value_t::number_integer:
            case json::value_t::number_unsigned: value = source.get<std::int64_t>(); break;
            case json::value_t::number_float: value = source.get<double>(); break;
            default: value = source.get<std::string>();
        }
    }

private:
    static void assign(json& target, std::monostate) { target = nullptr; }
    template <class Held>
    static void assign(json& target, const Held& held) {
        target = held;
    }
};

namespace nsma {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(WorkUnit, pattern, place, before)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ResultRows, pattern, place, record, runs, beta)

namespace {

// CBOR keeps every integer and double as it is.
template <class Item>
std::string bytes_of(const std::vector<Item>& items) {
    std::string bytes;
    nlohmann::json::to_cbor(items, bytes);
    return bytes;
}

template <class Item>
std::vector<Item> items_in(std::string_view bytes) {
    try {
        return nlohmann::json::from_cbor(bytes).get<std::vector<Item>>();
    } catch (const nlohmann::json::exception&) {
        throw std::invalid_argument("message: expected a packed record, got other bytes");
    }
}

}  // namespace

std::string packed(const std::vector<WorkUnit>& units) { return bytes_of(units); }

std::vector<WorkUnit> unpacked_units(std::string_view bytes) { return items_in<WorkUnit>(bytes); }

std::string packed(const std::vector<WorkResult>& results) {
    std::vector<ResultRows> rows(results.size());
    std::transform(results.begin(), results.end(), rows.begin(), rows_of);
    return bytes_of(rows);
}

std::vector<WorkResult> unpacked_results(std::string_view bytes, const Bar& bar) {
    std::vector<WorkResult> results;
    for (const ResultRows& rows : items_in<ResultRows>(bytes)) results.push_back(result_of(rows, bar));
    return results;
}

}  // namespace nsma
