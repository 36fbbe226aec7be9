#include "result_checksum.hpp"

#include <bit>
#include <type_traits>

#include <fmt/format.h>

#include "orbit/fnv_hash.hpp"

namespace nsma {
namespace {

void add(FnvHash& hash, const std::string& text) {
    hash.add(text.size());
    for (const char letter : text) hash.add(static_cast<unsigned char>(letter));
}

void add(FnvHash& hash, const RecordRow& row) {
    constexpr std::size_t integer_index = 2;
    static_assert(std::is_same_v<std::variant_alternative_t<integer_index, FieldValue>, std::int64_t>);
    hash.add(row.size());
    for (const FieldValue& value : row) {
        const auto* truth = std::get_if<bool>(&value);
        hash.add(truth != nullptr ? integer_index : value.index());  // SQLite has no truth values
        if (truth != nullptr) hash.add(*truth ? 1 : 0);
        if (const auto* whole = std::get_if<std::int64_t>(&value)) hash.add(static_cast<std::uint64_t>(*whole));
        if (const auto* real = std::get_if<double>(&value)) hash.add(std::bit_cast<std::uint64_t>(*real));
        if (const auto* text = std::get_if<std::string>(&value)) add(hash, *text);
    }
}

}  // namespace

std::string hash_of(const std::string& text) {
    FnvHash hash;
    for (const char letter : text) hash.add(static_cast<unsigned char>(letter));
    return fmt::format("{:016x}", hash.value());
}

std::int64_t checksum(const ResultRows& rows, const std::string& beta) {
    FnvHash hash;
    hash.add(static_cast<std::uint64_t>(rows.pattern));
    hash.add(static_cast<std::uint64_t>(rows.place));
    add(hash, rows.record);
    for (const RecordRow& run : rows.runs) add(hash, run);
    add(hash, beta);
    return static_cast<std::int64_t>(hash.value());
}

}  // namespace nsma
