#include "app/report/marker_sheet.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <opencv2/aruco.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "planning/geometry/error.h"
#include "tests/temporary_folder.h"

namespace arthronaut::report {

namespace {

constexpr double kDpi = 600;
constexpr double kMmPerPx = 25.4 / kDpi;

class MarkerSheet : public ::testing::Test {
 protected:
  std::filesystem::path file() const { return folder_ / "markers.pdf"; }

  // The page as a printer would see it.
  cv::Mat printed(int page) const {
    const std::string number = std::to_string(page);
    const std::string command = "pdftoppm -gray -r 600 -f " + number + " -l " + number +
                                " -singlefile -png " + file().string() + " " + (folder_ / "page").string();
    EXPECT_EQ(std::system(command.c_str()), 0);
    return cv::imread((folder_ / "page.png").string(), cv::IMREAD_GRAYSCALE);
  }

 private:
  const test::TemporaryFolder folder_;
};

}  // namespace

// What is printed carries the right ids at the right size: sides within 0.05 mm (about one pixel at 600 dpi).
TEST_F(MarkerSheet, MarkersHaveTheirIdAndTrueSize) {
  write_marker_sheet(file(), {.ids = {0, 2, 17}, .size_mm = 4.0});
  const cv::Mat page = printed(1);
  ASSERT_FALSE(page.empty());
  EXPECT_NEAR(page.cols * kMmPerPx, 210, 0.1);
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> ids;
  auto parameters = cv::aruco::DetectorParameters::create();
  parameters->minMarkerPerimeterRate = 0.01;  // 4 mm are small on a page of 297 mm
  parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
  cv::aruco::detectMarkers(page, cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50), corners, ids,
                           parameters);
  std::map<int, int> seen;
  cv::Point2f ruler[2];
  for (std::size_t i = 0; i < ids.size(); ++i) {
    ++seen[ids[i]];
    const double expected = ids[i] == 5 || ids[i] == 6 ? 2.89 : 4.0;
    for (int k = 0; k < 4; ++k) {
      EXPECT_NEAR(cv::norm(corners[i][k] - corners[i][(k + 1) % 4]) * kMmPerPx, expected, 0.05)
          << "id " << ids[i];
    }
    if (ids[i] == 5 || ids[i] == 6)
      ruler[ids[i] - 5] = 0.25f * (corners[i][0] + corners[i][1] + corners[i][2] + corners[i][3]);
  }
  EXPECT_EQ(seen[0], 6);
  EXPECT_EQ(seen[2], 6);
  EXPECT_EQ(seen[17], 6);
  EXPECT_EQ(seen[5], 1);
  EXPECT_EQ(seen[6], 1);
  EXPECT_NEAR(cv::norm(ruler[1] - ruler[0]) * kMmPerPx, 10.0, 0.05);
}

// Half of the checkerboard's area is black, and its squares measure what they should.
TEST_F(MarkerSheet, CheckerboardHasTrueSquares) {
  write_marker_sheet(file(), {.square_mm = 2.0});
  const cv::Mat page = printed(2);
  ASSERT_FALSE(page.empty());
  // The board's first row of squares, one pixel row through the middle: edges every 2 mm.
  const int y = static_cast<int>((42 + 1) / kMmPerPx);
  std::vector<double> edges_mm;
  for (int x = static_cast<int>(19 / kMmPerPx); x < static_cast<int>(60 / kMmPerPx); ++x) {
    if ((page.at<std::uint8_t>(y, x) < 128) != (page.at<std::uint8_t>(y, x + 1) < 128))
      edges_mm.push_back(x * kMmPerPx);
  }
  ASSERT_GT(edges_mm.size(), 10u);
  for (std::size_t i = 1; i < edges_mm.size(); ++i) EXPECT_NEAR(edges_mm[i] - edges_mm[i - 1], 2.0, 0.09);
}

TEST_F(MarkerSheet, RefusesWhatCannotBePrinted) {
  EXPECT_THROW(write_marker_sheet(file(), {.ids = {50}}), InvalidInput);
  EXPECT_THROW(write_marker_sheet(file(), {.size_mm = 0}), InvalidInput);
  EXPECT_THROW(write_marker_sheet(file(), {.ids = {1, 2, 3}, .size_mm = 95}), InvalidInput);
  EXPECT_THROW(write_marker_sheet("/nowhere/at/all/markers.pdf"), IoError);
  EXPECT_FALSE(std::filesystem::exists(file()));
}

}  // namespace arthronaut::report
