// A recorded operation, run again, comes to the same state in every frame.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "navigation/recording/recorded_pictures.h"
#include "navigation/recording/replay.h"
#include "navigation/recording/session_database.h"
#include "navigation/sources/capture_time.h"
#include "planning/files/atomic_file.h"
#include "tests/navigation/simulator/phantom_options.h"
#include "tests/navigation/theatre/theatre_sources.h"
#include "tests/temporary_folder.h"

namespace arthronaut::theatre {
namespace {

using operation::Command;

class ReplayedOperation : public ::testing::Test {
 protected:
  OperationRun::MakeSessionFolder folders() {
    return [this] {
      const auto folder = folder_ / ("session" + std::to_string(++count_));
      std::filesystem::create_directory(folder);
      return folder;
    };
  }
  void expect_replays(const std::string& session, long frames) const {
    recording::ReplayOptions options;
    options.bone = registration::phantom_bone().prepared;
    options.surface = std::make_shared<geometry::Surface>(registration::phantom_bone().mesh);
    const auto summary = recording::replay_session(recording::RecordedSession(folder_ / session), options);
    EXPECT_TRUE(summary.is_same_build);
    EXPECT_EQ(summary.states_compared, frames) << session;
    EXPECT_EQ(summary.states_equal, frames) << session;
    for (const auto& difference : summary.differences)
      ADD_FAILURE() << session << " " << difference.frame << " " << difference.what << " "
                    << difference.detail;
  }
  // Every command there is, each once or more.
  [[nodiscard]] std::vector<Command> commands(const operation::SourceSetup& source) const {
    operation::PlannedTunnel edited = test::phantom_plan();
    edited.length_mm += 1;
    const auto of = operation::provenance_of(setup_, source);
    operation::GiveRegistration resumed = test::true_registration(trial_, of);
    resumed.is_resumed = true;
    return {operation::Draw{true},
            test::true_registration(trial_, of),
            operation::TakeTouch{},
            operation::TouchControlPoint{},
            operation::SkipVerification{},
            operation::OfferPlan{edited},
            operation::TakePlanOver{},
            operation::Draw{true},
            operation::ExcludeStroke{0, true},
            operation::RegisterStrokes{},
            operation::TakeBackStroke{},
            resumed,
            operation::ChooseRegistration{0},
            operation::ReadDepthStop{21.5},
            operation::ConfirmTimeOut{},
            operation::CheckGuide{},
            operation::TunnelDrilled{},
            operation::ForgetTouches{},
            operation::ClearStrokes{},
            operation::MarkerPlacedAnew{},
            test::true_registration(trial_, of)};
  }

