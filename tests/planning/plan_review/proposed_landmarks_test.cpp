#include "planning/plan_review/proposed_landmarks.h"

#include <gtest/gtest.h>

#include "planning/phantom/phantom_case.h"
#include "planning/plan_review/plan_review.h"

namespace arthronaut::plan_review {
namespace {

using bones::BoneKind;
using landmarks::LandmarkState;

cases::Case phantom() {
  return phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 2.5}), "test");
}

// A case of which a person placed the femur's landmarks: the tibia gets what its shape proposes, the femur
// keeps its own and nothing is asked of its shape.
TEST(ProposedLandmarks, GiveAGridWhereTheCaseHasNone) {
  cases::Case knee = phantom();
  const auto femur = knee.landmarks.at(BoneKind::Femur);
  knee.landmarks.erase(BoneKind::Tibia);
  EXPECT_FALSE(CaseReview(knee).bone(BoneKind::Tibia).surroundings.plateau);
  const auto proposed = propose_landmarks(knee, Proposing::WithoutGrid);
  ASSERT_EQ(proposed.size(), 1U);
  EXPECT_TRUE(proposed.at(BoneKind::Tibia).was_taken);
  EXPECT_TRUE(CaseReview(knee).bone(BoneKind::Tibia).surroundings.plateau);
  EXPECT_EQ(state_of_grid(knee, BoneKind::Tibia), LandmarkState::Proposed);
  EXPECT_EQ(knee.landmarks.at(BoneKind::Femur), femur);
  EXPECT_EQ(state_of_grid(knee, BoneKind::Femur), LandmarkState::Confirmed);
}

// A grid that nobody has looked at is proposed anew for whoever wants to compare, and stays as it was.
TEST(ProposedLandmarks, LeaveAGridThatIsThereAlone) {
  cases::Case knee = phantom();
  knee.landmark_states[BoneKind::Tibia]["plateau_medial"] = LandmarkState::Proposed;
  EXPECT_EQ(state_of_grid(knee, BoneKind::Tibia), LandmarkState::Proposed);
  const auto before = knee.landmarks;
  EXPECT_TRUE(propose_landmarks(knee, Proposing::WithoutGrid).empty());
  EXPECT_TRUE(knee.landmark_states.contains(BoneKind::Femur)) << "of which all are confirmed";
  const auto proposed = propose_landmarks(knee, Proposing::WithoutConfirmed);
  ASSERT_EQ(proposed.size(), 1U);
  EXPECT_FALSE(proposed.at(BoneKind::Tibia).was_taken);
  EXPECT_EQ(knee.landmarks, before);
}

}  // namespace
}  // namespace arthronaut::plan_review
