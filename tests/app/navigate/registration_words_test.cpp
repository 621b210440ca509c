#include "app/navigate/registration_words.h"

#include <gtest/gtest.h>

#include "navigation/operation/operation.h"

namespace arthronaut::navigate {
namespace {

using operation::RegistrationOrigin;
using operation::Standing;
using widgets::Severity;
using Phase = theatre::LiveState::Phase;

constexpr const char* kReason = "the medium was saline and is air now";

operation::SourceSetup source_of(sources::SourceKind kind) {
  operation::SourceSetup source;
  source.kind = kind;
  source.pipeline.tools = tools::standard_tools();
  return source;
}

operation::RegistrationEntry entry_of(sources::SourceKind kind) {
  auto found = std::make_shared<registration::RegistrationSummary>();
  found->has_pose = found->reliable = true;
  found->reasons.clear();
  found->assumptions = {"the cartilage was left out"};
  found->predicted_tre_mm = 0.7;
  found->rms_mm = 0.2;
  found->runner_up_ratio = 20;
  operation::RegistrationEntry entry;
  entry.registration = found;
  entry.of = operation::provenance_of({}, source_of(kind));
  return entry;
}

// A live source; in force is one that was found with it, and what is drawn on makes a better candidate with
// one stroke that fits well.
struct Known {
  operation::RegistrationState registration;
  std::vector<operation::RegistrationEntry> history{entry_of(sources::SourceKind::Live)};
  theatre::LiveState live;
  operation::TimeOut time_out = operation::TimeOut::Confirmed;

