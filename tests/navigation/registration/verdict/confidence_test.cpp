#include "navigation/registration/verdict/confidence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/navigation/registration/phantom_bone.h"

namespace arthronaut::registration {

namespace {

// The verdict on the right pose of a dry trial, which no other one rivals.
RegistrationSummary judged(const geometry::Vector6d& drift, double target_off_mm = 0) {
  const PhantomBone& bone = phantom_bone();
  const auto trial = bone.trial(experiments::TrialNoise::Dry, 1);
  const WeightedPoints points = choose_points(trial.curves, 800);
  PosePool pool(bone.prepared->data(), {});
  pool.add({{trial.marker_from_bone.inverse(), 1}}, points, 1);
  pool.refine_all(points, 12);
  const double white_noise_mm = white_noise_of(strokes::oriented_points(trial.curves));
  RegistrationOptions options;
  options.target_in_bone_mm = bone.target_mm + target_off_mm * Eigen::Vector3d::UnitZ();
  return summarise(
      bone.prepared->data(), pool,
      {trial.curves, points, strokes::smoothed_length_mm(trial.curves), white_noise_mm, {}, drift}, options);
}

}  // namespace

// What the pose is uncertain by beyond its points counts in every verdict that goes by the predicted error,
// and in the covariance: a shift of the whole bone is an error of that length at any target.
TEST(Confidence, JudgesByWhatTheCartilageLeavesUncertainToo) {
  constexpr double kShift_mm = 1.5;
  const RegistrationSummary sure = judged(geometry::Vector6d::Zero());
  const RegistrationSummary doubted = judged(kShift_mm * geometry::Vector6d::Unit(1));
  EXPECT_TRUE(sure.reliable) << testing::PrintToString(sure.reasons);
  EXPECT_FALSE(doubted.reliable);
  EXPECT_THAT(doubted.reasons, testing::Contains(testing::HasSubstr("does not hold the bone fast")));
  EXPECT_NEAR(doubted.predicted_tre_mm, std::hypot(sure.predicted_tre_mm, kShift_mm), 1e-9);
  EXPECT_NEAR(doubted.covariance(1, 1) - sure.covariance(1, 1), kShift_mm * kShift_mm, 1e-9);
  EXPECT_LT(doubted.evidence.log_odds, sure.evidence.log_odds);
}

// What is wrong with a target far along the shaft is not the strokes: they hold the bone, but not there.
TEST(Confidence, SaysThatTheTargetIsFarFromTheStrokes) {
  for (const double off_mm : {400.0, 1000.0}) {
    const RegistrationSummary far = judged(geometry::Vector6d::Zero(), off_mm);
    EXPECT_GT(far.predicted_tre_mm, kMaxError_mm) << off_mm;
    EXPECT_FALSE(far.reliable) << off_mm;
    EXPECT_THAT(far.reasons, testing::ElementsAre(testing::AllOf(testing::HasSubstr("the target lies"),
                                                                 testing::HasSubstr("touch nearer to it"))))
        << off_mm;
  }
}

// A loosely held pose is relied on where the mirror image fits far worse, and doubted where it nearly fits;
// one that is held fast is not. No lead over it mends a doubt that was there before.
TEST(Confidence, ALoosePoseNeedsALeadOverTheMirrorImage) {
  constexpr double kAmple = 18, kLittle = 3.5;
  RegistrationSummary fast = judged(geometry::Vector6d::Zero());
  judge_odds(fast, kLittle, kNeededLogOdds);
  EXPECT_TRUE(fast.reliable) << testing::PrintToString(fast.reasons);

  const RegistrationSummary loose = judged(0.8 * geometry::Vector6d::Unit(1));
  ASSERT_TRUE(loose.reliable) << testing::PrintToString(loose.reasons);
  RegistrationSummary ample = loose, little = loose;
  judge_odds(ample, kAmple, kNeededLogOdds);
  judge_odds(little, kLittle, kNeededLogOdds);
  EXPECT_TRUE(ample.reliable) << testing::PrintToString(ample.reasons);
  EXPECT_FALSE(little.reliable);
  EXPECT_THAT(little.reasons, testing::ElementsAre(testing::HasSubstr("fit another bone too")));
  EXPECT_LT(little.evidence.log_odds, ample.evidence.log_odds);
  RegistrationSummary drawn = loose;
  judge_odds(drawn, kAmple, kNeededLogOddsWhileDrawing);
  EXPECT_FALSE(drawn.reliable) << drawn.evidence.log_odds;

  RegistrationSummary doubted = judged(1.5 * geometry::Vector6d::Unit(1));
  const std::vector<std::string> reasons = doubted.reasons;
  judge_odds(doubted, kAmple, kNeededLogOdds);
  EXPECT_FALSE(doubted.reliable);
  EXPECT_EQ(doubted.reasons, reasons);
}

}  // namespace arthronaut::registration
