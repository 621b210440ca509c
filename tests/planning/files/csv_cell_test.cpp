#include "planning/files/csv_cell.h"

#include <gtest/gtest.h>

namespace arthronaut::files {
namespace {

TEST(CsvCell, StaysOneCellAndNoFormula) {
  EXPECT_EQ(csv_cell(""), "");
  EXPECT_EQ(csv_cell("Anna's knee; 3.5 mm"), "Anna's knee; 3.5 mm");
  EXPECT_EQ(csv_cell("right, second"), "\"right, second\"");
  EXPECT_EQ(csv_cell("a \"note\""), "\"a \"\"note\"\"\"");
  EXPECT_EQ(csv_cell("one\r\ntwo"), "\"one\r\ntwo\"");
  for (const char* formula : {"=1+1", "+1", "-1", "@A1"})
    EXPECT_EQ(csv_cell(formula), std::string("'") + formula);
  EXPECT_EQ(csv_cell("=A1,B1"), "\"'=A1,B1\"");
}

}  // namespace
}  // namespace arthronaut::files
