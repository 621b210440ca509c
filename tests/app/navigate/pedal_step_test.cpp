#include "app/navigate/pedal_step.h"

#include <gtest/gtest.h>

#include "app/navigate/navigate_choices.h"
#include "tests/app/navigate/shown_operation.h"

namespace arthronaut::navigate {
namespace {

using operation::NextAction;
using Kind = PedalStep::Kind;

const tunnels::TunnelKey kAm(bones::BoneKind::Femur, norms::Bundle::Anteromedial);

operation::PlannedTunnel am_of_width(double diameter_mm) {
  operation::PlannedTunnel plan;
  plan.length_mm = 30;
  plan.tunnel.bundle = kAm.bundle;
  plan.tunnel.diameter_mm = diameter_mm;
  return plan;
}

// A tunnel guides, and nothing stands beside the operation.
struct AtThePedal {
  Shown shown;
  PedalContext context;

  explicit AtThePedal(NextAction action) {
    shown.operation.next_action = action;
    shown.operation.plan = am_of_width(8);
    context.has_case = true;
    context.guided = kAm;
  }
  void edit_plan(double diameter_mm) {
    shown.operation.plan_was_edited = true;
    shown.operation.edited_plan = am_of_width(diameter_mm);
  }
  [[nodiscard]] PedalStep step() const { return pedal_step(shown.whole(), context); }
  [[nodiscard]] std::string words() const { return words_of(step(), shown.whole(), context); }
};

// No press takes over what nobody could see in force: the line says what comes first.
TEST(PedalStep, AsksForNoTakeOverThatAPressWouldNotDo) {
  AtThePedal theatre(NextAction::TakePlanOver);
  theatre.edit_plan(9);
  EXPECT_EQ(theatre.words(), "take over the tunnel femur AM");
  EXPECT_TRUE(acts(theatre.step()));
  theatre.shown.operation.medium.fit = pipeline::MediumFit::Contradicts;
  EXPECT_TRUE(theatre.words().starts_with("wrong medium")) << theatre.words();
  EXPECT_FALSE(acts(theatre.step()));
  theatre.shown.live.picture = nullptr;
  EXPECT_EQ(theatre.words(), "wait for the first picture");
  EXPECT_FALSE(acts(theatre.step()));
}

// Nobody in theatre has a hand for a keyboard: where the pictures can be begun again in the medium that they
// look like, a press ends them for that, once it was read.
TEST(PedalStep, TakesTheMediumThatThePicturesLookLike) {
  AtThePedal theatre(NextAction::FollowBullseye);
  theatre.shown.operation.medium = {
      .fit = pipeline::MediumFit::Contradicts, .stated_index = 1, .other_index = 1.3345};
  EXPECT_FALSE(acts(theatre.step()));
  theatre.context.may_change_medium = true;
  EXPECT_EQ(theatre.words(), "the pictures look like saline: end them, and take saline next");
  EXPECT_TRUE(acts(theatre.step()));
  EXPECT_TRUE(must_be_read(theatre.step()));
}

// The other way round: where a press takes over the plan of an operation that began without one, it is said.
TEST(PedalStep, SaysThatAPressTakesOverTheFirstPlan) {
  AtThePedal theatre(NextAction::PlanTunnel);
  theatre.edit_plan(9);
  theatre.shown.operation.plan.reset();
  theatre.context.guided->bundle = norms::Bundle::Whole;
  theatre.context.start = "open the camera again";
  EXPECT_EQ(theatre.step().kind, Kind::TakePlanOver);
  EXPECT_EQ(theatre.words(), "a tunnel was planned: take it over");
}

// What flickers beside a question is no other question: who has read it need not read it again.
TEST(PedalStep, StaysTheSameWhilePicturesFlicker) {
  for (const NextAction action : {NextAction::ConfirmTimeOut, NextAction::RecordDrilled}) {
    AtThePedal theatre(action);
    const PedalStep before = theatre.step();
    const std::string words = theatre.words();
    theatre.shown.live.trouble = theatre::SourceTrouble::NoPicture;
    EXPECT_EQ(theatre.words(), "no picture comes; " + words);
    EXPECT_TRUE(theatre.step() == before);
    EXPECT_TRUE(must_be_read(before) && acts(before));
  }
}

// Nor is the marker said to be out, by anybody but the surgeon, while no picture shows it.
TEST(PedalStep, SaysThatNoPictureShowsWhetherTheMarkerIsOut) {
  AtThePedal theatre(NextAction::Finish);
  theatre.context.bones = {{bones::BoneKind::Femur, {{bones::BoneKind::Femur, true, {}, false}}, false}};
  EXPECT_EQ(theatre.words(), "take the femur's marker out, then press");
  theatre.shown.live.trouble = theatre::SourceTrouble::NoPicture;
  EXPECT_EQ(theatre.words(), "no picture comes; take the femur's marker out, then press: your word alone");
  theatre.shown.live.phase = theatre::LiveState::Phase::Ended;
  EXPECT_EQ(theatre.words(), "take the femur's marker out, then press");
}

// A plan that takes the place of the one that was read is read anew, however alike the two are in words; so
// is one of which something else is known by now.
TEST(PedalStep, IsAnotherOneWithAnotherPlan) {
  AtThePedal theatre(NextAction::TakePlanOver);
  theatre.edit_plan(9);
  NavigateChoices choices;
  choices.note_pedal(theatre.step(), 1);
  choices.note_pedal(theatre.step(), 2);
  EXPECT_EQ(choices.pedal_since_s, 1);
  theatre.shown.operation.edited_plan->tunnel.entry_mm.x() += 2;
  choices.note_pedal(theatre.step(), 3);
  EXPECT_EQ(choices.pedal_since_s, 3);
  theatre.context.edited_verdict = tunnels::PlanCheck::Verdict::Wrong;
  choices.note_pedal(theatre.step(), 4);
  EXPECT_EQ(choices.pedal_since_s, 4);

  AtThePedal asked(NextAction::ConfirmTimeOut);
  const PedalStep of_femur = asked.step();
  asked.context.bone = bones::BoneKind::Tibia;
  EXPECT_FALSE(asked.step() == of_femur);
}

// What stands on the screen is answered before what lies behind it.
TEST(PedalStep, AnswersWhatStandsInFront) {
  AtThePedal theatre(NextAction::Draw);
  EXPECT_EQ(theatre.step().kind, Kind::Act);
  theatre.context.looked_at = operation::Step::Guide;
  theatre.context.repeat = Repeat::NotDrilled;
  EXPECT_EQ(theatre.words(), "take back that the tunnel is drilled");
  EXPECT_TRUE(must_be_read(theatre.step()));
  theatre.context.was_left = true;
  EXPECT_EQ(theatre.step().kind, Kind::Resume);
  theatre.context.searches = true;
  EXPECT_FALSE(acts(theatre.step()));
  theatre.context.chooses_pictures = true;
  EXPECT_EQ(theatre.step().kind, Kind::TypeAddress);
  theatre.context.pictures = "microscope";
  EXPECT_EQ(theatre.words(), "open microscope");
}

// The guide that is shown already is followed, not shown again.
TEST(PedalStep, ShowsNothingThatIsShown) {
  AtThePedal theatre(NextAction::Finish);
  theatre.context.looked_at = operation::Step::Guide;
  theatre.context.repeat = Repeat::ShowGuide;
  EXPECT_TRUE(acts(theatre.step()));
  theatre.context.bones = {{bones::BoneKind::Femur, {{kAm, true, {}, false}}, false, false}};
  EXPECT_FALSE(acts(theatre.step()));
  EXPECT_EQ(theatre.words(), "follow the bullseye");
}

}  // namespace
}  // namespace arthronaut::navigate
