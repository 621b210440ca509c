#include "app/navigate/tracking_words.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "app/navigate/live_words.h"
#include "tests/planning/geometry/shapes.h"

namespace arthronaut::navigate {
namespace {

// Nobody is told to bring a marker into a picture that stands still; what needs no picture goes on.
TEST(WordsWithoutPictures, TakeThePlaceOfWhatNeedsThem) {
  using operation::NextAction;
  using theatre::SourceTrouble;
  EXPECT_EQ(words_without_pictures(SourceTrouble::NoPicture, NextAction::GoOnDrawing),
            "look after cable and camera: no picture comes");
  EXPECT_EQ(
      words_without_pictures(SourceTrouble::NoPicture, NextAction::VerifyByTouch, Eigen::Vector2i(1280, 720)),
      "format changed to 1280 x 720: set the processor back, or choose the camera (K)")
      << "no waiting ends that";
  EXPECT_EQ(words_without_pictures(SourceTrouble::Frozen, NextAction::ShowWorldMarker),
            "look after cable and camera: the picture is frozen");
  EXPECT_NE(words_without_pictures(SourceTrouble::Plain, NextAction::FollowBullseye), "");
  for (const SourceTrouble trouble : {SourceTrouble::None, SourceTrouble::Late, SourceTrouble::Torn})
    EXPECT_EQ(words_without_pictures(trouble, NextAction::GoOnDrawing), "");
  for (const NextAction action :
       {NextAction::ConfirmTimeOut, NextAction::RegisterStrokes, NextAction::RecordDrilled})
    EXPECT_EQ(words_without_pictures(SourceTrouble::NoPicture, action), "");
}

// A time-out and a drilled tunnel are somebody's word: taken without a picture, but not as if there were one.
TEST(WordsWithoutPictures, StandBesideWhatIsTakenOnSomebodysWord) {
  using operation::NextAction;
  using theatre::SourceTrouble;
  EXPECT_EQ(words_beside_no_picture(SourceTrouble::NoPicture, NextAction::RecordDrilled) +
                words_of(NextAction::RecordDrilled),
            "no picture comes; press when the tunnel is drilled");
  EXPECT_EQ(words_beside_no_picture(SourceTrouble::Frozen, NextAction::ConfirmTimeOut)
                .find("the picture is frozen; "),
            0U);
  EXPECT_EQ(words_beside_no_picture(SourceTrouble::None, NextAction::RecordDrilled), "");
  EXPECT_EQ(words_beside_no_picture(SourceTrouble::Late, NextAction::RecordDrilled), "");
  for (const SourceTrouble trouble :
       {SourceTrouble::NoPicture, SourceTrouble::Plain, SourceTrouble::Frozen, SourceTrouble::Torn}) {
    EXPECT_TRUE(theatre::shows_nothing(trouble)) << "what is recorded beside it";
    EXPECT_NE(words_beside_no_picture(trouble, NextAction::ConfirmTimeOut), "") << to_text(trouble);
  }
  EXPECT_EQ(words_beside_no_picture(SourceTrouble::NoPicture, NextAction::Draw), "");
}

// Where a card stands in the place of the reasons, what is wrong with the source is told beside the step.
TEST(WhyNotLive, IsToldWhileTheSourceIsToBlame) {
  using theatre::SourceTrouble;
  theatre::LiveState live;
  live.phase = theatre::LiveState::Phase::Running;
  live.trouble_words = "udp://@:5000: nothing";
  for (const SourceTrouble trouble : {SourceTrouble::NoPicture, SourceTrouble::Plain, SourceTrouble::Frozen,
                                      SourceTrouble::Torn, SourceTrouble::Late, SourceTrouble::Slow}) {
    live.trouble = trouble;
    EXPECT_EQ(why_not_live(live), live.trouble_words) << to_text(trouble);
  }
  for (const SourceTrouble trouble : {SourceTrouble::None, SourceTrouble::Repeated, SourceTrouble::Lost}) {
    live.trouble = trouble;
    EXPECT_EQ(why_not_live(live), "") << to_text(trouble);
  }
  live.trouble = SourceTrouble::NoPicture;
  live.phase = theatre::LiveState::Phase::Ended;
  EXPECT_EQ(why_not_live(live), "");
  live.phase = theatre::LiveState::Phase::Failed;
  live.message = "camera 0 was pulled out";
  EXPECT_EQ(why_not_live(live), live.message);
}

// Nor is anybody told, of a step that he went back to, to follow what is not there.
TEST(WordsWithoutPictures, TakeThePlaceOfWhatIsToBeDoneOnceMore) {
  using operation::Step;
  using theatre::SourceTrouble;
  EXPECT_EQ(words_of(Repeat::ShowGuide, Step::Guide, true, SourceTrouble::None), "follow the bullseye");
  EXPECT_EQ(words_of(Repeat::ShowGuide, Step::Guide, true, SourceTrouble::NoPicture),
            "look after cable and camera: no picture comes");
  EXPECT_EQ(
      words_of(Repeat::Touch, Step::Verify, false, SourceTrouble::NoPicture, Eigen::Vector2i(1280, 720)),
      "format changed to 1280 x 720: set the processor back, or choose the camera (K)");
  EXPECT_EQ(words_of(Repeat::Touch, Step::Verify, false, SourceTrouble::Frozen),
            "look after cable and camera: the picture is frozen");
  for (const Repeat repeat : {Repeat::ShowPlan, Repeat::NotDrilled, Repeat::RegisterAnew, Repeat::ShowGuide})
    EXPECT_EQ(words_of(repeat, Step::Guide, false, SourceTrouble::Plain), words_of(repeat, Step::Guide));
}

using widgets::Severity;
using Phase = theatre::LiveState::Phase;

// A camera that is recorded, 20 ms ago its newest picture.
struct Recorded {
  theatre::LiveState live;
  double now_s = 100;