  const test::TemporaryFolder folder_;
  int count_ = 0;
  operation::OperationSetup setup_ = test::phantom_setup();
  experiments::Trial trial_ = registration::phantom_bone().trial(experiments::TrialNoise::Dry, 1);
};

// Commands at seeded frames over two sources of one operation, some of them between the sources; the second
// session goes on with what the first made.
TEST_F(ReplayedOperation, EveryCommandOverTwoSourcesGivesTheSameStates) {
  std::mt19937 random(3);
  {
    OperationRun run(setup_, test::at_once(setup_), folders());
    for (const int frames : {60, 50}) {
      const TheatreSource source = test::plain_source(frames);
      run.start(source);
      std::multimap<int, Command> script;
      for (const Command& command : commands(source.setup))
        script.emplace(std::uniform_int_distribution(0, frames - 1)(random), command);
      for (int i = 0; i < frames; ++i) {
        ASSERT_TRUE(run.step().picture);
        const auto [first, end] = script.equal_range(i);
        for (auto it = first; it != end; ++it) run.apply(it->second);
      }
      run.end_source();
      run.apply(operation::SkipVerification{});
      run.apply(operation::OfferPlan{test::phantom_plan()});
    }
  }
  EXPECT_EQ(recording::RecordedSession(folder_ / "session2").header().continues, "session1");
  expect_replays("session1", 60);
  expect_replays("session2", 50);

  // It ends when it is told to, also while it takes in what came before.
  int asked = 0;
  recording::ReplayOptions ended;
  ended.stops = [&] { return ++asked == 20; };
  const auto summary = recording::replay_session(recording::RecordedSession(folder_ / "session2"), ended);
  EXPECT_TRUE(summary.was_stopped);
  EXPECT_EQ(summary.replayed_frames + summary.frames_without_picture, 0);
  EXPECT_EQ(asked, 20);
}

// A record as it was before streams were kept as they come: of a picture the frame alone, one video without
// parts, no bodies and no outside tracker.
void make_older(const std::filesystem::path& session) {
  auto database = recording::SessionDatabase::open(session / "session.sqlite");
  for (const char* const column : {"packet", "start_packet", "start_ms", "luma"})
    database.execute((std::string("ALTER TABLE pictures DROP COLUMN ") + column).c_str());
  database.execute("DROP TABLE bodies; DROP TABLE outside; DROP TABLE latency; PRAGMA user_version = 1");
  auto header = nlohmann::json::parse(files::read_text(session / "session.json"));
  ASSERT_EQ(header.erase("video_parts"), 1U);
  files::write_atomically(session / "session.json", header.dump());
}

TEST_F(ReplayedOperation, ARecordOfTheVersionBeforeGivesTheSameStates) {
  constexpr int kFrames = 40;
  {
    OperationRun run(setup_, test::at_once(setup_), folders());
    const TheatreSource source = test::plain_source(kFrames);
    run.start(source);
    run.keep_video(true);
    for (int i = 0; i < kFrames; ++i) {
      ASSERT_TRUE(run.step().picture);
      if (i == 5) run.apply(commands(source.setup).at(1));
      if (i == 10) run.apply(operation::SkipVerification{});
    }
    run.end_source();
  }
  make_older(folder_ / "session1");
  EXPECT_EQ(recording::RecordedSession(folder_ / "session1").pictures().size(), std::size_t{kFrames});
  expect_replays("session1", kFrames);
  recording::RecordedPictures pictures(recording::read_overview(folder_ / "session1"));
  const auto video = recording::open_recorded_video(recording::RecordedSession(folder_ / "session1"));
  for (int i = 0; i < kFrames; ++i) {
    const camera::FramePtr replayed = video->next();
    ASSERT_NE(replayed, nullptr) << i;
    const camera::FramePtr shown = pictures.picture(replayed->index, replayed->timestamp_ns);
    ASSERT_NE(shown, nullptr) << i;
    EXPECT_EQ(shown->luma, replayed->luma) << i;
  }
}

// Whether a nominal guide may guide is a part of the states, too: due, refused, trusted.
TEST_F(ReplayedOperation, HowANominalGuideStandsIsReplayed) {
  {
    OperationRun run(setup_, test::at_once(setup_), folders());
    TheatreSource source = test::plain_source(30, false, sources::SourceKind::Live);
    source.setup.pipeline.tools.tools.back().provenance.origin = provenance::Origin::Nominal;
    run.start(source);
    for (int i = 0; i < 30;) {
      if (run.step().picture == nullptr) continue;  // a live source may be slow
      if (i == 5) run.apply(operation::ConfirmTimeOut{});
      if (i == 10) run.apply(operation::CheckGuide{});
      if (i == 20) run.apply(operation::TrustGuide{});
      ++i;
    }
    EXPECT_EQ(run.state()->guide_check.standing, operation::GuideStanding::Trusted);
    run.end_source();
  }
  expect_replays("session1", 30);
}

// What was given before any source ran is a part of the operation, too: a registration that stands from the
// first frame keeps the probe from drawing.
TEST_F(ReplayedOperation, WhatWasGivenBeforeTheFirstSourceIsReplayed) {
  {
    OperationRun run(setup_, test::at_once(setup_), folders());
    const TheatreSource source = test::plain_source(20);
    operation::PlannedTunnel edited = test::phantom_plan();
    edited.tunnel.entry_mm.x() += 1;
    run.apply(operation::OfferPlan{edited});
    run.apply(test::true_registration(trial_, operation::provenance_of(setup_, source.setup)));
    (void)run.follow_registration();
    run.start(source);
    EXPECT_FALSE(run.state()->draws);
    for (int i = 0; i < 20; ++i) ASSERT_TRUE(run.step().picture);
    run.end_source();
  }
  expect_replays("session1", 20);
}

// An operation that goes on from one that was cut off holds all of it: it is replayed without the record
// before, which may be gone.
TEST_F(ReplayedOperation, AResumedOneIsReplayedFromItsOwnRecord) {
  const TheatreSource source = test::plain_source(30);
  operation::ResumeOperation resume;
  resume.session = "session0";
  resume.of = resume.registration_of = operation::provenance_of(setup_, source.setup);
  resume.registration = test::true_registration(trial_, resume.of).registration;
  resume.plan = test::phantom_plan();
  resume.plan->length_mm += 1;
  resume.drawn = trial_.curves;
  resume.stroke_count = 3;
  resume.touches_mm = {test::on_bone(trial_, 1)};
  resume.control_point_mm = test::on_bone(trial_, 2);
  resume.depth_stop_mm = 12.25;
  {
    OperationRun run(setup_, test::at_once(setup_), folders());
    run.apply(resume);
    run.start(source);
    for (int i = 0; i < 30; ++i) {
      ASSERT_TRUE(run.step().picture);
      if (i == 10) run.apply(operation::TakePlanOver{});
      if (i == 20) run.apply(operation::ReadDepthStop{13});
    }
    EXPECT_EQ(run.state()->registration->in_force.standing, operation::Standing::Void);
    run.end_source();
    run.start(test::plain_source(10));
    while (run.step().picture != nullptr) {
    }
  }
  EXPECT_EQ(recording::RecordedSession(folder_ / "session1").header().continues, "session0");
  EXPECT_EQ(recording::RecordedSession(folder_ / "session2").header().continues, "session1");
  expect_replays("session1", 30);
  expect_replays("session2", 10);
}

// The simulator's pictures, kept by the record and tracked again: poses, strokes and decisions are the same
// to the last bit.
TEST_F(ReplayedOperation, TheSimulatorsPicturesGiveTheSameStates) {
  constexpr int kFrames = 24;
  simulator::SimulationOptions options = simulator::phantom_options();
  options.frame_count = kFrames;
  TheatreSource source;
  source.setup.kind = sources::SourceKind::Simulation;
  source.setup.pipeline.calibration = options.camera;
  source.setup.pipeline.tools = options.tools;
  source.setup.pipeline.refractive_index = options.refractive_index;
  source.open = [=] {
    return std::make_unique<simulator::SimulatedOperation>(options, simulator::Phase::Scratch);
  };
  long with_tip = 0;
  {
    OperationRun run(setup_, test::at_once(setup_), folders());
    run.start(source);
    run.keep_video(true);
    const std::vector<Command> script = commands(source.setup);
    for (std::size_t i = 0; i < kFrames; ++i) {
      ASSERT_TRUE(run.step().picture);
      with_tip += run.state()->frame.tip_is_valid ? 1 : 0;
      if (i >= 4 && i - 4 < script.size()) run.apply(script[i - 4]);
    }
    run.end_source();
    EXPECT_EQ(run.record_trouble(), "");
  }
  EXPECT_GT(with_tip, 5) << "the test must see something";
  expect_replays("session1", kFrames);

  // A video that is cut off: its whole pictures are tracked again, the rest comes from the record, and what
  // is missing is the one thing that differs.
  const auto video = folder_ / "session1/video.mkv";
  std::filesystem::resize_file(video, std::filesystem::file_size(video) * 6 / 10);
  recording::ReplayOptions with_bone;
  with_bone.bone = registration::phantom_bone().prepared;
  with_bone.surface = std::make_shared<geometry::Surface>(registration::phantom_bone().mesh);
  const auto cut = recording::replay_session(recording::RecordedSession(folder_ / "session1"), with_bone);
  EXPECT_GT(cut.replayed_frames, kFrames / 3);
  EXPECT_EQ(cut.replayed_frames + cut.frames_without_picture, kFrames);
  EXPECT_EQ(cut.states_equal, kFrames);
  ASSERT_EQ(cut.differences.size(), 1U);
  EXPECT_EQ(cut.differences[0].what, "video");
  EXPECT_NE(cut.differences[0].detail.find("video.mkv: frame " + std::to_string(cut.replayed_frames)),
            std::string::npos)
      << cut.differences[0].detail;
}

// Whoever began to keep the video late is told why poses differ from where it begins on: tracking went into
// those pictures with what it knew from the ones before.
TEST_F(ReplayedOperation, SaysThatPosesDifferForPicturesThatWereNotKept) {
  constexpr int kFrames = 14, kBefore = 6;
  simulator::SimulationOptions options = simulator::phantom_options();
  options.frame_count = kFrames;
  TheatreSource source;
  source.setup.kind = sources::SourceKind::Simulation;
  source.setup.pipeline.calibration = options.camera;
  source.setup.pipeline.tools = options.tools;
  source.setup.pipeline.refractive_index = options.refractive_index;
  source.open = [=] {
    return std::make_unique<simulator::SimulatedOperation>(options, simulator::Phase::Scratch);
  };
  {
    OperationRun run(setup_, test::at_once(setup_), folders());
    run.start(source);
    for (int i = 0; i < kFrames; ++i) {
      if (i == kBefore) run.keep_video(true);
      ASSERT_TRUE(run.step().picture);
    }
    run.end_source();
  }
  const recording::RecordedSession session(folder_ / "session1");
  recording::ReplayOptions asks_too_much;  // whatever a pose differs by is too much
  asks_too_much.reencoded_tolerance_mm = asks_too_much.reencoded_tolerance_deg = -1;
  const auto summary = recording::replay_session(session, asks_too_much);
  EXPECT_EQ(summary.states_equal, kFrames);
  EXPECT_EQ(summary.frames_before_pictures, kBefore);
  EXPECT_GT(summary.cold_differences, 0);
  EXPECT_EQ(summary.cold_differences, static_cast<long>(summary.differences.size()));
  EXPECT_NE(recording::cold_start_in_words(summary).find("without the 6 pictures before"), std::string::npos);
  EXPECT_EQ(recording::cold_start_in_words({}), "");
}

// On another build no state is asked to be the same to the last bit: every number of guidance and every
// decision is compared by itself.
TEST_F(ReplayedOperation, EveryNumberAndDecisionThatDiffersIsToldOnAnotherBuild) {
  constexpr int kFrames = 16;
  simulator::SimulationOptions options = simulator::phantom_options();
  options.frame_count = kFrames;
  TheatreSource source;
  source.setup.kind = sources::SourceKind::Simulation;
  source.setup.pipeline.calibration = options.camera;
  source.setup.pipeline.tools = options.tools;
  source.setup.pipeline.refractive_index = options.refractive_index;
  source.open = [=] {
    return std::make_unique<simulator::SimulatedOperation>(options, simulator::Phase::Drill);
  };
  {
    OperationRun run(setup_, test::at_once(setup_), folders());
    run.start(source);
    run.keep_video(true);
    operation::GiveRegistration known =
        test::true_registration(trial_, operation::provenance_of(setup_, source.setup));
    known.registration.marker_from_bone =
        simulator::SimulatedOperation(options, simulator::Phase::Drill).marker_from_bone();
    run.apply(known);
    run.apply(operation::SkipVerification{});
    for (int i = 0; i < kFrames; ++i) ASSERT_TRUE(run.step().picture);
    run.end_source();
  }
  const auto folder = folder_ / "session1";
  std::string header = files::read_text(folder / "session.json");
  const std::string build = recording::build_identity();
  header.replace(header.find(build), build.size(), std::string(build.size(), '0'));
  files::write_atomically(folder / "session.json", header);
  recording::ReplayOptions with_bone;
  with_bone.bone = registration::phantom_bone().prepared;
  with_bone.surface = std::make_shared<geometry::Surface>(registration::phantom_bone().mesh);
  const auto whats_of = [&] {
    std::set<std::string> whats;
    const auto summary = recording::replay_session(recording::RecordedSession(folder), with_bone);
    EXPECT_FALSE(summary.is_same_build);
    for (const auto& difference : summary.differences) whats.insert(difference.what);
    return whats;
  };
  EXPECT_EQ(whats_of(), std::set<std::string>{});

  std::string frame;
  const recording::RecordedSession session(folder);  // whose frames are looked at
  for (const recording::RecordedFrame& recorded : session.frames())
    if (recorded.guidance.is_valid()) frame = std::to_string(recorded.index);
  ASSERT_FALSE(frame.empty()) << "the test must see guidance";
  std::set<std::string> changed{"drill", "alarm", "verification skipped"};
  auto database = recording::SessionDatabase::open(folder / "session.sqlite");
  for (const auto& [column, what] : {std::pair{"tip_to_entry_mm", "guidance tip to entry"},
                                     {"depth_mm", "guidance depth"},
                                     {"offset_anterior_mm", "guidance offset, anterior"},
                                     {"offset_lateral_mm", "guidance offset, lateral"},
                                     {"offset_proximal_mm", "guidance offset, proximal"},
                                     {"sigma_offset_mm", "guidance sigma of offset"},
                                     {"sigma_angle_deg", "guidance sigma of angle"},
                                     {"point_x_mm", "guide's point"},
                                     {"direction_y", "guide's direction"}}) {
    database.execute(
        ("UPDATE guidance SET " + std::string(column) + " = " + column + " + 0.01 WHERE frame = " + frame)
            .c_str());
    changed.insert(what);
  }
  database.execute(("UPDATE guidance SET drill_depth_mm = 3, drill_to_exit_mm = 2, drill_sigma_mm = 1 "
                    "WHERE frame = " +
                    frame)
                       .c_str());
  database.execute("DELETE FROM events WHERE kind = 'verification skipped'");
  database.execute(
      "INSERT INTO events(after_frame, timestamp_ns, kind, text) VALUES(3, 0, 'alarm', 'moved')");
  EXPECT_EQ(whats_of(), changed);
}

// The simulator's drill guide at its plan, as a live source whose pictures are so old when they are taken up.
class AgedOperation : public simulator::SimulatedOperation {
 public:
  AgedOperation(const simulator::SimulationOptions& options, std::int64_t age_ns)
      : SimulatedOperation(options, simulator::Phase::Drill), age_ns_(age_ns) {}
  [[nodiscard]] camera::FramePtr next() override {
    const camera::FramePtr made = SimulatedOperation::next();
    if (made == nullptr) return nullptr;
    auto frame = std::make_shared<camera::Frame>(*made);
    frame->decoded_ns = sources::steady_now_ns();
    frame->captured_ns = frame->received_ns = frame->decoded_ns - age_ns_;
    return frame;
  }