  Known() {
    auto online = std::make_shared<registration::OnlineResult>();
    online->state = registration::OnlineState::Candidate;
    online->registration = *history[0].registration;
    online->registration.predicted_tre_mm = 0.3;
    online->coach.progress = 0.8;
    online->strokes.resize(1);
    online->strokes[0].length_mm = 30;
    online->strokes[0].median_residual_mm = 0.2;
    registration.online = online;
    live.phase = Phase::Running;
    stand(Standing::Stands);
  }
  void stand(Standing standing) {
    auto summary = std::make_shared<registration::RegistrationSummary>(*history[0].registration);
    summary->reliable = standing == Standing::Stands;
    if (!summary->reliable) summary->reasons = {kReason};
    registration.in_force = {};
    registration.in_force.standing = standing;
    registration.in_force.is_verified = standing == Standing::Stands;
    registration.entry_in_force.reset();
    if (standing == Standing::None) return;
    registration.in_force.registration = summary;
    registration.entry_in_force = 0;
  }
  bool marker_is_out = false, has_source = false;
  [[nodiscard]] RegistrationWords words() const { return words_of(whole()); }
  [[nodiscard]] theatre::LiveState whole() const {
    operation::RegistrationState known = registration;
    known.history = std::make_shared<const std::vector<operation::RegistrationEntry>>(history);
    auto operation = std::make_shared<operation::OperationState>();
    operation->source = std::make_shared<const operation::SourceSetup>(source_of(sources::SourceKind::Live));
    operation->registration = std::make_shared<const operation::RegistrationState>(known);
    operation->time_out = time_out;
    operation->marker_is_out = marker_is_out;
    operation->has_source = has_source;
    theatre::LiveState whole = live;
    whole.operation = operation;
    return whole;
  }
};

bool is_good(const RegistrationWords& words) {
  bool is_good = words.state.severity == Severity::Good;
  for (const SeverityText& row : words.numbers) is_good = is_good || row.severity == Severity::Good;
  for (const SeverityText& row : words.history) is_good = is_good || row.severity == Severity::Good;
  for (const StrokeRow& row : words.strokes) is_good = is_good || row.text.severity == Severity::Good;
  return is_good;
}

// A control point that was set before the marker was hit says nothing of now.
TEST(RegistrationWords, NothingIsGreenBesideAnAlarm) {
  Known known;
  known.registration.touches.touch_control_point({0, 0, 0}, {});
  EXPECT_EQ(known.words().touch->number.severity, Severity::Good);
  known.registration.alarm.kind = operation::TouchAlarm::Kind::SeenInPicture;
  known.stand(Standing::Alarm);
  const RegistrationWords words = known.words();
  EXPECT_EQ(words.state.severity, Severity::Bad);
  EXPECT_EQ(words.touch->number.severity, Severity::Quiet);
}

// Nor beside a picture of before: what was good then nobody knows of now.
TEST(RegistrationWords, NothingIsGreenBesideAPictureThatIsNotOfNow) {
  using widgets::Severity;
  RegistrationWords words;
  words.state = {Severity::Good, "Confirmed", ""};
  words.numbers = {{Severity::Good, "At the tunnel", ""}, {Severity::Bad, "Next best pose", ""}};
  words.touch = TouchText{{Severity::Good, "Touch 1", ""}, ""};
  words = without_praise(words);
  EXPECT_EQ(words.state.severity, Severity::Quiet);
  EXPECT_EQ(words.touch->number.severity, Severity::Quiet);
  EXPECT_EQ(words.numbers[0].severity, Severity::Quiet);
  EXPECT_EQ(words.numbers[1].severity, Severity::Bad) << "what is bad stays so";
}

// Where nothing guides yet, nothing is to be judged.
TEST(RegistrationWords, SpeakOfWhatGuidesOnlyWhereSomethingDoes) {
  Known known;
  known.live.phase = Phase::Failed;
  known.live.message = "no such kind of address";
  EXPECT_NE(known.words().state.text, "");
  known.history.clear();
  known.registration = operation::RegistrationState();
  EXPECT_EQ(known.words().state.text, "");
}

// The figures are those of what guides, not of a candidate that runs along beside it.
TEST(RegistrationWords, ShowsTheFiguresOfWhatStands) {
  const RegistrationWords words = Known().words();
  ASSERT_EQ(words.numbers.size(), 2U);
  EXPECT_EQ(words.numbers[0].text, widgets::plus_minus(0.7) + " mm");
  EXPECT_EQ(words.numbers[0].severity, Severity::Good);
  EXPECT_EQ(words.numbers[1].name + " " + words.numbers[1].text, "No other pose comes near");
  EXPECT_EQ(words.state.name, "Verified");
  EXPECT_EQ(words.strokes.at(0).text.severity, Severity::Good);
}

// Words and colours follow the verdict's own limits: what it relies on is not called bad, and what it would
// not is.
TEST(RegistrationWords, ColoursFollowTheVerdict) {
  const auto numbers = [](Standing standing, double error_mm, double ratio) {
    Known known;
    auto found = std::make_shared<registration::RegistrationSummary>(*known.history[0].registration);
    found->predicted_tre_mm = error_mm;
    found->runner_up_ratio = ratio;
    known.history[0].registration = found;
    auto online = std::make_shared<registration::OnlineResult>(*known.registration.online);
    online->registration = *found;
    known.registration.online = online;
    known.stand(standing);
    return known.words().numbers;
  };
  constexpr double kLittle = 1e-6;
  const double most_mm = registration::kMaxError_mm, alike = registration::kAlikeRatio;
  EXPECT_EQ(numbers(Standing::Stands, most_mm, 20).at(0).severity, Severity::Good);
  EXPECT_EQ(numbers(Standing::Stands, most_mm + kLittle, 20).at(0).severity, Severity::Bad);
  EXPECT_EQ(numbers(Standing::None, most_mm, 20).at(0).severity, Severity::Caution);
  EXPECT_EQ(numbers(Standing::None, most_mm + kLittle, 20).at(0).severity, Severity::Bad);
  EXPECT_EQ(numbers(Standing::None, 0.5, alike - kLittle).at(1).severity, Severity::Bad);
  EXPECT_EQ(numbers(Standing::Stands, 0.5, alike - kLittle).at(1).severity, Severity::Caution);
  EXPECT_EQ(numbers(Standing::Stands, 0.5, alike - kLittle).at(1).text, "fits almost alike");
  EXPECT_EQ(numbers(Standing::Stands, 0.5, alike).at(1).text, "fits 1.1 times worse");
  EXPECT_EQ(numbers(Standing::Stands, 0.5, registration::kNoRivalRatio).at(1).text, "comes near");
}

// A control point that does not deny what the picture shows is not called where it was beside the alarm.
TEST(RegistrationWords, AControlPointThatDeniesNothingIsNotCalledGood) {
  Known known;
  known.stand(Standing::Alarm);
  known.registration.touches.touch_control_point({0, 0, 0}, {});
  known.registration.touches.touch_control_point({0, 0, 0.8}, {});
  ASSERT_TRUE(touch_of(known.registration));
  EXPECT_EQ(touch_of(known.registration)->number.severity, Severity::Good);
  known.registration.alarm.kind = operation::TouchAlarm::Kind::SeenInPicture;
  known.registration.alarm.seen_drift_mm = 1.2;
  EXPECT_EQ(touch_of(known.registration)->number.severity, Severity::Caution);
  EXPECT_EQ(touch_of(known.registration)->sentence.find("where it was"), std::string::npos);
}

// What must not guide has no figures, whatever runs along.
TEST(RegistrationWords, WhatDoesNotStandHasNoFigures) {
  for (const Standing standing :
       {Standing::NotReliable, Standing::Void, Standing::Alarm, Standing::InDoubt}) {
    Known known;
    known.stand(standing);
    const RegistrationWords words = known.words();
    EXPECT_TRUE(words.numbers.empty()) << to_text(standing);
    EXPECT_TRUE(words.assumed.empty()) << to_text(standing);
    EXPECT_NE(words.state.severity, Severity::Good) << to_text(standing);
  }
}

// Before anything is in force the candidate's figures help to draw on; nothing of them is called good.
TEST(RegistrationWords, FiguresOfACandidateAreNeverGood) {
  Known known;
  known.history.clear();
  known.registration.in_force = {};
  known.registration.entry_in_force.reset();
  const RegistrationWords words = known.words();
  ASSERT_EQ(words.numbers.size(), 2U);
  EXPECT_NE(words.numbers[0].text.find("0.3"), std::string::npos);
  for (const SeverityText& row : words.numbers) EXPECT_EQ(row.severity, Severity::Caution) << row.name;
}

// A void registration is told with its reason and without a verdict, and so is every other one in the list
// that is not of these pictures; the strokes beside it say nothing good either.
TEST(RegistrationWords, Hazard1AVoidRegistrationIsNowhereGood) {
  Known known;
  known.stand(Standing::Void);
  known.history = {entry_of(sources::SourceKind::Simulation), entry_of(sources::SourceKind::Simulation)};
  const RegistrationWords words = known.words();
  EXPECT_FALSE(is_good(words));
  EXPECT_EQ(words.history.at(0).severity, Severity::Quiet);
  EXPECT_EQ(words.history.at(0).text, kReason);
  EXPECT_EQ(words.history.at(1).severity, Severity::Quiet);
  EXPECT_NE(words.history.at(1).text.find("another kind of pictures"), std::string::npos);
  EXPECT_EQ(words.strokes.at(0).text.severity, Severity::Quiet);
  // One that was found with these pictures may be taken.
  known.history.push_back(entry_of(sources::SourceKind::Live));
  EXPECT_EQ(known.words().history.at(2).severity, Severity::Good);
}

// An alarm and a doubt belie the figures of the list as well.
TEST(RegistrationWords, TheListCallsNothingGoodThatIsInDoubt) {
  for (const Standing standing : {Standing::Alarm, Standing::InDoubt}) {
    Known known;
    known.stand(standing);
    EXPECT_EQ(known.words().history.at(0).severity, Severity::Bad) << to_text(standing);
    EXPECT_EQ(known.words().history.at(0).text, kReason) << to_text(standing);
  }
}

// While the probe draws: where next, and what is missing of it in figures; where the bone itself is in doubt
// no further stroke is asked for before that is told.
TEST(RegistrationWords, SayWhereToDrawNextUnlessTheBoneIsInDoubt) {
  Known known;
  known.history.clear();
  known.stand(Standing::None);
  auto online = std::make_shared<registration::OnlineResult>(*known.registration.online);
  online->coach.message = "Draw next nearer to the foot.";
  online->coach.missing = {"too little was touched: draw 36 mm more", "draw 20 mm more, to be sure"};
  known.registration.online = online;
  EXPECT_EQ(known.words().state.name, "Bone position not sure yet");
  EXPECT_EQ(known.words().state.text, "Draw next nearer to the foot.");
  EXPECT_EQ(known.words().missing, "too little was touched: draw 36 mm more; draw 20 mm more, to be sure");
  online->bone_is_in_doubt = true;
  EXPECT_EQ(known.words().state.text, "");
  EXPECT_NE(known.words().missing, "");
  // Before there is a pose how much more to draw says what to do.
  online->bone_is_in_doubt = false;
  online->state = registration::OnlineState::Collecting;
  EXPECT_EQ(known.words().state.text, "");
  online->coach.missing.clear();
  EXPECT_EQ(known.words().state.text, "Draw next nearer to the foot.");
}

// A candidate that is confirmed while something else is in force, which is not reliable, guides nothing.
TEST(RegistrationWords, WhatIsNotInForceIsNotCalledConfirmed) {
  Known known;
  auto online = std::make_shared<registration::OnlineResult>(*known.registration.online);
  online->state = registration::OnlineState::Confirmed;
  known.registration.online = online;
  known.stand(Standing::NotReliable);
  EXPECT_EQ(known.words().state.name, "Registration not reliable");
  known.stand(Standing::None);
  EXPECT_NE(known.words().state.severity, Severity::Good);
}

// While another source is being opened nobody knows what the registration is worth with it; one that could
// not be opened leaves it so.
TEST(RegistrationWords, Hazard2NothingIsGoodBeforeTheFirstPictureOfASource) {
  Known known;
  ASSERT_TRUE(is_good(known.words()));
  for (const Phase phase : {Phase::Starting, Phase::Failed}) {
    known.live.phase = phase;
    const RegistrationWords words = known.words();
    EXPECT_FALSE(is_good(words));
    EXPECT_EQ(words.state.name, "No picture yet");
    EXPECT_TRUE(words.numbers.empty());
    EXPECT_EQ(words.progress, 0);
    EXPECT_EQ(words.strokes.size(), 1U) << "what was drawn can still be chosen";
  }
  known.live.picture = std::make_shared<camera::Frame>();  // it gave some before it failed
  EXPECT_TRUE(is_good(known.words()));
}

// Whoever scratches before the time-out loses nothing of it, and reads no number of a patient whom nobody has
// confirmed.
TEST(RegistrationWords, Hazard20NothingIsGoodBeforeTheTimeOut) {
  Known known;
  known.time_out = operation::TimeOut::Due;
  const RegistrationWords words = known.words();
  EXPECT_EQ(words.state.name, "Waits for the time-out");
  EXPECT_TRUE(words.numbers.empty());
  EXPECT_FALSE(is_good(words));
  known.time_out = operation::TimeOut::Confirmed;
  EXPECT_EQ(known.words().state.name, "Verified");
  known.time_out = operation::TimeOut::Due;
  known.stand(Standing::Void);
  EXPECT_NE(known.words().state.name, "Waits for the time-out") << "that alone would not bring it back";
}

// What guides need not have been drawn here: brought back after a crash, or given, it stands, and is to be
// verified as the steps say, whatever is drawn beside it.
TEST(RegistrationWords, WhatStandsWithoutStrokesIsNotCollected) {
  for (const bool is_drawn : {false, true}) {
    Known known;
    known.registration.in_force.is_verified = false;
    if (!is_drawn) known.registration.online = nullptr;
    const RegistrationWords words = known.words();
    EXPECT_EQ(words.state.name, "Confirmed");
    EXPECT_EQ(words.state.text, "Touch 3 places that you know, to verify.");
    EXPECT_EQ(words.missing, "");
    EXPECT_EQ(words.progress, 1);
  }
}

// Nothing is collected before the time-out, and nobody is told to draw.
TEST(RegistrationWords, Hazard20NothingIsCollectedBeforeTheTimeOut) {
  Known known;
  known.registration = operation::RegistrationState();
  known.time_out = operation::TimeOut::Due;
  known.has_source = true;
  const RegistrationWords words = known.words();
  EXPECT_EQ(words.state.name, "Waits for the time-out");
  EXPECT_EQ(words.state.text, "Nothing is drawn or touched before patient, knee and plan are confirmed.");
  EXPECT_EQ(words.progress, 0);
}

// The steps and these words read the same: what the step of verifying lacks is not called verified here.
TEST(RegistrationWords, AreNotVerifiedBeforeTheWholeStepIs) {
  Known known;
  const auto words = [&](operation::ControlPointDue due, operation::GuideStanding guide,
                         operation::DrilledState::Outcome drilled) {
    theatre::LiveState whole = known.whole();
    auto state = std::make_shared<operation::OperationState>(*whole.operation);
    state->verification = operation::Verification::ByTouches;
    state->control_point_due = due;
    state->guide_check.standing = guide;
    state->drilled.outcome = drilled;
    whole.operation = state;
    return words_of(whole).state;
  };
  using operation::ControlPointDue;
  using operation::GuideStanding;
  using Outcome = operation::DrilledState::Outcome;
  EXPECT_EQ(words(ControlPointDue::None, GuideStanding::NotAsked, Outcome::NotSaid).name, "Verified");
  const SeverityText no_point = words(ControlPointDue::Set, GuideStanding::NotAsked, Outcome::NotSaid);
  EXPECT_EQ(no_point.name, "No control point");
  EXPECT_EQ(no_point.severity, Severity::Caution);
  EXPECT_EQ(words(ControlPointDue::None, GuideStanding::Due, Outcome::NotSaid).name, "Guide not checked");
  EXPECT_EQ(words(ControlPointDue::Set, GuideStanding::NotAsked, Outcome::Recorded).name, "Verified")
      << "of a tunnel that is recorded no control point is asked";
  known.registration.touches.touch_control_point({0, 0, 0}, {});
  EXPECT_EQ(words(ControlPointDue::CheckAfterLoss, GuideStanding::NotAsked, Outcome::NotSaid).name,
            "Control point to be touched");
}

// Without pictures nothing is collected, and nobody is told to draw: no camera, or all is done.
TEST(RegistrationWords, NothingIsCollectedWithoutPictures) {
  Known known;
  known.registration = operation::RegistrationState();
  EXPECT_EQ(known.words().state.name, "Bone not found yet");
  for (const Phase phase : {Phase::NoSource, Phase::Ended}) {
    known.live.phase = phase;
    EXPECT_EQ(known.words().state.name, "Not registered");
    EXPECT_EQ(known.words().state.text, "");
  }
  known.registration.point_count = 40;
  EXPECT_NE(known.words().state.text, "");
  known.marker_is_out = true;
  EXPECT_EQ(known.words().state.name, "The marker is out");
  known.live.phase = Phase::Running;
  EXPECT_EQ(known.words().state.name, "The marker is out");
}

// A pedal that is pressed again where it was pressed before verifies nothing more: that is said, in large.
TEST(RegistrationWords, APlaceThatWasTouchedAlreadyIsTold) {
  Known known;
  auto online = std::make_shared<registration::OnlineResult>(*known.registration.online);
  online->state = registration::OnlineState::Confirmed;
  known.registration.online = online;
  known.registration.in_force.is_verified = false;
  const Eigen::Vector3d corner(0, 0, 0);
  const geometry::TriangleMesh mesh{{corner, {50, 0, 0}, {0, 50, 0}}, {{0, 1, 2}}};
  const geometry::Surface surface(mesh);
  operation::Touches& touches = known.registration.touches;
  const auto touch = [&](const Eigen::Vector3d& at_mm) {
    touches.add_touch(at_mm, {});
    touches.judge(known.registration.in_force.registration.get(), &surface, std::nullopt, {});
    return known.words().state.text;
  };
  EXPECT_EQ(touch({10, 10, 0}), "Touch 2 more places that you know, to verify.");
  EXPECT_EQ(touch({10.2, 10, 0}), "This place was touched already. Touch 2 others that you know.");
  EXPECT_EQ(touch({20, 20, 0}), "Touch 1 more place that you know, to verify.");
}

}  // namespace
}  // namespace arthronaut::navigate
