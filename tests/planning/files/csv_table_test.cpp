#include "planning/files/csv_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "planning/geometry/error.h"
#include "tests/message_of.h"

namespace arthronaut::files {
namespace {

using test::message_of;
using testing::AllOf;
using testing::HasSubstr;

TEST(CsvTable, FindsColumnsByNameWhateverTheirOrder) {
  const CsvTable table = CsvTable::parse("z_mm, extra ,x_mm,frame\r\n1.5,a b,-2e3,7\r\n,,0.25,8\r\n", "p.csv",
                                         {"x_mm", "frame"});
  ASSERT_EQ(table.row_count(), 2U);
  EXPECT_EQ(table.number(0, "x_mm"), -2000);
  EXPECT_EQ(table.integer(1, "frame"), 8);
  EXPECT_EQ(table.text(0, "extra"), "a b");
  EXPECT_EQ(table.optional_number(0, "z_mm"), 1.5);
  EXPECT_EQ(table.optional_number(1, "z_mm"), std::nullopt);
  EXPECT_FALSE(table.has_column("y_mm"));
}

TEST(CsvTable, EveryErrorNamesFileLineAndColumn) {
  EXPECT_THAT(message_of<InvalidInput>([] { (void)CsvTable::parse("a,b\n1,2\n1\n", "p.csv", {}); }),
              AllOf(HasSubstr("p.csv"), HasSubstr("line 3")));
  EXPECT_THAT(message_of<InvalidInput>([] { (void)CsvTable::parse("a,b\n", "p.csv", {"c"}); }),
              HasSubstr("\"c\""));
  EXPECT_THROW((void)CsvTable::parse("", "p.csv", {}), InvalidInput);
  const CsvTable table = CsvTable::parse("a,b\n1,x\nnan,1.5\n1e999,\n", "p.csv", {"a"});
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)table.number(0, "b"); }),
              AllOf(HasSubstr("line 2"), HasSubstr("column b")));
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)table.number(1, "a"); }),
              AllOf(HasSubstr("line 3"), HasSubstr("finite")));
  EXPECT_THROW((void)table.number(2, "a"), InvalidInput);
  EXPECT_THROW((void)table.integer(1, "b"), InvalidInput);
  EXPECT_THROW((void)table.number(2, "b"), InvalidInput);
  EXPECT_THROW((void)table.number(0, "c"), InvalidInput);
}

// A spreadsheet of a country whose decimal sign is the comma saves so.
TEST(CsvTable, AnotherSeparatorIsNamed) {
  EXPECT_THAT(message_of<InvalidInput>([] { (void)CsvTable::parse("a;b\n1,5;2\n", "p.csv", {"a"}); }),
              AllOf(HasSubstr("p.csv: line 1"), HasSubstr("semicolons"), HasSubstr("commas are expected")));
  EXPECT_THAT(message_of<InvalidInput>([] { (void)CsvTable::parse("a\tb\n1\t2\n", "p.csv", {"a"}); }),
              HasSubstr("tabs: commas are expected"));
}

// As old programs of the Macintosh end their lines: all would be one header.
TEST(CsvTable, LinesWithoutLineFeedsAreNamed) {
  EXPECT_THAT(message_of<InvalidInput>([] { (void)CsvTable::parse("a,b\r1,2\r", "p.csv", {"a"}); }),
              AllOf(HasSubstr("p.csv: line 1"), HasSubstr("carriage returns alone")));
  EXPECT_EQ(CsvTable::parse("a,b\r\n1,2\r\n", "p.csv", {"a"}).row_count(), 1U);
  EXPECT_EQ(CsvTable::parse("a,b\r", "p.csv", {"a"}).row_count(), 0U);
}

// 2^32 + 4 is not 4.
TEST(CsvTable, AnIntegerThatAnIntDoesNotHoldIsRefused) {
  const CsvTable table = CsvTable::parse("id\n4294967300\n-2147483648\n", "p.csv", {});
  EXPECT_THAT(message_of<InvalidInput>([&] { (void)table.int32(0, "id"); }),
              HasSubstr("line 2, column id: 4294967300 is out of range"));
  EXPECT_EQ(table.int32(1, "id"), -2147483647 - 1);
  EXPECT_EQ(table.integer(0, "id"), 4294967300);
}

// What a spreadsheet saves as UTF-8 begins with its mark, which is of no column's name.
TEST(CsvTable, AByteOrderMarkIsPassedOver) {
  const CsvTable table = CsvTable::parse("\xEF\xBB\xBFid,x_mm\n7,1.5\n", "p.csv", {"id", "x_mm"});
  EXPECT_EQ(table.int32(0, "id"), 7);
}

// A header alone is a table without rows, as a clip without a marker writes it.
TEST(CsvTable, AHeaderAloneIsATableWithoutRows) {
  EXPECT_EQ(CsvTable::parse("a,b\n", "p.csv", {"a"}).row_count(), 0U);
  EXPECT_EQ(CsvTable::parse("a,b", "p.csv", {"b"}).row_count(), 0U);
}

// Broken tables: numbers that are finite, or InvalidInput, and nothing else.
TEST(CsvTable, BrokenTextGivesFiniteNumbersOrInvalidInput) {
  const std::string whole = "curve,time_s,x_mm,y_mm\n0,0.016,1.25,-3.5\n0,,1.5,2e-3\n1,0.05,7,8\n";
  std::mt19937 random(1);
  const auto below = [&](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  for (int i = 0; i < 5000; ++i) {
    std::string broken = whole;
    for (std::size_t n = 1 + below(3); n > 0; --n) {
      const std::size_t at = below(broken.size());
      switch (below(3)) {
        case 0:
          broken[at] = static_cast<char>(below(256));
          break;
        case 1:
          broken.erase(at, 1 + below(8));
          break;
        default:
          broken.insert(at, below(2) ? "inf" : ",,\n");
      }
      if (broken.empty()) broken = "x";
    }
    try {
      const CsvTable table = CsvTable::parse(broken, "c.csv", {"curve", "x_mm"});
      for (std::size_t row = 0; row < table.row_count(); ++row) {
        EXPECT_TRUE(std::isfinite(table.number(row, "x_mm")));
        (void)table.integer(row, "curve");
      }
    } catch (const InvalidInput& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with("c.csv: "));
    }
  }
}

}  // namespace
}  // namespace arthronaut::files
