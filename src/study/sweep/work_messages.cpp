#include "work_messages.hpp"

#include <cstring>
#include <stdexcept>

#include "record_rows.hpp"

namespace nsma {
namespace {

class Bytes {
public:
    std::string text;
    template <class Number>
    void number(Number value) {
        text.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    void row(const Row& row) {
        number(static_cast<std::uint64_t>(row.size()));
        for (const Value& value : row) {
            text.push_back(static_cast<char>(value.index()));
            if (const auto* whole = std::get_if<std::int64_t>(&value)) number(*whole);
            if (const auto* real = std::get_if<double>(&value)) number(*real);
            if (const auto* word = std::get_if<std::string>(&value)) {
                number(static_cast<std::uint64_t>(word->size()));
                text += *word;
            }
        }
    }
    void numbers(const std::vector<double>& values) {
        number(static_cast<std::uint64_t>(values.size()));
        for (const double value : values) number(value);
    }
};

class Unpacker {
public:
    explicit Unpacker(std::string_view bytes) : left_(bytes) {}

    template <class Number>
    Number number() {
        Number value;
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }
    Row row() {
        Row row;
        for (auto count = size(1); count > 0; --count) {
            switch (take(1)[0]) {
                case 0: row.emplace_back(); break;
                case 1: row.emplace_back(number<std::int64_t>()); break;
                case 2: row.emplace_back(number<double>()); break;
                case 3: row.emplace_back(std::string(take(size(1)))); break;
                default: fail();
            }
        }
        return row;
    }
    std::vector<double> numbers() {
        std::vector<double> values(size(sizeof(double)));
        for (double& value : values) value = number<double>();
        return values;
    }
    void end() const {
        if (!left_.empty()) fail();
    }
    std::size_t size(std::size_t each) {
        const auto count = number<std::uint64_t>();
        if (count > left_.size() / each) fail();
        return static_cast<std::size_t>(count);
    }

private:
    [[noreturn]] static void fail() {
        throw std::invalid_argument("message: expected a packed record, got other bytes");
    }
    std::string_view take(std::size_t size) {
        if (size > left_.size()) fail();
        const auto part = left_.substr(0, size);
        left_.remove_prefix(size);
        return part;
    }
    std::string_view left_;
};

void pack(Bytes& bytes, const WorkUnit& unit) {
    bytes.number(static_cast<std::int64_t>(unit.pattern));
    bytes.number(static_cast<std::int64_t>(unit.place));
    bytes.numbers(unit.before);
}

void unpack(Unpacker& bytes, WorkUnit& unit) {
    unit.pattern = static_cast<long>(bytes.number<std::int64_t>());
    unit.place = static_cast<int>(bytes.number<std::int64_t>());
    unit.before = bytes.numbers();
}

void pack(Bytes& bytes, const WorkResult& result) {
    const ResultRows rows = rows_of(result);
    bytes.number(static_cast<std::int64_t>(result.pattern));
    bytes.number(static_cast<std::int64_t>(result.place));
    bytes.row(rows.pattern);
    bytes.row(rows.answer);
    bytes.number(static_cast<std::uint64_t>(rows.runs.size()));
    for (const Row& run : rows.runs) bytes.row(run);
    bytes.numbers(rows.beta);
}

void unpack(Unpacker& bytes, WorkResult& result, const Bar& bar) {
    result.pattern = static_cast<long>(bytes.number<std::int64_t>());
    result.place = static_cast<int>(bytes.number<std::int64_t>());
    ResultRows rows;
    rows.pattern = bytes.row();
    rows.answer = bytes.row();
    for (auto runs = bytes.size(1); runs > 0; --runs) rows.runs.push_back(bytes.row());
    rows.beta = bytes.numbers();
    if (result.place < 0) {
        result.record = pattern_record_of(rows.pattern);
    } else {
        result.answer = orbit_answer_of(rows, bar);
    }
}

template <class Item>
std::string packed_all(const std::vector<Item>& items) {
    Bytes bytes;
    bytes.number(static_cast<std::uint64_t>(items.size()));
    for (const Item& item : items) pack(bytes, item);
    return std::move(bytes.text);
}

template <class Item, class... Context>
std::vector<Item> unpacked_all(std::string_view text, const Context&... context) {
    Unpacker bytes(text);
    std::vector<Item> items(bytes.size(1));
    for (Item& item : items) unpack(bytes, item, context...);
    bytes.end();
    return items;
}

}  // namespace

std::string packed(const std::vector<WorkUnit>& units) { return packed_all(units); }

std::vector<WorkUnit> unpacked_units(std::string_view bytes) { return unpacked_all<WorkUnit>(bytes); }

std::string packed(const std::vector<WorkResult>& results) { return packed_all(results); }

std::vector<WorkResult> unpacked_results(std::string_view bytes, const Bar& bar) {
    return unpacked_all<WorkResult>(bytes, bar);
}

}  // namespace nsma
