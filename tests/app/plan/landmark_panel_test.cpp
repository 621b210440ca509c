#include "app/plan/landmark_panel.h"

#include <gtest/gtest.h>

#include "planning/phantom/phantom_case.h"

namespace arthronaut::plan {
namespace {

// When all that are there are confirmed, that is what is read; one that nobody can mark is no work left.
TEST(LandmarkPanel, CountsWhatCanBeConfirmed) {
  using State = LandmarkRow::State;
  std::vector<LandmarkRow> rows(4);
  EXPECT_EQ(confirmed_in_words(rows), "0 of 0 confirmed, 4 not there");
  rows[0].state = rows[1].state = State::Confirmed;
  rows[2].state = State::Proposed;
  EXPECT_EQ(confirmed_in_words(rows), "2 of 3 confirmed, 1 not there");
  EXPECT_TRUE(has_to_confirm(rows));
  rows[2].state = rows[3].state = State::Confirmed;
  EXPECT_EQ(confirmed_in_words(rows), "4 of 4 confirmed");
  EXPECT_FALSE(has_to_confirm(rows)) << "the button stayed bright";
  rows[3].state = State::Missing;
  EXPECT_FALSE(has_to_confirm(rows)) << "what is not there cannot be confirmed";
}

// Those that a click on the surface would put in the wrong place; every other one lies on it.
TEST(LandmarkPanel, TellsWhatLiesWithinTheBone) {
  for (const char* name :
       {"lateral_condyle_center", "medial_condyle_center", "shaft_distal", "shaft_proximal"})
    EXPECT_TRUE(lies_within_bone(name)) << name;
  for (const char* name : {"lateral_condyle_posterior", "notch_apex", "tuberosity", "native_footprint"})
    EXPECT_FALSE(lies_within_bone(name)) << name;
}

// One that a hand put somewhere else is green as one that was looked at: the distance tells them apart.
TEST(LandmarkPanel, SaysHowFarAConfirmedOneIsFromTheProposedPlace) {
  cases::Case knee = phantom::case_of(phantom::make_phantom_knee({.edge_length_mm = 4}), "test");
  knee.landmarks.clear();
  knee.landmark_states.clear();
  open_case::PlanModel model(knee);
  auto marks = model.landmarks(bones::BoneKind::Femur);
  auto states = model.landmark_states(bones::BoneKind::Femur);
  marks.at("medial_epicondyle") += Eigen::Vector3d(3, -4, 12);
  states["medial_epicondyle"] = landmarks::LandmarkState::Confirmed;
  model.set_landmarks(bones::BoneKind::Femur, marks, states);
  const auto off_mm = off_proposal_mm(model, bones::BoneKind::Femur, "medial_epicondyle");
  ASSERT_TRUE(off_mm);
  EXPECT_NEAR(*off_mm, 13, 1e-9);  // 3, 4, 12
  using State = LandmarkRow::State;
  EXPECT_EQ(state_in_words(State::Confirmed, off_mm),
            "confirmed, 13.0 mm from where the bone's shape puts it: look");
  EXPECT_EQ(state_in_words(State::Confirmed, 3.0), "confirmed, 3.0 mm from where the bone's shape puts it");
  EXPECT_EQ(state_in_words(State::Confirmed, std::nullopt), "confirmed");
  EXPECT_EQ(state_in_words(State::Proposed, 0), "proposed by the shape, looked at by nobody");
  EXPECT_FALSE(off_proposal_mm(model, bones::BoneKind::Femur, "native_footprint"));
}

}  // namespace
}  // namespace arthronaut::plan
