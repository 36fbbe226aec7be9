#include "store_tables.hpp"

#include <fmt/format.h>

namespace nsma {
namespace {

template <class Record>
std::vector<std::string> names_of() {
    std::vector<std::string> names;
    for (const auto& field : fields_of<Record>()) names.emplace_back(field.name);
    return names;
}

}  // namespace

std::string StoreTable::create_sql() const {
    return fmt::format("CREATE TABLE {} ({} INTEGER, {}, PRIMARY KEY ({}))", name, fmt::join(keys, " INTEGER, "),
                       fmt::join(columns, ", "), fmt::join(keys, ", "));
}

std::string StoreTable::insert_sql() const {
    const std::vector<char> marks(keys.size() + columns.size(), '?');
    return fmt::format("INSERT OR IGNORE INTO {} VALUES ({})", name, fmt::join(marks, ","));
}

const std::array<StoreTable, 4>& store_tables() {
    static const std::array<StoreTable, 4> tables{{{"patterns", {"number"}, names_of<PatternRecord>()},
                                                   {"answers", {"pattern", "place"}, names_of<OrbitAnswer>()},
                                                   {"solves", {"pattern", "place", "run"}, names_of<SolverRun>()},
                                                   {"orbits", {"pattern", "place"}, {"beta"}}}};
    return tables;
}

const char* const timings_view_sql =
    "CREATE VIEW timings AS"
    " SELECT number, NULL AS place, 'pattern' AS what, NULL AS run, seconds FROM patterns"
    " UNION ALL SELECT pattern, place, 'answer', NULL, seconds FROM answers"
    " UNION ALL SELECT pattern, place, solver, run, seconds FROM solves";

StoreStatement::StoreStatement(SQLite::Database& database, const std::string& sql) : statement_(database, sql) {}

void StoreStatement::select(std::initializer_list<std::int64_t> keys) {
    statement_.reset();
    int place = 0;
    for (const std::int64_t key : keys) statement_.bind(++place, key);
}

void StoreStatement::insert(std::initializer_list<std::int64_t> keys, const Row& row) {
    select(keys);
    int place = static_cast<int>(keys.size());
    for (const Value& value : row) {
        ++place;
        if (const auto* truth = std::get_if<bool>(&value)) {
            statement_.bind(place, *truth ? 1 : 0);
        } else if (const auto* whole = std::get_if<std::int64_t>(&value)) {
            statement_.bind(place, *whole);
        } else if (const auto* real = std::get_if<double>(&value)) {
            statement_.bind(place, *real);
        } else if (const auto* text = std::get_if<std::string>(&value)) {
            statement_.bind(place, *text);
        } else {
            statement_.bind(place);
        }
    }
    statement_.exec();
}

Row StoreStatement::row(int from) {
    Row row;
    for (int i = from; i < statement_.getColumnCount(); ++i) {
        const SQLite::Column column = statement_.getColumn(i);
        if (column.isInteger()) {
            row.emplace_back(column.getInt64());
        } else if (column.isFloat()) {
            row.emplace_back(column.getDouble());
        } else if (column.isText()) {
            row.emplace_back(column.getString());
        } else {
            row.emplace_back();
        }
    }
    return row;
}

}  // namespace nsma
