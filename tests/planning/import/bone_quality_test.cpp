#include "planning/import/bone_quality.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace arthronaut::importing {
namespace {

using ::testing::HasSubstr;

TEST(BoneQuality, IsGoodOnlyWhereNothingSpeaksAgainstIt) {
  BoneQuality quality;
  quality.labelled_ml = 100;
  quality.surface_ml = 99;
  quality.is_closed = true;
  quality.triangles = 1234;
  quality.beneath.outcome = segmentation::BoneBeneath::Outcome::Everywhere;
  const auto verdicts = [&] {
    std::vector<QualityVerdict> all;
    for (const QualityLine& line : quality_lines(quality)) all.push_back(line.verdict);
    return all;
  };
  EXPECT_THAT(verdicts(), testing::Each(QualityVerdict::Good));
  EXPECT_THAT(quality_lines(quality)[0].text, HasSubstr("99.0 ml, painted 100.0 ml"));
  quality.surface_ml = 94;  // an island was left out
  EXPECT_EQ(verdicts()[0], QualityVerdict::Caution);
  quality.surface_ml = 0;
  EXPECT_EQ(verdicts()[0], QualityVerdict::Caution);
  quality.is_closed = false;
  EXPECT_EQ(verdicts()[1], QualityVerdict::Bad);
  quality.edges_not_manifold = 2;
  EXPECT_EQ(verdicts()[2], QualityVerdict::Caution);
  quality.doubts = {"it has one condyle"};
  EXPECT_EQ(quality_lines(quality).back().text, "it has one condyle");
  EXPECT_EQ(verdicts().back(), QualityVerdict::Caution);
}

// A ragged surface is told, and stays with the bone.
TEST(BoneQuality, SaysThatASurfaceIsRough) {
  BoneQuality quality;
  quality.roughness_mm = 0.17;
  EXPECT_THAT(surface_doubts(quality), testing::IsEmpty());
  quality.roughness_mm = 0.63;
  EXPECT_THAT(surface_doubts(quality), testing::ElementsAre(HasSubstr("rough by 0.6 mm")));
  const auto lines = quality_lines(quality);
  const auto surface = std::ranges::find(lines, "Surface", &QualityLine::name);
  ASSERT_NE(surface, lines.end());
  EXPECT_EQ(surface->verdict, QualityVerdict::Caution);
}

// Soft tissue that was painted as bone is told with its size and place; where nobody could look it is no
// tick.
TEST(BoneQuality, SaysWhereNoBoneLiesBeneathTheSurface) {
  BoneQuality quality;
  const auto beneath = [&] {
    const auto lines = quality_lines(quality);
    return *std::ranges::find(lines, "Grey values", &QualityLine::name);
  };
  quality.beneath.reason = "too little of it";
  EXPECT_EQ(beneath().verdict, QualityVerdict::NotChecked);
  EXPECT_EQ(beneath().text, "not checked: too little of it");
  EXPECT_THAT(surface_doubts(quality), testing::IsEmpty());
  quality.beneath = {.outcome = segmentation::BoneBeneath::Outcome::NotEverywhere,
                     .area_cm2 = 12.3,
                     .reason = "behind, below"};
  EXPECT_EQ(beneath().verdict, QualityVerdict::Caution);
  EXPECT_THAT(beneath().text, testing::AllOf(HasSubstr("12 cm"), HasSubstr("behind")));
  EXPECT_THAT(surface_doubts(quality), testing::ElementsAre(beneath().text));
}

// Of an MR: what is dark about the surface, and how thick.
TEST(BoneQuality, SaysHowMuchCortexLiesOutside) {
  BoneQuality quality;
  EXPECT_THAT(quality_lines(quality),
              testing::Not(testing::Contains(testing::Field(&QualityLine::name, "Cortex"))));
  quality.cortex_outside_mm = 1.24;
  const auto lines = quality_lines(quality);
  const auto cortex = std::ranges::find(lines, "Cortex", &QualityLine::name);
  ASSERT_NE(cortex, lines.end());
  EXPECT_EQ(cortex->verdict, QualityVerdict::Caution);
  EXPECT_THAT(cortex->text, HasSubstr("1.2 mm"));
}

}  // namespace
}  // namespace arthronaut::importing
