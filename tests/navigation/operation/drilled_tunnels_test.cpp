#include "navigation/operation/drilled_tunnels.h"

#include <gtest/gtest.h>

namespace arthronaut::operation {
namespace {

class DrilledTunnelsTest : public ::testing::Test {
 protected:
  DrilledTunnelsTest() {
    start_source();
    state_.plan.emplace().tunnel.bundle = norms::Bundle::Anteromedial;
  }
  void start_source() {
    SourceSetup source;
    source.kind = sources::SourceKind::Live;
    state_.source = std::make_shared<const SourceSetup>(source);
    state_.drilled = {};
    state_.marker_is_out = false;
  }
  void follow(DrilledState::Outcome outcome) {
    state_.drilled.outcome = outcome;
    if (outcome == DrilledState::Outcome::Recorded) state_.drilled.tunnel.emplace();
    said_.follow(state_);
  }
  [[nodiscard]] const DrilledTunnel* found() const { return said_.find(*state_.plan); }

  OperationState state_;
  DrilledTunnels said_;
};

// What was said of a plan does not stand beside the one that took its place.
TEST_F(DrilledTunnelsTest, ItIsSaidOfTheVeryPlan) {
  follow(DrilledState::Outcome::NotSaid);
  EXPECT_EQ(found(), nullptr);
  follow(DrilledState::Outcome::NoEvidence);
  ASSERT_NE(found(), nullptr) << "the surgeon's word is enough";
  EXPECT_FALSE(found()->measured);
  PlannedTunnel other = *state_.plan;
  other.tunnel.bundle = norms::Bundle::Posterolateral;
  EXPECT_EQ(said_.find(other), nullptr);
  other = *state_.plan;
  other.tunnel.entry_mm.x() += 1;
  EXPECT_EQ(said_.find(other), nullptr) << "planned anew";
}

// The operation forgets with the marker that touches had verified what guided; the list at the end does not,
// and makes nothing of a verification that was skipped.
TEST_F(DrilledTunnelsTest, WhatWasVerifiedIsRememberedWithTheTunnel) {
  follow(DrilledState::Outcome::NoEvidence);
  EXPECT_FALSE(found()->was_verified);
  state_.verification = Verification::ByTouches;
  follow(DrilledState::Outcome::NoEvidence);
  EXPECT_TRUE(found()->was_verified) << "the registration was, whatever nobody saw of the drilling";
  state_.verification = Verification::Skipped;
  follow(DrilledState::Outcome::Recorded);
  EXPECT_FALSE(found()->was_verified);
  for (const Verification verification : {Verification::ByTouches, Verification::NotYet}) {
    state_.verification = verification;
    follow(DrilledState::Outcome::Recorded);
    EXPECT_TRUE(found()->was_verified);
  }
  start_source();
  follow(DrilledState::Outcome::NoEvidence);
  EXPECT_TRUE(found()->measured) << "said once more, it is as it was measured";
}

// The operation says whether the marker is out: seen again it is not. Another source of a bone whose marker
// is out is another operation; of one that is not, the same.
TEST_F(DrilledTunnelsTest, AnotherSourceBeginsAfreshWhereTheMarkerIsOut) {
  follow(DrilledState::Outcome::Recorded);
  start_source();
  follow(DrilledState::Outcome::NotSaid);
  EXPECT_NE(found(), nullptr) << "the source was changed, no more";
  state_.marker_is_out = true;
  said_.follow(state_);
  EXPECT_TRUE(said_.marker_is_out(state_.bone));
  state_.marker_is_out = false;
  said_.follow(state_);
  EXPECT_FALSE(said_.marker_is_out(state_.bone));
  state_.marker_is_out = true;
  said_.follow(state_);
  start_source();
  said_.follow(state_);
  EXPECT_EQ(found(), nullptr);
  EXPECT_FALSE(said_.marker_is_out(state_.bone));
}

// Of a program that was started again: what was said before counts until a source begins, and the word that
// the marker is out needs none.
TEST_F(DrilledTunnelsTest, WhatWasSaidBeforeCountsUntilASourceBegins) {
  DrilledTunnels before;
  before.say_drilled({*state_.plan, std::nullopt, false});
  DrilledTunnels out = before;
  out.say_marker(state_.bone, true);
  const OperationState with_source = state_;
  state_.source = nullptr;
  said_.follow(state_);
  said_.add_before(before);
  EXPECT_NE(found(), nullptr);
  EXPECT_FALSE(said_.marker_is_out(state_.bone));
  state_.marker_is_out = true;
  said_.follow(state_);
  EXPECT_TRUE(said_.marker_is_out(state_.bone));
  state_.marker_is_out = false;
  state_.drilled.was_taken_back = true;
  said_.follow(state_);
  EXPECT_EQ(found(), nullptr);
  EXPECT_FALSE(said_.marker_is_out(state_.bone)) << "it is wanted again";

  DrilledTunnels begun;
  begun.follow(with_source);
  begun.add_before(out);
  EXPECT_EQ(begun.find(*state_.plan), nullptr) << "it came to its end before";
  begun.add_before(before);
  EXPECT_NE(begun.find(*state_.plan), nullptr) << "it goes on";
}

}  // namespace
}  // namespace arthronaut::operation
