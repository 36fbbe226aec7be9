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

// With the checksum of the whole result behind them.
template <class Record>
std::vector<std::string> summed() {
    std::vector<std::string> names = names_of<Record>();
    names.emplace_back("checksum");
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
    static const std::array<StoreTable, 4> tables{{{"patterns", {"number"}, summed<PatternRecord>()},
                                                   {"answers", {"pattern", "place"}, summed<OrbitAnswer>()},
                                                   {"solves", {"pattern", "place", "run"}, names_of<SolverRun>()},
                                                   {"orbits", {"pattern", "place"}, {"beta"}}}};
    return tables;
}

const char* const timings_view_sql =
    "CREATE VIEW timings AS"
    " SELECT number, NULL AS place, 'pattern' AS what, NULL AS run, seconds FROM patterns"
    " UNION ALL SELECT pattern, place, 'answer', NULL, seconds FROM answers"
    " UNION ALL SELECT pattern, place, solver, run, seconds FROM solves";

}  // namespace nsma
