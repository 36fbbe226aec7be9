#include "study/sweep/record_fields.hpp"

#include <gtest/gtest.h>

namespace nsma {
namespace {

TEST(RecordFields, NamesAndValuesAreAsMany) {
    EXPECT_EQ(row_of(PatternRecord{}).size(), fields_of<PatternRecord>().size());
    EXPECT_EQ(rows_of({0, 0, std::nullopt, OrbitAnswer{}}).record.size(), fields_of<OrbitAnswer>().size());
}

TEST(RecordFields, RowsThatDoNotFitAreRefused) {
    RecordRow pattern = row_of(PatternRecord{});
    pattern.pop_back();
    EXPECT_THROW((void)record_of<PatternRecord>(pattern), std::invalid_argument);
    ResultRows rows = rows_of({0, 0, std::nullopt, OrbitAnswer{}});
    rows.record.emplace_back();
    EXPECT_THROW((void)result_of(rows, Bar{}), std::invalid_argument);
}

TEST(RecordFields, ValuesOfAnotherKindAreRefused) {
    for (std::size_t i = 0; i < fields_of<PatternRecord>().size(); ++i) {
        RecordRow row = row_of(PatternRecord{});
        // No field is of the kind that its opposite has.
        row[i] = std::holds_alternative<std::string>(row[i]) ? FieldValue(std::int64_t{1}) : FieldValue("splendid");
        EXPECT_THROW((void)record_of<PatternRecord>(row), std::invalid_argument) << fields_of<PatternRecord>()[i].name;
    }
    RecordRow row = row_of(PatternRecord{});
    row[0] = std::int64_t{1} << 40;
    EXPECT_THROW((void)record_of<PatternRecord>(row), std::invalid_argument);
}

}  // namespace
}  // namespace nsma
