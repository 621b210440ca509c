#include "app/navigate/navigate_choices.h"

#include <gtest/gtest.h>

namespace arthronaut::navigate {
namespace {

// Nothing that was chosen or seen of one bone is left on the other one's screen; what is of the screen or of
// the case stays.
TEST(NavigateChoices, TheOtherBoneBeginsWithoutWhatWasOfThisOne) {
  NavigateChoices choices;
  choices.saline = false;
  choices.video = 3;
  choices.undistorts = true;
  choices.layout = NavigateLayout::Register;
  choices.guidance_seen_s = 99;
  choices.stroke = 4;
  choices.take_other_bone();
  EXPECT_EQ(choices.bone, bones::BoneKind::Tibia);
  EXPECT_FALSE(choices.layout);
  EXPECT_LT(choices.guidance_seen_s, -1e6);
  EXPECT_EQ(choices.stroke, -1);
  EXPECT_TRUE(choices.undistorts && !choices.saline && choices.video == 3);
  choices.take_other_bone();
  EXPECT_EQ(choices.bone, bones::BoneKind::Femur);
}

// What was said of a rehearsal does not stand beside the bullseye of the patient, nor what was said of a plan
// beside the one that took its place.
TEST(NavigateChoices, DrilledIsSaidOfTheVeryPlanAndKindOfSource) {
  const auto run_by = [](sources::SourceKind kind) {
    operation::OperationState state;
    operation::SourceSetup source;
    source.kind = kind;
    state.source = std::make_shared<const operation::SourceSetup>(source);
    state.plan.emplace().tunnel.bundle = norms::Bundle::Anteromedial;
    return state;
  };
  NavigateChoices choices;
  operation::OperationState rehearsal = run_by(sources::SourceKind::Simulation);
  choices.follow(rehearsal);
  EXPECT_FALSE(choices.is_drilled(rehearsal, *rehearsal.plan));
  rehearsal.drilled.outcome = operation::DrilledState::Outcome::NoEvidence;
  choices.follow(rehearsal);
  EXPECT_TRUE(choices.is_drilled(rehearsal, *rehearsal.plan)) << "the surgeon's word is enough";

  operation::OperationState live = run_by(sources::SourceKind::Live);
  choices.follow(live);
  EXPECT_FALSE(choices.is_drilled(live, *live.plan));
  live.drilled.outcome = operation::DrilledState::Outcome::Recorded;
  choices.follow(live);
  EXPECT_TRUE(choices.is_drilled(live, *live.plan));

  operation::PlannedTunnel other = *live.plan;
  other.tunnel.bundle = norms::Bundle::Posterolateral;
  EXPECT_FALSE(choices.is_drilled(live, other));
  other = *live.plan;
  other.tunnel.entry_mm.x() += 1;
  EXPECT_FALSE(choices.is_drilled(live, other)) << "planned anew";
}

// The operation forgets with the marker that touches had verified what guided; the list at the end does not,
// and makes nothing of a verification that was skipped.
TEST(NavigateChoices, WhatWasVerifiedIsRememberedWithTheTunnel) {
  using operation::Verification;
  NavigateChoices choices;
  operation::OperationState state;
  operation::SourceSetup source;
  source.kind = sources::SourceKind::Live;
  state.source = std::make_shared<const operation::SourceSetup>(source);
  state.plan.emplace();
  state.verification = Verification::ByTouches;
  choices.follow(state);
  EXPECT_TRUE(choices.verified.empty()) << "nothing is drilled";
  state.drilled.tunnel.emplace();
  state.verification = Verification::Skipped;
  choices.follow(state);
  EXPECT_TRUE(choices.verified.empty());
  state.verification = Verification::ByTouches;
  choices.follow(state);
  state.verification = Verification::NotYet;
  choices.follow(state);
  EXPECT_EQ(choices.verified.size(), 1U);
  choices.markers_out.insert({source.kind, choices.bone});
  choices.begin(source.kind);
  EXPECT_TRUE(choices.verified.empty()) << "the operation begins afresh";
}

// The operation says whether the marker is out: seen again it is not.
TEST(NavigateChoices, AMarkerIsOutAsLongAsTheOperationSaysSo) {
  NavigateChoices choices;
  operation::SourceSetup source;
  source.kind = sources::SourceKind::Live;
  operation::OperationState state;
  state.source = std::make_shared<const operation::SourceSetup>(source);
  state.marker_is_out = true;
  choices.follow(state);
  EXPECT_TRUE(choices.markers_out.contains({source.kind, state.bone}));
  state.marker_is_out = false;
  choices.follow(state);
  EXPECT_TRUE(choices.markers_out.empty());
}

}  // namespace
}  // namespace arthronaut::navigate
