// What is shown of a source's pictures: none yet, old, late, ended, failed.
#include <gtest/gtest.h>

#include "app/navigate/navigate_display.h"
#include "tests/app/navigate/shown_operation.h"

namespace arthronaut::navigate {
namespace {

using Phase = theatre::LiveState::Phase;
using guidance::GuidanceState;
using operation::Standing;

// A worker that hangs must not leave its last picture standing as live.
TEST(NavigateDisplay, AnOldPictureIsNotLive) {
  const NavigateDisplay display = display_after([](Shown& shown) { shown.live.captured_s = kNow_s - 2; });
  EXPECT_TRUE(display.has_picture);
  EXPECT_FALSE(display.is_live || display.overlay_is_valid || display.guidance_is_valid);
  EXPECT_EQ(display.headline, "No new picture for 2 s");
}

// Both are said of the source that was started last: while it is opened it has to be stopped like one that
// runs, and what is known is still of the one before.
TEST(NavigateDisplay, Hazard2ASourceThatIsBeingOpenedIsUnderWayAndNotKnownYet) {
  theatre::LiveState live;
  const auto expect = [&](Phase phase, bool is_on, bool is_of_before) {
    live.phase = phase;
    EXPECT_EQ(is_under_way(live), is_on) << static_cast<int>(phase);
    EXPECT_EQ(is_of_source_before(live), is_of_before) << static_cast<int>(phase);
  };
  expect(Phase::NoSource, false, false);
  expect(Phase::Starting, true, true);
  expect(Phase::Running, true, false);
  expect(Phase::Ended, false, false);
  expect(Phase::Failed, false, true);
  live.picture = std::make_shared<camera::Frame>();
  expect(Phase::Failed, false, false);
}

// The end of a source and a failure are said, and nothing of them is live.
TEST(NavigateDisplay, EndAndFailureAreNotLive) {
  const auto ended = display_after([](Shown& shown) { shown.live.phase = Phase::Ended; });
  EXPECT_TRUE(ended.has_picture);
  EXPECT_FALSE(ended.is_live || ended.guidance_is_valid || ended.overlay_is_valid);
  EXPECT_EQ(ended.headline, "The pictures have ended");
  const auto failed = display_after([](Shown& shown) {
    shown.live.phase = Phase::Failed;
    shown.live.message = "clip.mkv: frame 12 is cut off";
  });
  EXPECT_FALSE(failed.has_picture);
  EXPECT_EQ(failed.detail, "clip.mkv: frame 12 is cut off");
  EXPECT_FALSE(display_of(nullptr, kNow_s).has_picture);
  const auto without_picture = display_after([](Shown& shown) {
    shown.live.phase = Phase::Ended;
    shown.live.picture = nullptr;
  });
  EXPECT_EQ(without_picture.detail, "It ended before its first picture");
}

// Pictures that end before the tunnel was said to be drilled leave two ways, and both are said.
TEST(NavigateDisplay, PicturesThatEndBeforeTheTunnelIsSaidLeaveTheWord) {
  const auto end_of = [](std::optional<operation::PlannedTunnel> plan, Standing standing,
                         operation::DrilledState::Outcome said) {
    return display_after([&](Shown& shown) {
      shown.live.phase = Phase::Ended;
      shown.operation.has_source = false;
      shown.operation.plan = std::move(plan);
      shown.operation.drilled.outcome = said;
      shown.stand(standing, {});
    });
  };
  using Outcome = operation::DrilledState::Outcome;
  const operation::PlannedTunnel plan{{}, 30};
  const std::string open = end_of(plan, Standing::Stands, Outcome::NotSaid).detail;
  EXPECT_NE(open.find("Go on with others"), std::string::npos) << open;
  EXPECT_NE(open.find("(hold J)"), std::string::npos) << open;
  for (const NavigateDisplay& other :
       {end_of(plan, Standing::Stands, Outcome::Recorded), end_of(plan, Standing::None, Outcome::NotSaid),
        end_of(std::nullopt, Standing::Stands, Outcome::NotSaid)}) {
    EXPECT_EQ(other.detail.find("(hold J)"), std::string::npos) << other.detail;
    EXPECT_NE(other.detail.find("nothing guides"), std::string::npos) << other.detail;
  }
}

// The scripted probe has drawn, and the next step is to drill: nothing else is offered beside it.
TEST(NavigateDisplay, AfterASimulatedScratchNothingIsSaidToBeDrilled) {
  const NavigateDisplay display = display_after([](Shown& shown) {
    shown.live.phase = Phase::Ended;
    shown.operation.has_source = false;
    shown.operation.plan = operation::PlannedTunnel{{}, 30};
    shown.source.kind = sources::SourceKind::Simulation;
    shown.stand(Standing::Stands, {});
  });
  EXPECT_EQ(display.detail, "This is the last one: nothing guides");
}

// One word, one key: what the pedal asks for then is offered by no other, and nothing says the contrary.
TEST(NavigateDisplay, WhatThePedalAsksForAtTheEndIsOfferedByNoOtherKey) {
  const NavigateDisplay display = display_after([](Shown& shown) {
    shown.live.phase = Phase::Ended;
    shown.operation.has_source = false;
    shown.operation.plan = operation::PlannedTunnel{{}, 30};
    shown.operation.next_action = operation::NextAction::RecordDrilled;
    shown.stand(Standing::Stands, {});
  });
  EXPECT_EQ(display.detail,
            "Nothing guides. If it is not drilled: a step back (Page up), then other pictures");
}

// Numbers that another registration has just taken back were no old poses, and both markers are in view: what
// is said is true of either.
TEST(NavigateDisplay, NumbersThatWereTakenBackAreNotCalledOldPoses) {
  const NavigateDisplay display =
      display_after([](Shown& shown) { shown.operation.frame.guidance.state = GuidanceState::Stale; });
  EXPECT_EQ(display.headline, "Nothing guides yet");
  EXPECT_NE(display.detail.find("next picture"), std::string::npos) << display.detail;
}

// Nothing is asked of the surgeon before there is a picture to see it in.
TEST(NavigateDisplay, ASourceThatIsOpenWaitsForItsFirstPicture) {
  theatre::LiveState live = Shown().whole();
  EXPECT_FALSE(awaits_picture(live));
  live.picture = nullptr;
  EXPECT_TRUE(awaits_picture(live)) << "open, and nothing came yet";
  live.phase = Phase::Starting;
  EXPECT_TRUE(awaits_picture(live));
  for (const Phase phase : {Phase::NoSource, Phase::Failed, Phase::Ended}) {
    live.phase = phase;
    EXPECT_FALSE(awaits_picture(live));
  }
}

// A live picture is late after the tenth of a second that its source allows, and not before; a recording,
// which comes as the machine can make it, is not.
TEST(NavigateDisplay, Hazard3ALatePictureIsNotLive) {
  const auto aged = [](double age_s, double stale_after_s) {
    return display_after([&](Shown& shown) {
      shown.live.captured_s = kNow_s - age_s;
      shown.live.stale_after_s = stale_after_s;
    });
  };
  EXPECT_TRUE(aged(0.09, 0.1).guidance_is_valid);
  const NavigateDisplay late = aged(0.25, 0.1);
  EXPECT_FALSE(late.is_live || late.overlay_is_valid || late.guidance_is_valid);
  EXPECT_EQ(late.headline, "Picture 0.3 s late");
  const NavigateDisplay behind = display_after([](Shown& shown) {
    shown.live.captured_s = kNow_s - 1.7;
    shown.live.trouble = theatre::SourceTrouble::Late;
  });
  EXPECT_EQ(behind.headline, "Picture 2 s late") << "pictures come, and are old";
  EXPECT_TRUE(aged(0.25, 2).guidance_is_valid);
}

// A busy machine is late with a picture now and then. What keeps guidance away until somebody acts stays
// said, and nothing of the late picture is shown as live; what a picture of now would end is no such thing,
// and a second without any is told whatever else is wrong.
TEST(NavigateDisplay, Hazard27ALastingReasonIsNotCoveredByALatePicture) {
  const auto late = [](double age_s, const auto& change) {
    return display_after([&](Shown& shown) {
      shown.live.captured_s = kNow_s - age_s;
      change(shown);
    });
  };
  const auto wrong_medium = [](Shown& shown) {
    shown.operation.medium.fit = pipeline::MediumFit::Contradicts;
    shown.operation.medium.stated_index = 1;
    shown.operation.medium.other_index = 1.3345;
    shown.operation.frame.intrinsics_are_known = false;
  };
  const std::string in_time = late(0.02, wrong_medium).detail;
  const NavigateDisplay medium = late(0.25, wrong_medium);
  EXPECT_EQ(medium.headline, "Wrong medium");
  EXPECT_EQ(medium.detail, in_time);
  EXPECT_EQ(medium.detail, "The markers look as in saline, not as in air");
  EXPECT_TRUE(medium.has_picture);
  EXPECT_FALSE(medium.is_live || medium.overlay_is_valid || medium.guidance_is_valid);
  const auto stands = [](Standing standing) {
    return [standing](Shown& shown) { shown.stand(standing, {"why"}); };
  };
  for (const Standing standing : {Standing::Alarm, Standing::Void, Standing::InDoubt})
    EXPECT_EQ(late(0.25, stands(standing)).headline, late(0.02, stands(standing)).headline);
  const auto due = [](Shown& shown) { shown.operation.time_out = operation::TimeOut::Due; };
  EXPECT_EQ(late(0.25, due).headline, "Time-out not confirmed");

  EXPECT_EQ(late(1.5, wrong_medium).headline, "No new picture for 1 s");
  const auto broken = [&](Shown& shown) {
    wrong_medium(shown);
    shown.live.trouble = theatre::SourceTrouble::NoPicture;
    shown.live.trouble_words = "No picture comes: broke off";
  };
  EXPECT_EQ(late(0.4, broken).detail, "No picture comes: broke off");
  const auto lost = [](Shown& shown) {
    shown.operation.frame.guidance.state = GuidanceState::WorldMarkerLost;
  };
  EXPECT_EQ(late(0.25, lost).headline, "Picture 0.3 s late");
  // What is wrong with the pictures themselves comes before that they are late.
  const auto hangs = [&](Shown& shown) {
    shown.live.trouble = theatre::SourceTrouble::Frozen;
    shown.live.trouble_words = "The source sends the same picture again and again";
  };
  EXPECT_EQ(late(0.25, hangs).headline, "Picture frozen");
  EXPECT_EQ(late(0.25, hangs).detail, "The source sends the same picture again and again");
  EXPECT_EQ(late(1.5, hangs).headline, "No new picture for 1 s");
  const auto frozen = [&](Shown& shown) {
    wrong_medium(shown);
    shown.operation.frame.is_frozen = true;
  };
  EXPECT_EQ(late(0.25, frozen).headline, "Picture 0.3 s late");
}

}  // namespace
}  // namespace arthronaut::navigate