  Recorded() {
    auto source = std::make_shared<operation::SourceSetup>();
    source->kind = sources::SourceKind::Live;
    auto operation = std::make_shared<operation::OperationState>();
    operation->has_source = true;
    operation->source = source;
    operation->frame.processing_ms = 12;
    live.operation = operation;
    live.phase = Phase::Running;
    live.picture = std::make_shared<camera::Frame>();
    live.captured_s = now_s - 0.02;
    live.stale_after_s = 0.1;
    live.frames_per_second = 30;
    live.session_folder = "0001-20260131-120000";
  }
  [[nodiscard]] std::vector<SeverityText> rows() const { return record_rows(live, display_of(&live, now_s)); }
};

TEST(RecordRows, SayWhatIsKeptAndHowFastPicturesCome) {
  Recorded recorded;
  auto rows = recorded.rows();
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].text, "journal");
  EXPECT_EQ(rows[1].text, "30 pictures/s, 12 ms each, 20 ms old");
  recorded.live.keeps_video = true;
  rows = recorded.rows();
  EXPECT_EQ(rows[0].text, "video and journal");
  EXPECT_EQ(rows[0].severity, Severity::Good);
}

// The bone is seen elsewhere and no control point was set before: none is asked for, which could only say
// yes.
TEST(PlaceAnew, IsWhatLeadsOnWhereNoControlPointWasSet) {
  operation::RegistrationState state;
  EXPECT_FALSE(state.must_be_found_anew());
  state.alarm.kind = operation::TouchAlarm::Kind::SeenInPicture;
  state.alarm.seen_drift_mm = 1.2;
  state.in_force.standing = operation::Standing::Alarm;
  EXPECT_TRUE(state.must_be_found_anew());
  EXPECT_NE(trouble_of(state).advice.find("draw anew"), std::string::npos);
  EXPECT_EQ(trouble_of(state).advice.find("again"), std::string::npos);
  state.touches.touch_control_point(Eigen::Vector3d::Zero(), {});
  EXPECT_TRUE(state.must_be_found_anew()) << "set on a bone that may have moved already";
  state.alarm.control_point_decides = true;
  EXPECT_FALSE(state.must_be_found_anew());
  EXPECT_NE(trouble_of(state).advice.find("Touch the control point again"), std::string::npos);
}

