#include "app/navigate/navigate_display.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "app/navigate/theatre_bones.h"
#include "tests/app/navigate/shown_operation.h"

namespace arthronaut::navigate {
namespace {

using Phase = theatre::LiveState::Phase;
using guidance::GuidanceState;
using operation::Standing;

// All is well: everything may be drawn and no reason stands anywhere.
TEST(NavigateDisplay, ShowsWhatIsValid) {
  const NavigateDisplay display = display_after([](Shown&) {});
  EXPECT_TRUE(display.is_live && display.overlay_is_valid && display.guidance_is_valid);
  EXPECT_TRUE(display.headline.empty());
  EXPECT_EQ(display.guidance.angle_deg, 1.5);
}

// What guides without a touch of a known place is told for as long as it guides.
TEST(NavigateDisplay, TellsThatNobodyHasVerified) {
  using operation::Verification;
  for (const Verification verification :
       {Verification::NotYet, Verification::ByTouches, Verification::Skipped}) {
    const NavigateDisplay display =
        display_after([&](Shown& shown) { shown.operation.verification = verification; });
    EXPECT_TRUE(display.guidance_is_valid);
    EXPECT_EQ(display.is_unverified, verification == Verification::Skipped);
  }
}

// Whatever makes guidance invalid takes the numbers away in that very frame and says why.
TEST(NavigateDisplay, EveryInvalidStateHidesTheNumbersAndSaysWhy) {
  for (const GuidanceState state :
       {GuidanceState::NoPlan, GuidanceState::NoRegistration, GuidanceState::RegistrationUnreliable,
        GuidanceState::WorldMarkerLost, GuidanceState::GuideLost, GuidanceState::LensStale,
        GuidanceState::Stale, GuidanceState::NoGuide, GuidanceState::PictureTorn, GuidanceState::ErrorUnknown,
        GuidanceState::PictureLate, GuidanceState::PicturesSlow, GuidanceState::MediumUnsure}) {
    const NavigateDisplay display =
        display_after([&](Shown& shown) { shown.operation.frame.guidance.state = state; });
    EXPECT_FALSE(display.guidance_is_valid) << to_text(state);
    EXPECT_FALSE(display.headline.empty()) << to_text(state);
    EXPECT_EQ(display.guidance.angle_deg, 0) << "a number of the frame leaked";
  }
}

// By when they were looked at, not by when they are shown: a slow screen alone takes nothing from them.
TEST(NavigateDisplay, Hazard34TellsThatTheMachineIsLateWithThePictures) {
  const auto is_late = [](double age_s, const auto& change) {
    Shown shown;
    shown.live.published_s = shown.live.captured_s + age_s;
    change(shown);
    return pictures_are_late(shown.whole());
  };
  const auto nothing = [](Shown&) {};
  EXPECT_FALSE(is_late(0.05, nothing));
  EXPECT_TRUE(is_late(0.08, nothing)) << "of the 100 ms that may pass until it is on the screen";
  EXPECT_TRUE(is_late(0.5, nothing));
  EXPECT_FALSE(is_late(0.5, [](Shown& s) { s.source.kind = sources::SourceKind::Recording; }));
  EXPECT_FALSE(is_late(0.5, [](Shown& s) { s.live.phase = Phase::Ended; }));
  EXPECT_FALSE(is_late(0.5, [](Shown& s) { s.live.picture = nullptr; }));
}

// A pose that does not stand takes the overlay with it, even where guidance claims to be valid.
TEST(NavigateDisplay, OverlayNeedsThePoseOfThisFrame) {
  const auto lost =
      display_after([](Shown& shown) { shown.operation.frame.camera_from_world.is_valid = false; });
  EXPECT_FALSE(lost.overlay_is_valid || lost.guidance_is_valid);
  const auto lens = display_after([](Shown& shown) { shown.operation.frame.intrinsics_are_known = false; });
  EXPECT_FALSE(lens.overlay_is_valid || lens.guidance_is_valid);
  const auto frozen = display_after([](Shown& shown) { shown.operation.frame.is_frozen = true; });
  EXPECT_FALSE(frozen.overlay_is_valid || frozen.guidance_is_valid);
  EXPECT_EQ(frozen.headline, "Picture frozen");
}

// The plan's lines need a registration that stands now, whatever the frame was worked in with; what was
// touched is drawn without one, while it is made.
TEST(NavigateDisplay, Hazard1ThePlanIsDrawnOnlyWhileARegistrationStands) {
  EXPECT_TRUE(display_after([](Shown&) {}).plan_is_valid);
  for (const Standing standing :
       {Standing::None, Standing::NotReliable, Standing::Void, Standing::Alarm, Standing::InDoubt}) {
    const NavigateDisplay display = display_after([&](Shown& shown) {
      shown.stand(standing, {"the world marker was placed anew"});
      shown.operation.frame.tip_is_valid = true;
    });
    EXPECT_FALSE(display.plan_is_valid || display.tip_is_valid || display.guidance_is_valid)
        << to_text(standing);
    const bool is_made = standing == Standing::None || standing == Standing::NotReliable;
    EXPECT_EQ(display.overlay_is_valid, is_made) << to_text(standing);
    EXPECT_FALSE(display.headline.empty()) << to_text(standing);
  }
}

// An alarm hides everything from this moment on, even in a frame that was computed before it.
TEST(NavigateDisplay, AnAlarmDropsGuidanceAtOnce) {
  const auto display = display_after(
      [](Shown& shown) { shown.stand(Standing::Alarm, {"the control point has moved by 2.1 mm"}); });
  EXPECT_TRUE(display.is_live);
  EXPECT_FALSE(display.overlay_is_valid || display.guidance_is_valid);
  EXPECT_EQ(display.headline, "World marker may have moved");
  EXPECT_NE(display.detail.find("2.1 mm"), std::string::npos);
}

// Each trouble with the lens has its own name and says what to do; another zoom is said before a mark that is
// hidden.
TEST(NavigateDisplay, SaysWhatIsWrongWithTheLens) {
  using lens::MarkState;
  lens::LensObservation lens;
  lens.mark = MarkState::Found;
  EXPECT_TRUE(trouble_of(lens).headline.empty());
  for (const MarkState state :
       {MarkState::NoCircle, MarkState::Dark, MarkState::Covered, MarkState::Ambiguous, MarkState::NotSeen}) {
    lens.mark = state;
    EXPECT_EQ(trouble_of(lens).headline, "Lens mark not found");
    EXPECT_NE(trouble_of(lens).advice.find(':'), std::string::npos) << to_text(state);
  }
  lens.zoom_or_slip = true;
  EXPECT_NE(trouble_of(lens).headline.find("coupler"), std::string::npos);
  const auto display = display_after([&](Shown& shown) {
    shown.operation.frame.intrinsics_are_known = false;
    shown.operation.frame.guidance.state = GuidanceState::LensStale;
    shown.operation.frame.lens = lens;
  });
  EXPECT_EQ(display.headline, trouble_of(lens).headline);
  EXPECT_EQ(display.detail, trouble_of(lens).advice);
}

// The screen shows the registration while it is made, and the way to the plan when there is one to go; a
// guide that was seen a moment ago keeps it.
TEST(NavigateDisplay, TheLayoutFollowsWhatIsDone) {
  constexpr double kLongAgo = 1e9;
  EXPECT_EQ(layout_of(*TheatreBones::nothing(), kLongAgo), NavigateLayout::Guide);
  Shown shown;
  shown.stand(Standing::None, {});
  shown.operation.draws = true;
  EXPECT_EQ(layout_of(shown.whole(), kLongAgo), NavigateLayout::Register);
  EXPECT_EQ(layout_of(shown.whole(), 0.5), NavigateLayout::Guide);
  shown.stand(Standing::Stands, {});
  EXPECT_EQ(layout_of(shown.whole(), kLongAgo), NavigateLayout::Register) << "the probe still draws";
  shown.operation.drilled.has_evidence = true;
  EXPECT_EQ(layout_of(shown.whole(), kLongAgo), NavigateLayout::Guide) << "it was aimed by";
  shown.operation.drilled.has_evidence = false;
  shown.operation.next_action = operation::NextAction::BringGuide;
  EXPECT_EQ(layout_of(shown.whole(), kLongAgo), NavigateLayout::Register) << "it may go on";
  shown.operation.verification = operation::Verification::ByTouches;
  EXPECT_EQ(layout_of(shown.whole(), kLongAgo), NavigateLayout::Guide) << "the last touch has verified it";
  shown.operation.verification = operation::Verification::NotYet;
  shown.operation.draws = false;
  shown.operation.next_action = operation::NextAction::BringGuide;
  EXPECT_EQ(layout_of(shown.whole(), kLongAgo), NavigateLayout::Guide);
}

// What is touched to verify is told of by the probe's panel, whatever was seen of a guide before: there
// stands how far off the bone it was.
TEST(NavigateDisplay, TheLayoutIsOfTheToolThatTheStepTakes) {
  using operation::NextAction;
  using operation::Step;
  constexpr double kLongAgo = 1e9;
  Shown shown;
  const auto after = [&](NextAction action, std::optional<Step> looked_at = std::nullopt) {
    shown.operation.next_action = action;
    return layout_of(shown.whole(), kLongAgo, looked_at);
  };
  for (const bool has_evidence : {false, true}) {
    shown.operation.drilled.has_evidence = has_evidence;
    for (const NextAction action :
         {NextAction::VerifyByTouch, NextAction::SetControlPoint, NextAction::CheckControlPoint,
          NextAction::RegisterAnew, NextAction::StartSource})  // nothing is verified yet
      EXPECT_EQ(after(action), NavigateLayout::Register) << to_text(action);
    for (const NextAction action : {NextAction::CheckGuide, NextAction::BringGuide,
                                    NextAction::FollowBullseye, NextAction::RecordDrilled})
      EXPECT_EQ(after(action), NavigateLayout::Guide) << to_text(action);
    EXPECT_EQ(after(NextAction::BringGuide, Step::Verify), NavigateLayout::Register) << "gone back to";
    EXPECT_EQ(after(NextAction::VerifyByTouch, Step::Guide), NavigateLayout::Guide);
  }
  // What came of the last touch is read, and then the way to the plan is shown, whether a guide is seen or
  // not.
  shown.operation.next_action = NextAction::BringGuide;
  EXPECT_EQ(layout_of(shown.whole(), kLongAgo, std::nullopt, 1), NavigateLayout::Register);
  EXPECT_EQ(layout_of(shown.whole(), kLongAgo, std::nullopt, 8), NavigateLayout::Guide);
  EXPECT_EQ(layout_of(shown.whole(), 0.5, std::nullopt, 1), NavigateLayout::Guide) << "it guides";
  shown.operation.guided_lately = true;
  EXPECT_EQ(after(NextAction::CheckControlPoint), NavigateLayout::Guide) << "the guide is in the hand";
}

// Before there is a registration the lost marker is what keeps one from being made, so it is said first.
TEST(NavigateDisplay, ALostMarkerIsSaidBeforeAMissingRegistration) {
  const auto display = display_after([](Shown& shown) {
    shown.stand(Standing::None, {});
    shown.operation.frame.guidance.state = GuidanceState::NoRegistration;
    shown.operation.frame.camera_from_world.is_valid = false;
    shown.operation.frame.markers.resize(1);
    shown.operation.frame.markers[0].id = 0;
    shown.operation.frame.markers[0].state = markers::MarkerState::Covered;
  });
  EXPECT_EQ(display.headline, "Bone marker lost");
  EXPECT_EQ(display.detail, "Covered");
}

// The reason names what the tracker said about the marker that is missing.
TEST(NavigateDisplay, NamesTheReasonOfTheMarker) {
  const NavigateDisplay display = display_after([](Shown& shown) {
    shown.operation.frame.guidance.state = GuidanceState::GuideLost;
    shown.operation.frame.markers.resize(1);
    shown.operation.frame.markers[0].id = 3;
    shown.operation.frame.markers[0].state = markers::MarkerState::Glare;
  });
  EXPECT_EQ(display.headline, "Drill guide lost");
  EXPECT_EQ(display.detail, "Glare");
}

// Over a wire there is no guide: what the drill's own marker tells stays, whatever is wrong with the guide
// (not seen, not checked, at the rim), and goes with all that may make it wrong.
TEST(NavigateDisplay, Hazard7TheDrillIsToldOfWithoutAGuide) {
  const auto drilled = [](GuidanceState state, const auto& change) {
    return display_after([&](Shown& shown) {
      shown.operation.frame.guidance.state = state;
      shown.operation.frame.guidance.drill.emplace();
      shown.operation.frame.guidance.drill->breakout = guidance::Breakout::Imminent;
      change(shown);
    });
  };
  const auto nothing = [](Shown&) {};
  for (const GuidanceState state : {GuidanceState::Valid, GuidanceState::GuideLost, GuidanceState::NoGuide,
                                    GuidanceState::GuideNotChecked, GuidanceState::ErrorUnknown})
    EXPECT_TRUE(breaks_out(drilled(state, nothing))) << to_text(state);
  for (const GuidanceState state :
       {GuidanceState::WorldMarkerLost, GuidanceState::LensStale, GuidanceState::NotConfirmed,
        GuidanceState::WrongMedium, GuidanceState::PictureTorn, GuidanceState::RegistrationUnreliable})
    EXPECT_FALSE(drilled(state, nothing).drill) << to_text(state);
  // Its depth stands beside the bullseye: that is brought up by it, as by a guide.
  EXPECT_TRUE(gets_screen(drilled(GuidanceState::GuideLost, nothing), {}));
  EXPECT_FALSE(gets_screen(drilled(GuidanceState::WorldMarkerLost, nothing), {}));
  EXPECT_FALSE(drilled(GuidanceState::GuideLost, [](Shown& s) { s.stand(Standing::InDoubt, {"x"}); }).drill);
  EXPECT_FALSE(drilled(GuidanceState::GuideLost, [](Shown& s) {
                 s.operation.time_out = operation::TimeOut::Due;
               }).drill);
  EXPECT_FALSE(drilled(GuidanceState::GuideLost, [](Shown& s) { s.live.captured_s = kNow_s - 1; }).drill);
  EXPECT_FALSE(drilled(GuidanceState::GuideLost, [](Shown& s) { s.operation.frame.is_frozen = true; }).drill);
  const NavigateDisplay beside =
      drilled(GuidanceState::GuideLost, [](Shown& s) { s.operation.frame.guidance.drill->lateral_mm = 6; });
  EXPECT_TRUE(breaks_out(beside)) << "wherever the plan is, bone ends";
}

// A tool set without the guide, and a guide whose axis nobody knows, are said as such.
TEST(NavigateDisplay, Hazard11AMissingGuideIsSaidInItsOwnWords) {
  const auto no_guide = [](Shown& shown) { shown.operation.frame.guidance.state = GuidanceState::NoGuide; };
  const NavigateDisplay without_axis = display_after(no_guide);
  EXPECT_EQ(without_axis.headline, "No drill guide");
  EXPECT_EQ(without_axis.detail, "The axis of the femoral guide is not known: measure it in Set up");
  const NavigateDisplay without_guide = display_after([&](Shown& shown) {
    no_guide(shown);
    shown.source.pipeline.tools = {};
  });
  EXPECT_EQ(without_guide.detail, "The tools of this case hold no femoral guide");
}

// A registration that is not one of what the pictures are of: overlay and numbers are gone in this very
// frame, whatever it was computed with, and the reason stands on the screen with what is to be done.
TEST(NavigateDisplay, Hazard1AVoidRegistrationShowsNothingAndSaysWhy) {
  for (const bool can_be_confirmed : {false, true}) {
    const NavigateDisplay display = display_after([&](Shown& shown) {
      shown.stand(Standing::Void, {"it is of a simulation, and these pictures are live"});
      shown.registration.in_force.can_be_confirmed = can_be_confirmed;
    });
    EXPECT_TRUE(display.is_live);
    EXPECT_FALSE(display.overlay_is_valid || display.guidance_is_valid);
    EXPECT_EQ(display.guidance.angle_deg, 0) << "a number of the frame leaked";
    EXPECT_EQ(display.headline, "Registration void");
    EXPECT_NE(display.detail.find("it is of a simulation"), std::string::npos) << display.detail;
    EXPECT_NE(display.detail.find(can_be_confirmed ? "once (T) to confirm" : "Register anew"),
              std::string::npos)
        << display.detail;
  }
}

// What is doubted does not guide, whoever chose it.
TEST(NavigateDisplay, Hazard8DoubtHidesGuidance) {
  const NavigateDisplay display = display_after([](Shown& shown) {
    shown.stand(Standing::InDoubt, {"the strokes miss the surface"});
    shown.registration.is_chosen = true;
  });
  EXPECT_FALSE(display.overlay_is_valid || display.guidance_is_valid);
  EXPECT_EQ(display.headline, "Registration in doubt");
}

// What is to be done about strokes of another size than the bone is nothing that drawing could do.
TEST(NavigateDisplay, StrokesOfAnotherSizeAskForNoMoreOfThem) {
  registration::RegistrationSummary found;
  operation::RegistrationState state;
  state.in_force.standing = Standing::InDoubt;
  state.in_force.registration = std::make_shared<const registration::RegistrationSummary>(found);
  EXPECT_NE(trouble_of(state).advice.find("Draw more"), std::string::npos);
  found.stroke_scale = {1.03, 0.004};
  state.in_force.registration = std::make_shared<const registration::RegistrationSummary>(found);
  EXPECT_NE(trouble_of(state).advice.find("Measure the printed markers"), std::string::npos);
}

// What was not confirmed guides nothing, whatever else stands: no number and no line of the plan.
TEST(NavigateDisplay, Hazard20NothingIsShownBeforeTheTimeOut) {
  Shown shown;
  shown.operation.frame.tip_is_valid = true;
  ASSERT_TRUE(shown.display().guidance_is_valid && shown.display().tip_is_valid);
  shown.operation.time_out = operation::TimeOut::Due;
  EXPECT_FALSE(shown.display().guidance_is_valid) << "in the frame that was worked in before, too";
  EXPECT_EQ(shown.display().headline, "Time-out not confirmed");
  EXPECT_FALSE(shown.display().plan_is_valid);
  EXPECT_FALSE(shown.display().tip_is_valid) << "how far the tip is from the bone is a number too";
  shown.operation.frame.guidance.state = GuidanceState::NotConfirmed;
  EXPECT_FALSE(shown.display().guidance_is_valid);
  EXPECT_EQ(shown.display().headline, "Time-out not confirmed");
  // No stroke is taken before it: nobody is told to touch the bone.
  shown.operation.has_source = true;
  shown.stand(Standing::None, {});
  shown.operation.frame.guidance.state = GuidanceState::NoRegistration;
  EXPECT_EQ(shown.display().headline, "Time-out not confirmed");
  shown.stand(Standing::Stands, {});
  shown.operation.time_out = operation::TimeOut::Confirmed;
  shown.operation.frame.guidance.state = GuidanceState::Valid;
  EXPECT_TRUE(shown.display().guidance_is_valid);
}

// A nominal guide that nobody checked, and one that was found elsewhere: no number of it, and what to do. The
// plan lies where it lies: that is not the guide's.
TEST(NavigateDisplay, Hazard6ANominalGuideThatWasNotCheckedGivesNoNumber) {
  Shown shown;
  operation::GuideCheckState& guide = shown.operation.guide_check;
  guide.standing = operation::GuideStanding::Due;
  shown.operation.frame.guidance.state = GuidanceState::GuideNotChecked;
  EXPECT_FALSE(shown.display().guidance_is_valid);
  EXPECT_TRUE(shown.display().plan_is_valid);
  EXPECT_EQ(shown.display().headline, "Guide not checked");
  EXPECT_EQ(shown.display().detail,
            "Nobody measured where the femoral guide ends: hold its tip on the control point (A)");
  guide = {operation::GuideStanding::Off, 3.24};
  EXPECT_EQ(shown.display().headline, "Guide is off");
  EXPECT_EQ(shown.display().detail,
            "Its tip is 3.2 mm from the control point: measure the femoral guide in Set up");
  // Found to be there after this picture was worked in.
  guide = {operation::GuideStanding::Checked, 0.4};
  EXPECT_FALSE(shown.display().guidance_is_valid);
  EXPECT_EQ(shown.display().headline, "Guide checked");
  shown.operation.frame.guidance.state = GuidanceState::Valid;
  EXPECT_TRUE(shown.display().guidance_is_valid);
}

// However young the picture is: it repeats one that is too old.
TEST(NavigateDisplay, Hazard3WhatIsShownOnIsAsOldAsItsFirstPicture) {
  for (const double shown_for_s : {0.06, 0.1}) {
    const NavigateDisplay display = display_after([&](Shown& shown) {
      shown.live.captured_s = kNow_s - 0.02;
      shown.live.shown_for_s = shown_for_s;
      shown.live.stale_after_s = 0.1;
    });
    EXPECT_EQ(display.is_live, shown_for_s < 0.08);
    EXPECT_NEAR(display.age_s, 0.02 + shown_for_s, 1e-9);
  }
}

// Of a source whose pictures grow too old before the next one comes nothing guides, however young this one
// is, and what is said stays the same through a picture's whole life. The picture and what was touched are
// shown.
TEST(NavigateDisplay, Hazard3ASlowSourceHidesGuidanceSteadily) {
  for (double age_s = 0.01; age_s < 0.9; age_s += 0.04) {
    const auto slow = [&](const auto& change) {
      return display_after([&](Shown& shown) {
        shown.live.trouble = theatre::SourceTrouble::Slow;
        shown.live.trouble_words = "10 a second are too few";
        shown.operation.timing = operation::PictureTiming::Slow;
        shown.operation.frame.guidance.state = GuidanceState::PicturesSlow;
        shown.live.captured_s = kNow_s - age_s;
        change(shown);
      });
    };
    const NavigateDisplay display = slow([](Shown&) {});
    EXPECT_FALSE(display.guidance_is_valid || display.plan_is_valid || display.tip_is_valid || display.drill);
    EXPECT_EQ(display.is_live && display.overlay_is_valid, age_s < 0.3) << "no touch is taken of older ones";
    EXPECT_EQ(display.headline, "Pictures come too slowly");
    EXPECT_EQ(display.detail, "10 a second are too few");
    const auto guide_lost = [](Shown& s) { s.operation.frame.guidance.state = GuidanceState::GuideLost; };
    EXPECT_EQ(slow(guide_lost).headline, "Pictures come too slowly") << "no guide would help";
    const auto doubted = [](Shown& s) { s.stand(Standing::InDoubt, {"x"}); };
    EXPECT_EQ(slow(doubted).headline, "Registration in doubt") << "what somebody must do comes first";
    if (age_s > 0.3) continue;
    const auto not_registered = [](Shown& s) {
      s.stand(Standing::None, {});
      s.operation.frame.guidance.state = GuidanceState::NoRegistration;
    };
    EXPECT_EQ(slow(not_registered).headline, "Not registered") << "strokes can be drawn";
  }
}

}  // namespace
}  // namespace arthronaut::navigate
