#include "navigation/guidance/drill_evidence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "planning/geometry/error.h"

namespace arthronaut::guidance {
namespace {

tunnels::Tunnel plan() {
  tunnels::Tunnel tunnel;
  tunnel.entry_mm = {3, 4, 5};
  tunnel.direction = Eigen::Vector3d(-1, 0.2, 0.5).normalized();
  return tunnel;
}

// Frames at 60 a second, or as many as are asked for.
class Frames {
 public:
  explicit Frames(double per_second = 60) : step_ns_(std::llround(1e9 / per_second)) {}
  // Stamps the numbers.
  void add(DrillEvidence& evidence, GuidanceNumbers& numbers) {
    numbers.timestamp_ns = now_ns_ += step_ns_;
    evidence.add(numbers);
  }
  void add(DrillEvidence& evidence, GuidanceNumbers&& numbers) { add(evidence, numbers); }

 private:
  std::int64_t step_ns_, now_ns_ = 0;
};

// A guide whose end stands `depth_mm` beyond the entry along the plan, on the line through `entry`.
GuidanceNumbers guide_at(double depth_mm, const Eigen::Vector3d& entry, const Eigen::Vector3d& direction) {
  GuidanceNumbers pose;
  pose.state = GuidanceState::Valid;
  pose.guide_direction = direction;
  const Eigen::Vector3d along = plan().direction;
  pose.guide_point_mm =
      entry + (depth_mm - (entry - plan().entry_mm).dot(along)) / direction.dot(along) * direction;
  pose.depth_mm = depth_mm;
  pose.tip_to_entry_mm = (pose.guide_point_mm - plan().entry_mm).norm();
  pose.sigma_offset_mm = 0.5;
  return pose;
}

// A guide held 1.5 mm beside the plan that leans is found again, from noisy poses, with those of the way in
// left out; 0.1 mm is three times the noise of a median over 60 poses.
TEST(DrillEvidence, FindsTheAxisOfTheGuideOnTheBone) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 0.1);
  const Eigen::Vector3d entry = plan().entry_mm + plan().direction.unitOrthogonal() * 1.5;
  const Eigen::Vector3d direction = (plan().direction + Eigen::Vector3d(0, 0.03, 0.01)).normalized();
  DrillEvidence evidence(plan());
  Frames frames;
  for (double depth = -10; depth < -0.5; depth += 0.5)
    frames.add(evidence, guide_at(depth, entry + Eigen::Vector3d(1, 1, 1), direction));
  for (int i = 0; i < 60; ++i)
    frames.add(evidence, guide_at(0.2, entry + Eigen::Vector3d(noise(random), noise(random), noise(random)),
                                  direction));
  const DrillEvidenceSummary summary = evidence.summary();
  ASSERT_TRUE(summary.is_usable()) << to_text(summary.outcome);
  EXPECT_FALSE(summary.is_of_drill);
  EXPECT_GE(summary.pose_count, 60);
  EXPECT_NEAR(summary.depth_mm, 0.2, 0.01);
  const Eigen::Vector3d miss = summary.entry_mm - entry;
  EXPECT_LT((miss - miss.dot(direction) * direction).norm(), 0.1);
  EXPECT_LT(geometry::angle_between_rad(summary.direction, direction), 1e-9);
  EXPECT_NEAR(summary.spread_mm, 0.14, 0.06);  // 0.1 mm in each of two coordinates
  EXPECT_EQ(summary.sigma_offset_mm, 0.5);
}

// A guide that hovered, however long and however well aimed, drilled nothing that anybody saw.
TEST(DrillEvidence, Hazard29TheGuideNeverTouchedTheBone) {
  DrillEvidence evidence(plan());
  Frames frames;
  EXPECT_EQ(evidence.summary().outcome, EvidenceOutcome::NoGuidance);
  for (int i = 0; i < 500; ++i) frames.add(evidence, guide_at(-4, plan().entry_mm, plan().direction));
  EXPECT_EQ(evidence.summary().outcome, EvidenceOutcome::NeverTouched);
  EXPECT_NEAR(evidence.summary().nearest_mm, 4, 1e-9);
}

// As deep as the bone but 9 mm beside the entry: the plane through the entry is not bone.
TEST(DrillEvidence, Hazard29DeepEnoughBesideTheEntryIsNoEvidence) {
  DrillEvidence evidence(plan());
  Frames frames;
  const Eigen::Vector3d beside = plan().entry_mm + 9 * plan().direction.unitOrthogonal();
  for (int i = 0; i < 500; ++i) frames.add(evidence, guide_at(0, beside, plan().direction));
  EXPECT_EQ(evidence.summary().outcome, EvidenceOutcome::BesideEntry);
}

// A guide's end 20 mm inside the bone is not where a guide can be.
TEST(DrillEvidence, Hazard29AGuideInsideTheBoneIsNoEvidence) {
  DrillEvidence evidence(plan());
  Frames frames;
  for (int i = 0; i < 500; ++i) frames.add(evidence, guide_at(20, plan().entry_mm, plan().direction));
  EXPECT_EQ(evidence.summary().outcome, EvidenceOutcome::NeverTouched);
}