 private:
  std::int64_t age_ns_;
};

// What the screen does not show, since pictures come too slowly or too late, is in no record, is no evidence
// of a drilled tunnel, and is hidden again when the record is run again.
TEST_F(ReplayedOperation, Hazard3WhatCameTooLateToBeShownIsRecordedAsHidden) {
  constexpr std::int64_t kMinute_ns = 60'000'000'000;  // ahead: no busy machine makes them old
  constexpr int kFrames = 30;
  simulator::SimulationOptions options = simulator::phantom_options();
  options.frame_count = kFrames;
  struct Kind {
    std::string name;
    std::int64_t age_ns;
    bool is_slow, guides;
  };
  int session = 0;
  for (const Kind& kind : {Kind{"in time", -kMinute_ns, false, true}, Kind{"slow", -kMinute_ns, true, false},
                           Kind{"late", kMinute_ns, false, false}}) {
    SCOPED_TRACE(kind.name);
    TheatreSource source;
    source.setup.kind = sources::SourceKind::Live;
    source.setup.pipeline.calibration = options.camera;
    source.setup.pipeline.tools = options.tools;
    source.setup.pipeline.refractive_index = options.refractive_index;
    source.open = [=] { return std::make_unique<AgedOperation>(options, kind.age_ns); };
    {
      OperationRun run(setup_, test::at_once(setup_), folders());
      run.start(source);
      run.keep_video(true);
      run.apply(operation::ConfirmTimeOut{});
      run.apply(operation::TrustGuide{});
      operation::GiveRegistration known =
          test::true_registration(trial_, operation::provenance_of(setup_, source.setup));
      known.registration.marker_from_bone =
          simulator::SimulatedOperation(options, simulator::Phase::Drill).marker_from_bone();
      run.apply(known);
      const auto draw_too_late = [&] { run.shown_until(120, sources::steady_now_ns()); };
      for (int i = 0; kind.is_slow && i < 3; ++i) draw_too_late();
      long guided = 0;
      for (OperationRun::Step step; !step.has_ended;) {
        if (kind.is_slow) draw_too_late();
        step = run.step();
        if (step.picture != nullptr) guided += run.state_of_frame()->frame.guidance.is_valid() ? 1 : 0;
      }
      EXPECT_EQ(guided > 5, kind.guides) << guided;
      EXPECT_EQ(guided == 0, !kind.guides) << guided;
      EXPECT_EQ(run.state()->verification == operation::Verification::Skipped, kind.guides)
          << "it guided nobody";
      run.end_source();
    }
    const std::string name = "session" + std::to_string(++session);
    long valid = 0;
    const recording::RecordedSession recorded(folder_ / name);
    for (const recording::RecordedFrame& frame : recorded.frames())
      valid += frame.guidance.is_valid() ? 1 : 0;
    EXPECT_EQ(valid > 5, kind.guides) << valid;
    EXPECT_EQ(valid == 0, !kind.guides) << valid;
    expect_replays(name, static_cast<long>(recorded.frames().size()));
  }
}

// Second looks that come when they come, as from a thread: each is handed out so many frames after it was
// asked for.
class LateLooks : public MediumLookService {
 public:
  explicit LateLooks(int frames_late, bool first_fails = false)
      : frames_late_(frames_late), fails_(first_fails) {}
  void post(operation::MediumLookRequest request, const camera::FramePtr& picture) override {
    coming_ = work_.look(std::move(request), *picture);
    if (std::exchange(fails_, false)) {
      auto failed = std::make_shared<operation::MediumLook>(*coming_);
      failed->in_other_medium.clear();
      failed->failure = "no memory";
      coming_ = failed;
    }
    asked_for_ = 0;
  }
  [[nodiscard]] operation::MediumLookPtr latest() const override {
    if (++asked_for_ > frames_late_) there_ = coming_;
    return there_;
  }

