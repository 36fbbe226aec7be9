#pragma once

#include <array>
#include <initializer_list>
#include <string>
#include <vector>

#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Statement.h>

#include "study/sweep/record_fields.hpp"

namespace nsma {

/// A table of a store: integers that name a row, then the fields of a record.
struct StoreTable {
    const char* name;
    std::vector<std::string> keys;
    std::vector<std::string> columns;

    [[nodiscard]] std::string create_sql() const;
    [[nodiscard]] std::string insert_sql() const;  ///< a row that is there already stays as it is
};
/// patterns, answers, solves and orbits.
[[nodiscard]] const std::array<StoreTable, 4>& store_tables();

/// The view of all times.
extern const char* const timings_view_sql;

/// A statement that runs again and again.
class StoreStatement {
public:
    StoreStatement(SQLite::Database& database, const std::string& sql);

    /// Inserts a row.
    void insert(std::initializer_list<std::int64_t> keys, const Row& row);
    /// Asks for the rows of these keys; step() moves to the next one, false: there is none.
    void select(std::initializer_list<std::int64_t> keys);
    bool step() { return statement_.executeStep(); }
    [[nodiscard]] long integer(int column) { return statement_.getColumn(column).getInt64(); }
    [[nodiscard]] std::string text(int column) { return statement_.getColumn(column).getString(); }
    [[nodiscard]] Row row(int from);  ///< the values from a column on

private:
    SQLite::Statement statement_;
};

}  // namespace nsma