// What was asked and stays off is not asked for ever; and where the touches alone speak, nobody says that the
// marker was placed anew.
TEST(PlaceAnew, IsWhatLeadsOnWhereTheControlPointHasSaidAll) {
  operation::RegistrationState state;
  state.in_force.standing = operation::Standing::Alarm;
  state.alarm.kind = operation::TouchAlarm::Kind::ControlPointMoved;
  state.touches.touch_control_point(Eigen::Vector3d::Zero(), {});
  state.touches.add_touch({5, 0, 0}, {});
  EXPECT_FALSE(state.must_be_found_anew()) << "it was not the last that was touched";
  EXPECT_NE(trouble_of(state).advice.find("Touch the control point again"), std::string::npos);
  state.touches.touch_control_point({0, 0, 2.4}, {});
  EXPECT_TRUE(state.must_be_found_anew());
  EXPECT_EQ(trouble_of(state).advice.find("again"), std::string::npos);
  EXPECT_NE(place_anew_words(state.way_out()).find("marker"), std::string::npos);
  state.alarm.kind = operation::TouchAlarm::Kind::Both;
  EXPECT_FALSE(state.must_be_found_anew()) << "back where it was it takes the alarm away";
  state.alarm.kind = operation::TouchAlarm::Kind::TouchesOff;
  EXPECT_TRUE(state.must_be_found_anew());
  EXPECT_EQ(place_anew_words(state.way_out()).find("marker"), std::string::npos);
  EXPECT_NE(trouble_of(state).advice.find("forget them"), std::string::npos);
  state.touches.add_touch({5, 0, 0}, {});
  EXPECT_FALSE(state.must_be_found_anew()) << "whether the marker has moved it tells all the same";
  state.touches.clear();
  EXPECT_TRUE(state.must_be_found_anew()) << "one that is set now tells nothing of before";
}

// The picture tells it, and the control point decides: touched again and half as far off, it has decided.
TEST(PlaceAnew, IsWhatLeadsOnWhereTheControlPointDoesNotDenyThePicture) {
  operation::RegistrationState state;
  state.alarm.kind = operation::TouchAlarm::Kind::SeenInPicture;
  state.alarm.seen_drift_mm = 1.2;
  state.alarm.control_point_decides = true;
  state.touches.touch_control_point(Eigen::Vector3d::Zero(), {});
  EXPECT_FALSE(state.must_be_found_anew());
  state.touches.touch_control_point({0, 0, 0.8}, {});
  EXPECT_TRUE(state.must_be_found_anew());
}

// Never a good sign, since it makes nothing more sure; not checked is said with its reason, a drift in bad.
TEST(ContourRows, SayWhetherTheBoneLiesWhereItLayOrWhyThatIsNotChecked) {
  operation::OperationState state;
  EXPECT_TRUE(contour_rows(state).empty()) << "no registration stands";
  state.contour.reason = contour::NotCheckedReason::TooLittleInView;
  ASSERT_EQ(contour_rows(state).size(), 1U);
  EXPECT_EQ(contour_rows(state)[0].text, "not checked: too little in view that looks as it did");
  EXPECT_EQ(contour_rows(state)[0].severity, Severity::Quiet);
  state.contour.state = contour::ContourState::Holds;
  EXPECT_EQ(contour_rows(state)[0].text, "no shift seen (from 1 to 1.7 mm on)");
  EXPECT_EQ(contour_rows(state)[0].severity, Severity::Quiet);
  state.contour.state = contour::ContourState::LooksOtherwise;
  EXPECT_EQ(contour_rows(state)[0].text, "does not look as it did");
  EXPECT_EQ(contour_rows(state)[0].severity, Severity::Caution);
  state.contour.state = contour::ContourState::Drifted;
  state.contour.drift_mm = 1.14;
  EXPECT_EQ(contour_rows(state)[0].text, "1.1 mm from where it lay");
  EXPECT_EQ(contour_rows(state)[0].severity, Severity::Bad);
}

// What is wrong with the source comes first; then medians with what 99 of 100 keep, and each stage.
TEST(SourceRows, SayWhatIsWrongAndHowLongPicturesTake) {
  Recorded recorded;
  EXPECT_TRUE(source_rows(recorded.live).empty()) << "nothing was counted yet";
  const auto set = [&](theatre::Stage stage, double median_ms, double p99_ms) {
    recorded.live.latency[static_cast<std::size_t>(stage)] = {100, median_ms, p99_ms, p99_ms + 3};
  };
  set(theatre::Stage::ToGuidance, 7.2, 13.8);
  set(theatre::Stage::ToScreen, 34.1, 51.6);
  set(theatre::Stage::Decode, 2.04, 4);
  set(theatre::Stage::Tracking, 4.46, 8);
  auto rows = source_rows(recorded.live);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].text, "7 (14) ms to guidance, 34 (52) ms to the screen");
  EXPECT_EQ(rows[0].severity, Severity::Quiet);
  EXPECT_EQ(rows[1].text, "decode 2.0, tracking 4.5");
  recorded.live.trouble = theatre::SourceTrouble::Late;
  recorded.live.trouble_words = "Pictures are late: 132 ms";
  rows = source_rows(recorded.live);
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0].text, "Pictures are late: 132 ms");
  EXPECT_EQ(rows[0].severity, Severity::Bad);
  EXPECT_EQ(rows[1].severity, Severity::Bad);
  recorded.live.trouble = theatre::SourceTrouble::Torn;
  EXPECT_EQ(source_rows(recorded.live)[0].severity, Severity::Caution) << "what is not torn guides on";
}

