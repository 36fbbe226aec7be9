#pragma once

#include <array>
#include <string>
#include <vector>

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

}  // namespace nsma
