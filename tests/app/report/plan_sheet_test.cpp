// The plan on one sheet, as it is printed.
#include <algorithm>
#include <cstdio>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "planning/landmarks/anatomical_axes.h"
#include "tests/app/report/reported_case.h"

namespace arthronaut::report {
namespace {

constexpr double kPx_per_mm = 150 / 25.4;
constexpr double kSlice_mm = 40.25, kAboveCaption_mm = 3.5;

struct Word {
  double left_mm = 0, top_mm = 0, bottom_mm = 0;
  std::string text;
};

class PlanSheet : public Report {
 protected:
  // Of the case as it is now: the sheet's words, and what is to be seen on it.
  void write_sheet() {
    cases::save_case(knee_folder(), knee_);
    write(pdf());
    const std::string base = (knee_folder().parent_path() / "sheet").string();
    ASSERT_EQ(std::system(("pdftotext -f 2 -l 2 -bbox " + pdf().string() + " " + base).c_str()), 0);
    std::istringstream lines(files::read_text(base));
    for (std::string line; std::getline(lines, line);) {
      Word word;
      double right = 0;
      if (std::sscanf(line.c_str(), " <word xMin=\"%lf\" yMin=\"%lf\" xMax=\"%lf\" yMax=\"%lf\"",
                      &word.left_mm, &word.top_mm, &right, &word.bottom_mm) != 4)
        continue;
      for (double* value : {&word.left_mm, &word.top_mm, &word.bottom_mm}) *value *= 25.4 / 72;
      const auto from = line.find("\">") + 2;
      word.text = line.substr(from, line.rfind("</") - from);
      words_.push_back(word);
    }
    ASSERT_EQ(
        std::system(("pdftoppm -r 150 -f 2 -l 2 -singlefile -png " + pdf().string() + " " + base).c_str()),
        0);
    sheet_ = cv::imread(base + ".png");
    ASSERT_FALSE(sheet_.empty());
  }
  // Top and left of the slices whose caption begins so, from left to right.
  std::vector<cv::Point2d> slices(const std::string& caption) const {
    std::vector<cv::Point2d> places;
    for (const Word& word : words_)
      if (word.text == caption)
        places.emplace_back(word.left_mm, word.bottom_mm - kAboveCaption_mm - kSlice_mm);
    return places;
  }
  // Over how many rows of a slice the plan's lines are drawn.
  double plan_height_mm(const cv::Point2d& slice) const {
    const cv::Rect place(cv::Point(slice * kPx_per_mm), cv::Size2d(kSlice_mm, kSlice_mm) * kPx_per_mm);
    const cv::Mat inside = sheet_(place);
    cv::Mat is_plan, rows;
    cv::inRange(inside, cv::Scalar(190, 120, 0), cv::Scalar(255, 200, 110), is_plan);
    cv::findNonZero(is_plan, rows);
    if (rows.empty()) return 0;
    double least = 0, most = 0;
    cv::Mat xy[2];
    cv::split(rows, xy);
    cv::minMaxLoc(xy[1], &least, &most);
    return (most - least) / kPx_per_mm;
  }

  std::vector<Word> words_;

 private:
  cv::Mat sheet_;
};

// Of a side that ends beyond the slice nothing was drawn.
TEST_F(PlanSheet, ATunnelLongerThanItsSliceIsDrawnToTheBorder) {
  auto& tunnel = knee_.plan.tunnels.at(bones::BoneKind::Tibia);
  const auto axes = landmarks::anatomical_axes(bones::BoneKind::Tibia, knee_.side,
                                               knee_.landmarks.at(bones::BoneKind::Tibia),
                                               knee_.bones.at(bones::BoneKind::Tibia).mesh);
  const geometry::Surface tibia(knee_.bones.at(bones::BoneKind::Tibia).mesh);
  tunnel.entry_mm = tunnels::entry_on_bone(tunnel, tunnels::measure(tunnel, tibia));
  tunnel.direction = -axes.proximal;
  ASSERT_GT(tunnels::measure(tunnel, tibia).length_mm, 58);
  write_sheet();
  const auto places = slices("tibia,");
  ASSERT_EQ(places.size(), 2U);
  for (const cv::Point2d& place : places) EXPECT_GT(plan_height_mm(place), 31);
}

// The caption of the plateau lay under the slices where no lateral view with a longer one stands beside it.
TEST_F(PlanSheet, SlicesBeginBelowThePlateausCaption) {
  std::erase_if(knee_.bones, [](const auto& bone) { return bone.first == bones::BoneKind::Femur; });
  std::erase_if(knee_.plan.tunnels,
                [](const auto& tunnel) { return tunnel.first == bones::BoneKind::Femur; });
  std::filesystem::remove_all(knee_folder());
  write_sheet();
  const auto places = slices("tibia,");
  ASSERT_EQ(places.size(), 2U);
  const auto last = std::ranges::find(words_, "medial", &Word::text);
  ASSERT_NE(last, words_.end());
  EXPECT_LT(last->bottom_mm, places.front().y);
}

}  // namespace
}  // namespace arthronaut::report
