#include "planning/plan_review/landmark_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/landmarks/off_shape.h"

namespace arthronaut::plan_review {
namespace {

using bones::BoneKind;
using Eigen::Vector3d;
using landmarks::LandmarkState;
using ::testing::HasSubstr;
using Verdict = tunnels::PlanCheck::Verdict;

// What a shape would give, by hand: the check asks nothing of how it came about.
landmarks::Proposal by_shape() {
  landmarks::Proposal proposal;
  proposal.outcome = landmarks::Proposal::Outcome::Proposed;
  proposal.landmarks = {{"blumensaat_anterior", {0, 0, 0}}, {"notch_apex", {0, 20, 5}}};
  proposal.by_other_roof = {{"blumensaat_anterior", {0, 0, 8}}};
  return proposal;
}

tunnels::PlanCheck checked(const landmarks::Landmarks& marks, const landmarks::LandmarkStates& states = {}) {
  const landmarks::Proposal proposal = by_shape();
  return check_landmarks(BoneKind::Femur, marks, states, &proposal);
}

TEST(LandmarkCheck, SaysTheFurthestAndItsPlace) {
  const auto check = checked({{"blumensaat_anterior", {3, 0, 0}}, {"notch_apex", {0, 20, 17.5}}});
  EXPECT_EQ(check.verdict, Verdict::Look);
  EXPECT_DOUBLE_EQ(check.value.value(), 12.5);
  EXPECT_EQ(check.unit, "mm");
  EXPECT_EQ(check.greatest, landmarks::kFarFromShape_mm);
  EXPECT_EQ(check.at_mm, Vector3d(0, 20, 17.5));
  EXPECT_EQ(check.text, "Notch, apex: 12.5 mm from where the bone's shape puts it");
  EXPECT_EQ(landmark_doubt(check), "Landmarks: " + check.text);
  EXPECT_THAT(checked({{"blumensaat_anterior", {0, -11, 0}}, {"notch_apex", {0, 20, 17.5}}}).text,
              HasSubstr("and 1 more further than 10 mm"));
}

// A tenth of a millimetre either side of the limit; the words and the limit do not contradict each other.
TEST(LandmarkCheck, TheLimitItselfIsFine) {
  EXPECT_EQ(checked({{"notch_apex", {0, 20, 15}}}).verdict, Verdict::Fine);
  EXPECT_EQ(checked({{"notch_apex", {0, 20, 15.1}}}).verdict, Verdict::Look);
  EXPECT_EQ(checked({{"notch_apex", {0, 20, 14.9}}}).verdict, Verdict::Fine);
  EXPECT_FALSE(landmark_doubt(checked({{"notch_apex", {0, 20, 14.9}}})));
}

// Blumensaat's line may be laid either way: neither is a slip.
TEST(LandmarkCheck, EitherConventionOfBlumensaatsLineIsTheShapes) {
  EXPECT_DOUBLE_EQ(checked({{"blumensaat_anterior", {0, 0, 14}}}).value.value(), 6);
}

// The posterior end gives the line's direction: along the line it may lie anywhere.
TEST(LandmarkCheck, OfThePosteriorEndWhatLiesAcrossTheLineCounts) {
  landmarks::Proposal proposal = by_shape();
  proposal.landmarks["blumensaat_posterior"] = {0, 30, 0};
  const auto value = [&](const Vector3d& at) {
    return *check_landmarks(BoneKind::Femur, {{"blumensaat_posterior", at}}, {}, &proposal).value;
  };
  EXPECT_DOUBLE_EQ(value({0, 45, 0}), 0);
  EXPECT_DOUBLE_EQ(value({3, 12, 4}), 5);
}

// The shape held against itself is no tick, and far off it is amiss whoever looked at it.
TEST(LandmarkCheck, WhatNobodyConfirmedIsNoTick) {
  const landmarks::LandmarkStates proposed{{"notch_apex", LandmarkState::Proposed}};
  EXPECT_EQ(checked({{"notch_apex", {0, 20, 5}}}, proposed).verdict, Verdict::Note);
  EXPECT_EQ(checked({{"notch_apex", {0, 60, 5}}}, proposed).verdict, Verdict::Look);
  // The ligament's own insertion, which somebody saw, is none of the shape's.
  EXPECT_EQ(checked({{"notch_apex", {0, 20, 5}}, {"native_footprint", {0, 0, 0}}}, proposed).verdict,
            Verdict::Note);
}

TEST(LandmarkCheck, WithoutTheShapesOwnNothingIsChecked) {
  const landmarks::Landmarks marks{{"notch_apex", {0, 60, 5}}};
  const landmarks::Proposal none;
  EXPECT_EQ(check_landmarks(BoneKind::Femur, marks, {}, nullptr).verdict, Verdict::NotChecked);
  EXPECT_EQ(check_landmarks(BoneKind::Femur, marks, {}, &none).verdict, Verdict::NotChecked);
  EXPECT_EQ(checked({}).verdict, Verdict::NotChecked);
  EXPECT_EQ(checked({{"native_footprint", {0, 60, 5}}}).verdict, Verdict::NotChecked);
}

}  // namespace
}  // namespace arthronaut::plan_review
