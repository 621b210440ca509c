// How good the numbers are: worse at once, better only once it stays so.
#include "navigation/operation/guidance_grades.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/navigation/operation/operation_rules.h"

namespace arthronaut::operation {
namespace {

using OperationRules = test::OperationRules;

constexpr std::int64_t kPicture_ns = 1'000'000'000 / 60;

class GradesTest : public ::testing::Test {
 protected:
  void SetUp() override { numbers_.state = guidance::GuidanceState::Valid; }
  GuidanceGrades show(double offset_mm, double angle_deg = 0.5) {
    numbers_.offset_mm = offset_mm;
    numbers_.angle_deg = angle_deg;
    held_.add(numbers_, now_ns_ += kPicture_ns);
    return held_.grades();
  }
  guidance::GuidanceNumbers numbers_;
  HeldGrades held_;
  std::int64_t now_ns_ = 0;
};

TEST_F(GradesTest, FollowTheThresholds) {
  const auto of = [&](double offset_mm, double sigma_mm, double angle_deg, double sigma_deg) {
    numbers_.offset_mm = offset_mm;
    numbers_.sigma_offset_mm = sigma_mm;
    numbers_.angle_deg = angle_deg;
    numbers_.sigma_angle_deg = sigma_deg;
    return grades_of(numbers_);
  };
  EXPECT_EQ(of(0.99, 0.5, 1.99, 1).offset, Grade::Good);
  EXPECT_EQ(of(0.99, 0.5, 1.99, 1).angle, Grade::Good);
  EXPECT_EQ(of(1, 0.5, 2, 1).offset, Grade::Caution);
  EXPECT_EQ(of(1, 0.5, 2, 1).angle, Grade::Caution);
  EXPECT_EQ(of(0.1, 1, 0.1, 2).offset, Grade::Caution) << "known to no better";
  EXPECT_EQ(of(2, 0.1, 4, 0.1).offset, Grade::Bad);
  EXPECT_EQ(of(2, 0.1, 4, 0.1).angle, Grade::Bad);
  EXPECT_EQ(of(0.1, std::numeric_limits<double>::quiet_NaN(), 0, 0).offset, Grade::Bad);
}

// A number that trembles about its limit stays amber; none of what is worse waits for a single picture.
TEST_F(GradesTest, NoFlickerAndNothingWorseWaits) {
  ASSERT_EQ(show(0.5).offset, Grade::Good);
  EXPECT_EQ(show(1.05).offset, Grade::Caution) << "at once";
  for (int i = 0; i < 120; ++i) {
    ASSERT_EQ(show(i % 2 == 0 ? 0.95 : 1.05).offset, Grade::Caution) << i;
    ASSERT_EQ(held_.grades().angle, Grade::Good) << "the other one is by itself";
  }
  EXPECT_EQ(show(2.1).offset, Grade::Bad) << "at once";
  EXPECT_EQ(show(0.5, 4.5).angle, Grade::Bad);
  int pictures = 0;
  while (show(0.5).offset != Grade::Good && pictures < 1000) ++pictures;
  EXPECT_NEAR(pictures * kPicture_ns, HeldGrades::kHolds_ns, 2 * kPicture_ns);
}

// A guide that is lost for a moment comes back as it was seen; of a picture without numbers nothing is said.
TEST_F(GradesTest, ALostPictureHasNone) {
  (void)show(1.5);
  numbers_.state = guidance::GuidanceState::GuideLost;
  EXPECT_EQ(show(0.5).offset, Grade::None);
  numbers_.state = guidance::GuidanceState::Valid;
  EXPECT_EQ(show(0.5).offset, Grade::Caution);
  now_ns_ += HeldGrades::kHolds_ns;
  EXPECT_EQ(show(0.5).offset, Grade::Good);
}

TEST_F(GradesTest, OfOtherNumbersNothingIsHeld) {
  ASSERT_EQ(show(5).offset, Grade::Bad);
  held_.on_other_numbers();
  EXPECT_EQ(held_.grades().offset, Grade::None);
  EXPECT_EQ(show(0.5).offset, Grade::Good);
}

// What the whole operation says: with the numbers, and gone with them.
TEST_F(OperationRules, GradesComeAndGoWithTheNumbers) {
  give();
  EXPECT_EQ(run_.state()->grades.offset, Grade::None);
  run_.show_guide(-4);
  EXPECT_EQ(run_.state()->grades.offset, Grade::Good);
  run_.apply(MarkerPlacedAnew{});
  EXPECT_EQ(run_.state()->grades.offset, Grade::None);
}

}  // namespace
}  // namespace arthronaut::operation
