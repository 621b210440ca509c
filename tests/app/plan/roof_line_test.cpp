// Blumensaat's line by either convention, chosen and taken back.
#include "app/plan/roof_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/phantom/phantom_case.h"

namespace arthronaut::plan {
namespace {

using bones::BoneKind;
using testing::HasSubstr;

// Without landmarks of its own: all are proposed.
open_case::PlanModel proposed_model() {
  cases::Case knee = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 2}), "roof");
  knee.landmarks.clear();
  return open_case::PlanModel(std::move(knee));
}

TEST(RoofLine, IsLaidTheOtherWayAndBack) {
  open_case::PlanModel model = proposed_model();
  ASSERT_EQ(roof_line(model), RoofLine::Ends);
  EXPECT_THAT(roof_line_in_words(model), HasSubstr("from end to end of the roof"));
  const landmarks::Landmarks as_opened = model.landmarks(BoneKind::Femur);
  auto laid = with_other_roof(model);
  ASSERT_TRUE(laid);
  model.set_landmarks(BoneKind::Femur, laid->landmarks, laid->states);
  EXPECT_EQ(roof_line(model), RoofLine::Flat);
  EXPECT_THAT(roof_line_in_words(model), HasSubstr("along the flat of the roof"));
  // What the command line proposes by that convention.
  const auto flat = landmarks::propose(model.knee().bones.at(BoneKind::Femur).mesh, BoneKind::Femur,
                                       {.side = model.knee().side, .roof = landmarks::RoofConvention::Flat});
  ASSERT_EQ(flat.landmarks.size(), as_opened.size());
  for (const auto& [name, at] : flat.landmarks)
    EXPECT_LT((model.landmarks(BoneKind::Femur).at(name) - at).norm(), 1e-9) << name;
  laid = with_other_roof(model);
  ASSERT_TRUE(laid);
  EXPECT_EQ(laid->landmarks, as_opened);
}

// One that somebody moved is neither, and can be laid anew.
TEST(RoofLine, OfOneThatWasMovedByHandIsSaid) {
  open_case::PlanModel model = proposed_model();
  landmarks::Landmarks moved = model.landmarks(BoneKind::Femur);
  moved.at("blumensaat_anterior").z() += 1;
  model.set_landmarks(BoneKind::Femur, moved, model.landmark_states(BoneKind::Femur));
  EXPECT_EQ(roof_line(model), RoofLine::ByHand);
  EXPECT_THAT(roof_line_in_words(model), HasSubstr("laid by hand"));
  const auto laid = with_other_roof(model);
  ASSERT_TRUE(laid);
  EXPECT_EQ(laid->line, RoofLine::Ends);
  EXPECT_EQ(landmarks::state_of(laid->states, "blumensaat_anterior"), landmarks::LandmarkState::Proposed);
}

// A case that brings confirmed landmarks does not say how its line was laid.
TEST(RoofLine, OfConfirmedLandmarksIsNotGuessed) {
  const open_case::PlanModel model(
      phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "roof"));
  EXPECT_EQ(roof_line(model), RoofLine::NotKnown);
  EXPECT_FALSE(with_other_roof(model));
}

}  // namespace
}  // namespace arthronaut::plan
