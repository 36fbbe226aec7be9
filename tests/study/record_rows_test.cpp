#include "study/sweep/record_rows.hpp"

#include <gtest/gtest.h>

namespace nsma {
namespace {

TEST(RecordRows, NamesAndValuesAreAsMany) {
    const ResultRows rows = rows_of({0, 0, PatternRecord{}, OrbitAnswer{}});
    EXPECT_EQ(rows.pattern.size(), pattern_columns().size());
    EXPECT_EQ(rows.answer.size(), answer_columns().size());
}

TEST(RecordRows, RowsThatDoNotFitAreRefused) {
    ResultRows rows = rows_of({0, 0, PatternRecord{}, OrbitAnswer{}});
    rows.pattern.pop_back();
    rows.answer.emplace_back();
    EXPECT_THROW((void)pattern_record_of(rows.pattern), std::invalid_argument);
    EXPECT_THROW((void)orbit_answer_of(rows, Bar{}), std::invalid_argument);
}

}  // namespace
}  // namespace nsma