// A third of a second on the bone is a touch, and half a second of standing there is not, however many
// pictures a second there are; what is not valid does not count.
TEST(DrillEvidence, Hazard29AShortTouchIsNoEvidence) {
  for (const double per_second : {120.0, 60.0, 30.0, 10.0}) {
    SCOPED_TRACE(per_second);
    DrillEvidence evidence(plan());
    Frames frames(per_second);
    GuidanceNumbers stands = guide_at(0, plan().entry_mm, plan().direction);
    GuidanceNumbers lost;
    lost.state = GuidanceState::GuideLost;
    frames.add(evidence, lost);
    const int third = static_cast<int>(per_second / 3), rest = static_cast<int>(std::ceil(per_second / 5));
    for (int i = 0; i < third; ++i) frames.add(evidence, stands);
    for (int i = 0; i < 500; ++i) frames.add(evidence, lost);
    EXPECT_EQ(evidence.summary().outcome, EvidenceOutcome::TooShort);
    EXPECT_EQ(evidence.summary().pose_count, third);
    for (int i = 0; i < rest; ++i) frames.add(evidence, stands);
    EXPECT_TRUE(evidence.summary().is_usable());
    evidence.clear();
    EXPECT_EQ(evidence.summary().outcome, EvidenceOutcome::NoGuidance);
  }
}

// Where it was between two pictures that lie far apart nobody saw.
TEST(DrillEvidence, APoseStandsForNoLongerThanALostPicture) {
  DrillEvidence evidence(plan());
  Frames frames(0.5);
  for (int i = 0; i < 4; ++i) frames.add(evidence, guide_at(0, plan().entry_mm, plan().direction));
  EXPECT_EQ(evidence.summary().outcome, EvidenceOutcome::TooShort);
}

// What a record does not say of a drill's place is no place.
TEST(DrillEvidence, ADrillWhosePlaceIsNotKnownIsNoEvidence) {
  DrillEvidence evidence(plan());
  Frames frames;
  GuidanceNumbers numbers;
  numbers.state = GuidanceState::GuideLost;
  numbers.drill = drill_depth(plan(), 30, plan().entry_mm + 10 * plan().direction, plan().direction, 0.3);
  numbers.drill->lateral_mm = geometry::kNotKnown;
  for (int i = 0; i < 120; ++i) frames.add(evidence, numbers);
  EXPECT_EQ(evidence.summary().outcome, EvidenceOutcome::NoGuidance);
}

// A drill that is seen says more than its guide: the axis is its own, the depth its tip's.
TEST(DrillEvidence, TheDrillsOwnPosesCountFirst) {
  DrillEvidence evidence(plan());
  Frames frames;
  const Eigen::Vector3d leaning = (plan().direction + Eigen::Vector3d(0, 0.02, 0)).normalized();
  for (int i = 0; i <= 60; ++i) {
    GuidanceNumbers numbers = guide_at(0, plan().entry_mm, plan().direction);
    const double depth_mm = std::min(0.5 * i, 25.0);
    numbers.drill = drill_depth(plan(), 30, plan().entry_mm + depth_mm * leaning, leaning, 0.3);
    numbers.drill->sigma_offset_mm = 0.4;
    numbers.drill->sigma_angle_deg = 0.6;
    if (i % 2 == 1) numbers.state = GuidanceState::GuideLost;
    for (int k = 0; k < 3; ++k) frames.add(evidence, numbers);
  }
  const DrillEvidenceSummary summary = evidence.summary();
  ASSERT_TRUE(summary.is_usable());
  EXPECT_TRUE(summary.is_of_drill);
  EXPECT_NEAR(summary.depth_mm, 25, 0.1);
  EXPECT_LT(geometry::angle_between_rad(summary.direction, leaning), 1e-9);
  EXPECT_LT((summary.entry_mm - plan().entry_mm).norm(), 1e-6);
  EXPECT_EQ(summary.sigma_offset_mm, 0.4);
  EXPECT_EQ(summary.sigma_angle_deg, 0.6);
}

// An hour of it: the store stays as large as it was, and the answer is that of all of the time.
TEST(DrillEvidence, ADrillThatWasSeenTooShortlyIsNoWantOfGuidance) {
  DrillEvidence evidence(plan());
  Frames frames;
  GuidanceNumbers numbers;  // the guide is out of view
  numbers.drill = drill_depth(plan(), 30, plan().entry_mm + 10 * plan().direction, plan().direction, 0.3);
  for (int i = 0; i < 20; ++i) frames.add(evidence, numbers);
  const DrillEvidenceSummary summary = evidence.summary();
  EXPECT_EQ(summary.outcome, EvidenceOutcome::TooShort);
  EXPECT_TRUE(summary.is_of_drill);
  EXPECT_EQ(summary.pose_count, 20);
  // With a guide beside it that never came to the bone, what is said is of the guide alone.
  frames.add(evidence, guide_at(-10, plan().entry_mm, plan().direction));
  EXPECT_EQ(evidence.summary().outcome, EvidenceOutcome::NeverTouched);
  EXPECT_FALSE(evidence.summary().is_of_drill);
  EXPECT_EQ(evidence.summary().pose_count, 0);
}

TEST(DrillEvidence, ThinsItselfOut) {
  DrillEvidence evidence(plan());
  Frames frames;
  for (int i = 0; i < 100000; ++i)
    frames.add(evidence, guide_at(0.001 * (i % 7), plan().entry_mm, plan().direction));
  const DrillEvidenceSummary summary = evidence.summary();
  ASSERT_TRUE(summary.is_usable());
  EXPECT_LE(summary.pose_count, 2048);
  EXPECT_LT((summary.entry_mm - plan().entry_mm).norm(), 1e-9);
}

TEST(DrillEvidence, RefusesLimitsThatMakeNoSense) {
  DrillEvidenceLimits limits;
  limits.window_mm = 0;
  EXPECT_THROW(DrillEvidence(plan(), limits), InvalidInput);
}

}  // namespace
}  // namespace arthronaut::guidance