// Why the pictures do not come stands beside how old the last one is.
TEST(SourceRows, Hazard33WhyNoPictureComesIsOnTheScreen) {
  Recorded recorded;
  recorded.now_s += 0.6;
  EXPECT_EQ(display_of(&recorded.live, recorded.now_s).detail, "What you see is not live");
  recorded.live.trouble = theatre::SourceTrouble::NoPicture;
  recorded.live.trouble_words = "No picture comes: tower: broke off; connecting again";
  const NavigateDisplay display = display_of(&recorded.live, recorded.now_s);
  EXPECT_FALSE(display.guidance_is_valid);
  EXPECT_EQ(display.detail, recorded.live.trouble_words);
}

// A source that has ended or failed has no rate and no age, and nothing of it is recorded any more.
TEST(RecordRows, Hazard3ADeadSourceHasNoFigures) {
  for (const Phase phase : {Phase::Ended, Phase::Failed}) {
    Recorded recorded;
    recorded.live.phase = phase;
    const auto rows = recorded.rows();
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_EQ(rows[0].name, "Recording");
    EXPECT_EQ(rows[0].text, "ended");
    EXPECT_EQ(rows[0].severity, Severity::Quiet);
  }
}

// A camera that gives no pictures for a while is still recorded, and has no rate.
TEST(RecordRows, Hazard3ASilentSourceHasNoRate) {
  Recorded recorded;
  recorded.live.keeps_video = true;
  recorded.now_s += 5;
  const auto rows = recorded.rows();
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].text, "video and journal; no pictures come");
  EXPECT_EQ(rows[0].severity, Severity::Quiet);
}

// What is not recorded, though it was asked for, stands on the screen and not in the menu alone; the reason
// comes first and not the folder.
TEST(RecordNotice, Hazard14SaysThatTheVideoStopped) {
  Recorded recorded;
  recorded.live.session_folder = "/cases/knee/sessions/0001";
  recorded.live.keeps_video = true;
  EXPECT_EQ(record_notice(recorded.live, true), "");
  recorded.live.keeps_video = false;
  recorded.live.video_trouble = "video.mkv: cannot write: File too large";
  EXPECT_EQ(record_notice(recorded.live, false), "");
  EXPECT_EQ(record_notice(recorded.live, true),
            "The video is not recorded any more, poses and decisions are: video.mkv: cannot write: File too "
            "large");
  recorded.live.record_trouble = "/cases/knee/sessions/0001: recording stopped: only 50 MiB are free";
  EXPECT_EQ(record_notice(recorded.live, false),
            "Record ended early: recording stopped: only 50 MiB are free");
  recorded.live.phase = Phase::Ended;
  EXPECT_EQ(record_notice(recorded.live, true), "");
}

TEST(RecordRows, Hazard13SayWhyNothingIsRecorded) {
  Recorded recorded;
  recorded.live.record_trouble = "the disk is full";
  EXPECT_EQ(recorded.rows()[0].severity, Severity::Bad);
  EXPECT_EQ(recorded.rows()[0].text, "the disk is full");
  recorded.live.session_folder = "/cases/knee/sessions/0001";  // what came before is there
  EXPECT_EQ(recorded.rows()[0].name, "Record ended early");
  recorded.live.session_folder.clear();
  EXPECT_EQ(recorded.rows()[0].name, "Nothing is recorded");
  recorded.live.record_trouble.clear();
  EXPECT_EQ(recorded.rows()[0].name, "Nothing is recorded");
}

// Of what a time-out reads out the panel shows plan and medium, with the knee that they are of.
TEST(BeginningRows, ShowPlanKneeAndMedium) {
  auto source = std::make_shared<operation::SourceSetup>();
  source->pipeline.side = bones::Side::Left;
  source->pipeline.refractive_index = 1.3345;
  operation::OperationState state;
  state.source = source;
  state.bone = bones::BoneKind::Tibia;
  state.depth_stop_mm = 21.5;
  const auto rows = beginning_rows(state, "Muster, Anna", {});
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0].name, "Plan, left, tibia");
  EXPECT_EQ(rows[0].text, "none");
  EXPECT_EQ(rows[1].name, "Medium");
  EXPECT_EQ(rows[1].text, "saline");
  EXPECT_EQ(rows[2].text, "21.5 mm, as read");
}

