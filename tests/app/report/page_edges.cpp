#include "tests/app/report/page_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "planning/files/atomic_file.h"
#include "tests/temporary_folder.h"

namespace arthronaut::test {

namespace {

constexpr double kDpi = 50, kEdge_mm = 5, kMm_per_pt = 25.4 / 72;

bool is_empty_at_the_edge(const std::filesystem::path& picture) {
  const cv::Mat grey = cv::imread(picture.string(), cv::IMREAD_GRAYSCALE);
  if (grey.empty()) return false;
  const int edge = static_cast<int>(kEdge_mm / 25.4 * kDpi);
  const cv::Mat sides[] = {grey.rowRange(0, edge), grey.rowRange(grey.rows - edge, grey.rows),
                           grey.colRange(0, edge), grey.colRange(grey.cols - edge, grey.cols)};
  return std::all_of(std::begin(sides), std::end(sides),
                     [](const cv::Mat& side) { return cv::countNonZero(side < 250) == 0; });
}

}  // namespace

std::vector<Page> pages_of(const std::filesystem::path& pdf) {
  const TemporaryFolder folder;
  const auto words = folder / "words.html";
  EXPECT_EQ(std::system(("pdftotext -bbox " + pdf.string() + " " + words.string()).c_str()), 0);
  EXPECT_EQ(
      std::system(
          ("pdftoppm -r 50 -gray " + pdf.string() + " " + (folder / "p").string() + " 2>/dev/null").c_str()),
      0);
  std::vector<std::filesystem::path> pictures;
  for (const auto& entry : std::filesystem::directory_iterator(words.parent_path()))
    if (entry.path().extension() == ".pgm") pictures.push_back(entry.path());
  std::sort(pictures.begin(), pictures.end());
  std::vector<Page> pages;
  std::istringstream lines(files::read_text(words));
  for (std::string line; std::getline(lines, line);) {
    Page page;
    if (std::sscanf(line.c_str(), " <page width=\"%lf\" height=\"%lf\"", &page.width_pt, &page.height_pt) ==
        2)
      pages.push_back(page);
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    if (pages.empty() ||
        std::sscanf(line.c_str(), " <word xMin=\"%lf\" yMin=\"%lf\" xMax=\"%lf\" yMax=\"%lf\"", &x0, &y0, &x1,
                    &y1) != 4)
      continue;
    Page& last = pages.back();
    ++last.words;
    last.above_bottom_mm.push_back(kMm_per_pt * (last.height_pt - y1));
    const double distance_mm = kMm_per_pt * std::min({x0, y0, last.width_pt - x1, last.height_pt - y1});
    if (distance_mm < last.least_distance_mm) {
      last.least_distance_mm = distance_mm;
      last.outermost = line;
    }
  }
  EXPECT_EQ(pictures.size(), pages.size());
  for (std::size_t i = 0; i < pages.size() && i < pictures.size(); ++i)
    pages[i].has_empty_edge = is_empty_at_the_edge(pictures[i]);
  return pages;
}

}  // namespace arthronaut::test
