#include "app/report/paper.h"

#include <gtest/gtest.h>

#include "app/report/flowing_pages.h"
#include "planning/geometry/error.h"
#include "tests/app/report/page_edges.h"
#include "tests/temporary_folder.h"

namespace arthronaut::report {

TEST(Paper, IsNamedByAWord) {
  for (const Paper paper : {Paper::A4, Paper::Letter}) EXPECT_EQ(paper_from_text(to_text(paper)), paper);
  EXPECT_THROW((void)paper_from_text("legal"), InvalidInput);
  EXPECT_THROW((void)paper_from_text(""), InvalidInput);
}

// What is drawn beyond the paper is seen to be: a line 2 mm from its lower edge, a word over its right one.
TEST(Paper, IsSeenToBeLeft) {
  const test::TemporaryFolder folder;
  PdfDocument pdf("edges", Paper::Letter);
  pdf.add_page();
  pdf.text(100, 100, "word");
  pdf.add_page();
  pdf.text(100, 100, "word");
  pdf.line(100, pdf.height_mm() - 2, 110, pdf.height_mm() - 2, 0.5);
  pdf.add_page();
  pdf.text(pdf.width_mm() - 2, 100, "word");
  pdf.save(folder / "edges.pdf");
  const auto pages = test::pages_of(folder / "edges.pdf");
  ASSERT_EQ(pages.size(), 3U);
  EXPECT_TRUE(pages[0].has_empty_edge && pages[0].words_lie_within(10));
  EXPECT_TRUE(!pages[1].has_empty_edge && pages[1].words_lie_within(10));
  EXPECT_FALSE(pages[2].words_lie_within(0));
}

}  // namespace arthronaut::report
