#include "app/paint/paint_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/planning/painting/shapes.h"

namespace arthronaut::paint {
namespace {

using painting::Layer;
using testing::HasSubstr;
using widgets::Severity;

// From nothing to bones the next thing that is missing is named.
TEST(PaintWords, TheNextStepIsWhatIsMissing) {
  painting::Painting painting(
      std::make_shared<const images::Volume>(test::empty_volume({9, 9, 9}, {1, 1, 1})));
  const auto next = [&](Preview preview = Preview::None, bool works = false) {
    return next_step(painting, preview, works);
  };
  const auto stroke = [&](double x, std::uint8_t label) {
    painting.paint(Layer::Strokes, {{x, 4, 4}, {x, 4, 4}, Eigen::Vector3d::UnitZ(), {0.5, false}}, label, "",
                   false);
  };
  EXPECT_THAT(next(), HasSubstr("femur (1)"));
  stroke(1, painting::kFemur);
  EXPECT_THAT(next(), HasSubstr("tibia too (2)"));
  stroke(4, painting::kTibia);
  EXPECT_THAT(next(), HasSubstr("surrounds the bones (3)"));
  stroke(7, painting::kSurroundings);
  EXPECT_THAT(next(), HasSubstr("(G)"));
  EXPECT_THAT(next(Preview::Growth, true), HasSubstr("Growing"));
  EXPECT_THAT(next(Preview::Growth), HasSubstr("Enter"));
  EXPECT_THAT(next(Preview::Threshold), HasSubstr("threshold"));
  painting::Labels bones(729, painting::kNothing);
  bones[7] = painting::kFemur;
  painting.put(Layer::Bones, bones, "");
  EXPECT_THAT(next(), HasSubstr("(A)"));
  EXPECT_THAT(next_step(painting, Preview::None, false, false, true), HasSubstr("Wait for the surfaces"));
  painting.undo();
  painting.go_to(0);
  stroke(4, painting::kTibia);
  EXPECT_THAT(next(), HasSubstr("femur too"));
}

TEST(PaintWords, WhatCannotBePlannedOnIsDrawnSo) {
  using importing::QualityVerdict;
  EXPECT_EQ(severity_of(QualityVerdict::Good), Severity::Good);
  EXPECT_EQ(severity_of(QualityVerdict::Caution), Severity::Caution);
  EXPECT_EQ(severity_of(QualityVerdict::Bad), Severity::Bad);
  EXPECT_EQ(severity_of(QualityVerdict::NotChecked), Severity::Quiet) << "no tick";
}

}  // namespace
}  // namespace arthronaut::paint
