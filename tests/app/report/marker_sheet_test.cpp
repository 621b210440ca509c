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
  cv::Mat printed(int page, const std::string& how = "-r 600") const {
    const std::string number = std::to_string(page);
    const std::string command = "pdftoppm -gray " + how + " -f " + number + " -l " + number +
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

// Every edge between the cells of a code, along the middle of each row and column, within 0.01 mm.
TEST_F(MarkerSheet, EdgesOfTheCodeLieWhereTheyBelong) {
  constexpr double kPxPerMm = 100;
  constexpr double kSize_mm = 30, kX_mm = 40, kMargin_mm = 2;
  constexpr int kCells = 6;
  write_marker_sheet(file(), {.ids = {0, 3}, .size_mm = kSize_mm});
  for (const auto& [id, y_mm] : std::map<int, double>{{0, 42}, {3, 42 + 53}}) {
    const int side_px = static_cast<int>((kSize_mm + 2 * kMargin_mm) * kPxPerMm);
    const cv::Mat seen = printed(1, "-r 2540 -x " + std::to_string(int((kX_mm - kMargin_mm) * kPxPerMm)) +
                                        " -y " + std::to_string(int((y_mm - kMargin_mm) * kPxPerMm)) +
                                        " -W " + std::to_string(side_px) + " -H " + std::to_string(side_px));
    ASSERT_EQ(seen.rows, side_px);
    cv::Mat cells;
    cv::aruco::getPredefinedDictionary(cv::aruco::DICT_4X4_50)->drawMarker(id, kCells, cells, 1);
    for (const bool is_row : {true, false}) {
      const cv::Mat page = is_row ? seen : cv::Mat(seen.t());
      const cv::Mat code = is_row ? cells : cv::Mat(cells.t());
      for (int line = 0; line < kCells; ++line) {
        std::vector<double> expected_mm, edges_mm;
        for (int at = 0; at <= kCells; ++at) {
          const auto is_black = [&](int cell) {
            return cell >= 0 && cell < kCells && code.at<std::uint8_t>(line, cell) == 0;
          };
          if (is_black(at - 1) != is_black(at)) expected_mm.push_back(at * kSize_mm / kCells);
        }
        const int y = static_cast<int>((kMargin_mm + (line + 0.5) * kSize_mm / kCells) * kPxPerMm);
        for (int x = 1; x < page.cols; ++x)
          if ((page.at<std::uint8_t>(y, x - 1) < 128) != (page.at<std::uint8_t>(y, x) < 128))
            edges_mm.push_back(x / kPxPerMm - kMargin_mm);
        ASSERT_EQ(edges_mm.size(), expected_mm.size())
            << "id " << id << (is_row ? " row " : " column ") << line;
        for (std::size_t i = 0; i < edges_mm.size(); ++i)
          EXPECT_NEAR(edges_mm[i], expected_mm[i], 0.0101)
              << "id " << id << (is_row ? " row " : " column ") << line;
      }
    }
  }
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
  EXPECT_THROW(write_marker_sheet(file(), {.ruler_size_mm = 100, .ruler_distance_mm = 100}), InvalidInput);
  EXPECT_THROW(
      write_marker_sheet(file(),
                         {.ids = {0, 1, 2, 3}, .size_mm = 24, .ruler_size_mm = 60, .ruler_distance_mm = 70}),
      InvalidInput);
  EXPECT_THROW(write_marker_sheet("/nowhere/at/all/markers.pdf"), IoError);
  EXPECT_FALSE(std::filesystem::exists(file()));
}

}  // namespace arthronaut::report
