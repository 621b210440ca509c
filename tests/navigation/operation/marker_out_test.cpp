// The word that the world marker is out: not believed while a live source shows it.
#include <gtest/gtest.h>

#include "tests/navigation/operation/phantom_operation.h"

namespace arthronaut::operation {
namespace {

using sources::SourceKind;
using test::PhantomOperation;

class MarkerOutTest : public ::testing::Test {
 protected:
  void begin(SourceKind kind) {
    run_.start(test::scripted_source(kind));
    run_.show(run_.frame());
    run_.apply(test::true_registration(trial_, run_.operation().now()));
    ASSERT_EQ(run_.in_force().standing, Standing::Stands);
  }
  void show_without_marker(int pictures) {
    for (int i = 0; i < pictures; ++i) {
      pipeline::FrameResult frame = run_.frame();
      frame.camera_from_world.is_valid = false;
      run_.show(frame);
    }
  }
  experiments::Trial trial_ = registration::phantom_bone().trial(experiments::TrialNoise::Dry, 1);
  PhantomOperation run_;
};

TEST_F(MarkerOutTest, IsNotBelievedWhileItIsSeen) {
  begin(SourceKind::Live);
  run_.apply(MarkerOut{});
  EXPECT_FALSE(run_.state()->marker_is_out);
  EXPECT_EQ(run_.state()->touch_refusal, TouchRefusal::MarkerIsSeen);
  EXPECT_EQ(run_.in_force().standing, Standing::Stands) << "nothing has changed";
  show_without_marker(3);
  run_.apply(MarkerOut{});
  EXPECT_EQ(run_.state()->touch_refusal, TouchRefusal::MarkerIsSeen) << "lost for a moment it is still there";
  show_without_marker(40);
  run_.apply(MarkerOut{});
  EXPECT_TRUE(run_.state()->marker_is_out);
  EXPECT_EQ(run_.state()->touch_refusal, TouchRefusal::None);
  EXPECT_EQ(run_.in_force().standing, Standing::None) << "nothing guides by where it sat";
}

// What the last picture showed says nothing of now once no other one has come.
TEST_F(MarkerOutTest, IsBelievedWhereNoPictureHasComeSince) {
  begin(SourceKind::Live);
  run_.apply(MarkerOut{0.4});
  EXPECT_FALSE(run_.state()->marker_is_out) << "a pause of the source";
  run_.apply(MarkerOut{14});
  EXPECT_TRUE(run_.state()->marker_is_out);
  EXPECT_EQ(run_.state()->touch_refusal, TouchRefusal::None);
}

TEST_F(MarkerOutTest, EndsWhereItIsSeenAgain) {
  begin(SourceKind::Live);
  show_without_marker(40);
  run_.apply(MarkerOut{});
  ASSERT_TRUE(run_.state()->marker_is_out);
  run_.show(run_.frame());
  run_.apply(Draw{false});  // any command: the journal is taken
  EXPECT_FALSE(run_.state()->marker_is_out);
  EXPECT_EQ(run_.last_text(JournalKind::MarkerOut), "the world marker is seen again: it is not out");
  show_without_marker(40);
  run_.apply(MarkerOut{});
  ASSERT_TRUE(run_.state()->marker_is_out);
  run_.apply(TakeBackDrilled{});
  EXPECT_FALSE(run_.state()->marker_is_out) << "it is wanted again";
  run_.apply(MarkerOut{});
  run_.apply(MarkerPlacedAnew{});
  EXPECT_FALSE(run_.state()->marker_is_out) << "it sits elsewhere";
}

// No hand takes out what a recording or a simulation shows; and where no pictures come nothing shows it.
TEST_F(MarkerOutTest, IsBelievedWherePicturesAreNotOfNow) {
  for (const SourceKind kind : {SourceKind::Recording, SourceKind::Simulation}) {
    begin(kind);
    run_.apply(MarkerOut{});
    EXPECT_TRUE(run_.state()->marker_is_out);
    run_.show(run_.frame());
    EXPECT_TRUE(run_.state()->marker_is_out);
  }
  begin(SourceKind::Live);
  run_.operation().end_source();
  run_.apply(MarkerOut{});
  EXPECT_TRUE(run_.state()->marker_is_out);
}

}  // namespace
}  // namespace arthronaut::operation