// How many touches are missing stands in what is asked, where no notice takes its place.
TEST(VerifyingWords, CountDownToTheLastPlace) {
  const geometry::Surface surface(test::box({20, 20, 15}, {0, 0, -15}));
  registration::RegistrationSummary fitted;
  fitted.has_pose = true;
  operation::OperationState state;
  operation::RegistrationState known;
  const auto words_after = [&](const Eigen::Vector3d& tip_mm) {
    known.touches.add_touch(tip_mm, {});
    known.touches.judge(&fitted, &surface, std::nullopt, {});
    state.registration = std::make_shared<const operation::RegistrationState>(known);
    return words_of_verifying(state);
  };
  state.registration = std::make_shared<const operation::RegistrationState>(known);
  EXPECT_EQ(words_of_verifying(state), "touch a place you know, 3 to go");
  EXPECT_EQ(words_after({0, 0, 0.2}), "touch a place you know, 2 to go");
  EXPECT_EQ(words_after({0.5, 0, 0.2}), "touch a place you know, 2 to go") << "the same place";
  EXPECT_EQ(words_after({6, 0, 0.2}), "touch a place you know, 1 to go");
  EXPECT_EQ(words_after({-6, 0, 1.2}), "touch a place you know") << "enough, and one is off";
}

// Why it is asked for is said with it: a surgeon who does not know touches anything.
TEST(CheckingWords, SayWhyTheControlPointIsAskedFor) {
  using operation::ControlPointDue;
  operation::OperationState state;
  EXPECT_EQ(words_of_checking(state), "touch the control point again");
  state.control_point_due = ControlPointDue::CheckBeforeDrilling;
  EXPECT_EQ(words_of_checking(state), "before drilling: touch the control point again");
  state.control_point_due = ControlPointDue::CheckAfterLoss;
  EXPECT_EQ(words_of_checking(state), "marker was out of sight: touch the control point again");
  state.control_point_due = ControlPointDue::CheckLooks;
  EXPECT_EQ(words_of_checking(state), "bone looks otherwise: touch the control point again");
  state.control_point_due = ControlPointDue::CannotCheckLooks;
  state.places_in_doubt = 2;
  EXPECT_EQ(words_of_verifying(state), "bone looks otherwise: touch places that you know, 2 to go");
  state.control_point_due = ControlPointDue::CannotCheckLoss;
  EXPECT_EQ(words_of_verifying(state), "marker was out of sight: touch places that you know, 2 to go");
}

// Why a touch was refused is told for long enough to be read, and while it can be mended: no longer once the
// source has ended.
TEST(RefusalNotice, SaysWhatWasNotDoneAndWhy) {
  constexpr double kNow_s = 100;
  theatre::LiveState live;
  operation::OperationState state;
  const auto notice = [&](double now_s) {
    live.operation = std::make_shared<const operation::OperationState>(state);
    return refusal_notice(live, now_s);
  };
  EXPECT_EQ(notice(kNow_s), "");
  live.refused_s = kNow_s;
  state.has_source = true;
  state.touch_refusal = operation::TouchRefusal::TipMoves;
  EXPECT_EQ(notice(kNow_s + 1), "no touch: the probe moves");
  state.frame.guidance.state = guidance::GuidanceState::Valid;
  EXPECT_EQ(notice(kNow_s + 1), "") << "the probe was put aside, and the guide is aimed";
  state.frame.tip_is_valid = true;
  EXPECT_EQ(notice(kNow_s + 1), "no touch: the probe moves");
  state.touch_is_of_guide = true;  // what was asked for was no touch
  EXPECT_EQ(notice(kNow_s + 1), "guide not checked: the guide moves");
  state.touch_is_of_guide = false;
  state.touch_refusal = operation::TouchRefusal::MarkerIsSeen;
  EXPECT_EQ(notice(kNow_s + 1), "marker not out: it is still seen");
  EXPECT_EQ(notice(kNow_s + 9), "");
  // The newest reason is the one of now.
  live.refusal.words = "no touch: picture 0.6 s old";
  EXPECT_EQ(notice(kNow_s + 1), live.refusal.words);
  EXPECT_EQ(notice(kNow_s + 9), "");
  live.refusal.words.clear();
  state.has_source = false;
  EXPECT_EQ(notice(kNow_s + 1), "");
  state.touch_refusal = operation::TouchRefusal::NoSource;
  EXPECT_EQ(notice(kNow_s + 1), "no touch: no pictures come");
}

}  // namespace
}  // namespace arthronaut::navigate
