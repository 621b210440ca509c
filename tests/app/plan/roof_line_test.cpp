// Blumensaat's line by either convention, chosen and taken back.
#include "app/plan/roof_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

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
  EXPECT_EQ(roof_line(model), RoofLine::Neither);
  EXPECT_THAT(roof_line_in_words(model), HasSubstr("by neither convention"));
  const auto laid = with_other_roof(model);
  ASSERT_TRUE(laid);
  EXPECT_EQ(laid->line, RoofLine::Ends);
  EXPECT_EQ(landmarks::state_of(laid->states, "blumensaat_anterior"), landmarks::LandmarkState::Proposed);
}

// Waits for what goes on beside the model; the first who asks begins it.
RoofLine roof_line_when_known(const open_case::PlanModel& model) {
  for (int i = 0; i < 2'000 && roof_line(model) == RoofLine::NotKnown; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return roof_line(model);
}

// Confirmed, saved and opened again it is still the one that was chosen, and can be laid the other way.
TEST(RoofLine, OfConfirmedLandmarksIsKnownWhenOpenedAgain) {
  const open_case::PlanModel first = proposed_model();
  const auto flat = with_other_roof(first);
  ASSERT_TRUE(flat);
  for (const auto& [marks, line] : {std::pair{first.landmarks(BoneKind::Femur), RoofLine::Ends},
                                    std::pair{flat->landmarks, RoofLine::Flat}}) {
    cases::Case knee = first.knee();
    knee.landmarks[BoneKind::Femur] = marks;
    for (const auto& [name, at] : marks)
      knee.landmark_states[BoneKind::Femur][name] = landmarks::LandmarkState::Confirmed;
    const open_case::PlanModel again(std::move(knee));
    EXPECT_EQ(roof_line_when_known(again), line);
    EXPECT_TRUE(with_other_roof(again));
  }
}

// A case that brings landmarks from elsewhere does not say how its line was laid.
TEST(RoofLine, OfLandmarksFromElsewhereIsNotGuessed) {
  const open_case::PlanModel model(
      phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "roof"));
  EXPECT_EQ(roof_line(model), RoofLine::NotKnown) << "opening a case waits for no proposal";
  EXPECT_THAT(roof_line_in_words(model), HasSubstr("as its landmarks lie"));
  EXPECT_EQ(roof_line_when_known(model), RoofLine::Neither);
  EXPECT_THAT(roof_line_in_words(model), HasSubstr("by neither convention"));
}

}  // namespace
}  // namespace arthronaut::plan
