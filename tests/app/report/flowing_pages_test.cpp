#include "app/report/flowing_pages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "planning/files/atomic_file.h"
#include "tests/app/report/page_edges.h"
#include "tests/temporary_folder.h"

namespace arthronaut::report {
namespace {

class FlowingPagesTest : public ::testing::Test {
 protected:
  // "row0 row1 ...": more than a page of them.
  static std::string words(const std::string& word) {
    std::string text;
    for (int i = 0; i < kWords; ++i) text += word + std::to_string(i) + " ";
    return text;
  }
  // All of the words are there, above the foot; without a break within, since they are found whole.
  void expect_whole(const std::vector<std::string>& expected) {
    constexpr double kFoot_mm = 15;
    constexpr int kFootWords = 11;
    pdf_.save(file());
    for (const test::Page& page : test::pages_of(file())) {
      EXPECT_TRUE(page.words_lie_within(10)) << page.outermost;
      EXPECT_EQ(std::ranges::count_if(page.above_bottom_mm, [](double mm) { return mm < kFoot_mm; }),
                kFootWords);
    }
    const auto text_file = folder_ / "text.txt";
    ASSERT_EQ(std::system(("pdftotext -raw " + file().string() + " " + text_file.string()).c_str()), 0);
    std::string text = files::read_text(text_file);
    std::ranges::replace(text, '\n', ' ');
    for (const std::string& word : expected)
      for (int i = 0; i < kWords; ++i)
        EXPECT_NE(text.find(word + std::to_string(i) + " "), std::string::npos) << word << i;
  }
  std::filesystem::path file() const { return folder_ / "pages.pdf"; }

  const test::TemporaryFolder folder_;
  PdfDocument pdf_{"Pages"};
  FlowingPages pages_{pdf_, "Foot"};

 private:
  static constexpr int kWords = 1500;
};

// It was written on over the foot and out of the page, and the newest alarms of a session were lost.
TEST_F(FlowingPagesTest, ARowHigherThanAPageGoesOnOnTheNext) {
  pages_.begin_page("Title");
  pages_.table({70, 100},
               {{"Name", "Text"}, {"before", "short"}, {"high", words("row")}, {"after", "last0 "}});
  expect_whole({"row"});
}

TEST_F(FlowingPagesTest, ASentenceHigherThanAPageGoesOnOnTheNext) {
  pages_.begin_page("Title");
  pages_.sentence("One that is short.");
  pages_.sentence(words("said"));
  pages_.sentence("Another one.");
  expect_whole({"said"});
}

}  // namespace
}  // namespace arthronaut::report