 private:
  int frames_late_;
  bool fails_;
  operation::MediumLookWork work_;
  operation::MediumLookPtr coming_;
  mutable operation::MediumLookPtr there_;
  mutable int asked_for_ = 0;
};

// The wrong medium is found by second looks, whenever they come: run again from the record, every state is
// the same, since the record says after which frame each was taken in; also that one failed, whatever is seen
// when it runs again.
TEST_F(ReplayedOperation, SecondLooksThatComeLateGiveTheSameStates) {
  constexpr int kFrames = 45;  // in which the latest look, too, is followed by another
  simulator::SimulationOptions options = simulator::phantom_options();
  options.frame_count = kFrames;
  TheatreSource source;
  source.setup.kind = sources::SourceKind::Simulation;
  source.setup.pipeline.calibration = options.camera;
  source.setup.pipeline.tools = options.tools;
  source.setup.pipeline.refractive_index = options.refractive_index > 1.1 ? 1.0 : 1.3345;
  source.open = [=] {
    return std::make_unique<simulator::SimulatedOperation>(options, simulator::Phase::Scratch);
  };
  int session = 0;
  for (const auto& [frames_late, first_fails] :
       {std::pair(0, false), std::pair(2, false), std::pair(5, false), std::pair(2, true)}) {
    {
      OperationRun run(setup_, test::at_once(setup_), folders(),
                       std::make_unique<LateLooks>(frames_late, first_fails));
      run.start(source);
      run.keep_video(true);
      for (int i = 0; i < kFrames; ++i) ASSERT_TRUE(run.step().picture);
      run.end_source();
      EXPECT_TRUE(run.operation().points().empty()) << "what was drawn through it is gone";
    }
    const std::string name = "session" + std::to_string(++session);
    int looks = 0, failed = 0, wrong = 0;
    const recording::RecordedSession recorded(folder_ / name);  // whose events are looked at
    for (const recording::SessionEvent& event : recorded.events()) {
      looks += event.kind == recording::kLookEvent ? 1 : 0;
      failed += event.kind == recording::kLookFailedEvent ? 1 : 0;
      wrong += event.kind == recording::kMediumWrongEvent ? 1 : 0;
    }
    EXPECT_GT(looks, first_fails ? 0 : 1) << frames_late << " frames late";
    EXPECT_EQ(failed, first_fails ? 1 : 0);
    EXPECT_EQ(wrong, 1);
    expect_replays(name, kFrames);
  }
}

}  // namespace
}  // namespace arthronaut::theatre
