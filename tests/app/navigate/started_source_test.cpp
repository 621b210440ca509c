// What was started last, and what ends what is known of it.
#include "app/navigate/started_source.h"

#include <gtest/gtest.h>

namespace arthronaut::navigate {
namespace {

using bones::BoneKind;
using sources::SourceKind;

TEST(StartedSource, ThatItsEndWasAskedIsOfOneSource) {
  StartedSource started;
  EXPECT_FALSE(started.kind());
  started.on_start(BoneKind::Femur, SourceKind::Live);
  started.on_end_asked(true);
  EXPECT_TRUE(started.end_was_asked() && started.stops_once_open());
  started.on_start(BoneKind::Femur, SourceKind::Live);
  EXPECT_FALSE(started.end_was_asked() || started.stops_once_open());
}

TEST(StartedSource, WhatIsSimulatedIsOfOneSourceAndOneBone) {
  StartedSource started;
  const auto is_drilled = [&] { return started.is_simulated(SimulatedPart::Drill); };
  started.on_start(BoneKind::Femur, SourceKind::Simulation);
  started.simulates(SimulatedPart::Drill);
  EXPECT_TRUE(is_drilled());
  started.on_other_bone();
  EXPECT_FALSE(is_drilled());
  started.simulates(SimulatedPart::Drill);
  started.on_start(BoneKind::Femur, SourceKind::Recording);
  EXPECT_FALSE(is_drilled());
}

// The probe's pictures have ended and the touches that verify are still to come: more of them come first.
TEST(StartedSource, TheSimulationGoesOnWithTheProbeUntilItIsVerified) {
  operation::OperationState state;
  EXPECT_EQ(next_part(state), SimulatedPart::Scratch);
  auto stands = std::make_shared<operation::RegistrationState>();
  stands->in_force.standing = operation::Standing::Stands;
  state.registration = stands;
  EXPECT_EQ(next_part(state), SimulatedPart::Touch);
  for (const auto verification : {operation::Verification::ByTouches, operation::Verification::Skipped}) {
    state.verification = verification;
    EXPECT_EQ(next_part(state), SimulatedPart::Drill);
  }
}

TEST(StartedSource, EachBoneHasItsOwnKind) {
  StartedSource started;
  started.on_start(BoneKind::Femur, SourceKind::Simulation);
  EXPECT_FALSE(started.was_real());
  started.on_start(BoneKind::Tibia, SourceKind::Live);
  EXPECT_EQ(started.kind_of(BoneKind::Femur), SourceKind::Simulation);
  EXPECT_EQ(started.kind_of(BoneKind::Tibia), SourceKind::Live);
  EXPECT_EQ(started.kind(), SourceKind::Live);
  EXPECT_TRUE(started.was_real());
  StartedSource resumed;
  resumed.goes_on_with(SourceKind::Live);
  EXPECT_EQ(resumed.kind_of(BoneKind::Femur), SourceKind::Live);
  EXPECT_FALSE(resumed.was_real()) << "nothing was started yet";
}

}  // namespace
}  // namespace arthronaut::navigate
