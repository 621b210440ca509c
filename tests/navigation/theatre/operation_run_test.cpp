#include "navigation/theatre/operation_run.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <random>
#include <thread>

#include "navigation/recording/session.h"
#include "navigation/recording/session_check.h"
#include "navigation/recording/session_database.h"
#include "navigation/sources/capture_time.h"
#include "tests/navigation/theatre/theatre_sources.h"
#include "tests/temporary_folder.h"

namespace arthronaut::theatre {
namespace {

namespace fs = std::filesystem;
using operation::Standing;

class OperationRunTest : public ::testing::Test {
 protected:
  void give(OperationRun& run) const {
    run.apply(test::true_registration(
        trial_, operation::provenance_of(run.operation().setup(),
                                         test::scripted_source(sources::SourceKind::Recording))));
  }
  // Steps to the end of the source, and ends it; how many pictures there were.
  static int run_to_end(OperationRun& run) {
    int count = 0;
    while (!run.step().has_ended) ++count;
    run.end_source();
    return count;
  }
  const test::TemporaryFolder folder_;
  experiments::Trial trial_ = registration::phantom_bone().trial(experiments::TrialNoise::Dry, 1);
  operation::OperationSetup setup_ = test::phantom_setup();
};

// Pictures of a live source, each so old when it is received, the sixth older.
class AgedSource : public test::PlainSource {
 public:
  explicit AgedSource(std::int64_t count, std::int64_t age_ms = 11, std::int64_t sixth_ms = 140)
      : PlainSource(count, false), age_ns_(age_ms * 1'000'000), sixth_ns_(sixth_ms * 1'000'000) {}
  [[nodiscard]] camera::FramePtr next() override {
    const camera::FramePtr plain = PlainSource::next();
    if (plain == nullptr) return nullptr;
    const auto frame = std::make_shared<camera::Frame>(
        test::round_frame(plain->index, static_cast<std::uint8_t>(100 + plain->index)));
    frame->decoded_ns = sources::steady_now_ns();
    frame->received_ns = frame->decoded_ns - 7'000'000;
    frame->captured_ns = frame->received_ns - (frame->index == 5 ? sixth_ns_ : age_ns_);
    return frame;
  }

 private:
  std::int64_t age_ns_, sixth_ns_;
};

// Pictures of which none is like another: they make a large file.
class NoisySource : public test::PlainSource {
 public:
  explicit NoisySource(std::int64_t count) : PlainSource(count, false) {}
  [[nodiscard]] camera::FramePtr next() override {
    const camera::FramePtr plain = PlainSource::next();
    if (plain == nullptr) return nullptr;
    auto frame = std::make_shared<camera::Frame>(*plain);
    for (std::uint8_t& value : frame->bgr) value = static_cast<std::uint8_t>(random_());
    return frame;
  }

 private:
  std::mt19937 random_{1};
};

// Without its tracker a source is none: nothing of it is left running, and the next one starts.
TEST_F(OperationRunTest, ATrackerThatCannotBeMadeLeavesNoSourceBehind) {
  OperationRun run(setup_, test::at_once(setup_), {});
  TheatreSource tracked = test::plain_source(3, false, sources::SourceKind::Live);
  tracked.setup.pipeline.tools.tracker = tools::OutsideTracker{"igtl://127.0.0.1:1", 0.2, 0.1};
  tracked.tracker = []() -> std::unique_ptr<tracker::PoseSource> { throw DeviceError("no socket"); };
  EXPECT_THROW(run.start(tracked), DeviceError);
  EXPECT_FALSE(run.has_source());
  EXPECT_FALSE(run.state()->has_source);
  run.start(test::plain_source(3));
  EXPECT_EQ(run_to_end(run), 3);
}

// A pedal is pressed for where the probe is now; what comes two seconds late shows where it was.
TEST_F(OperationRunTest, Hazard3NoTouchAndNoStrokeIsTakenOfAnOldPicture) {
  const fs::path session = folder_ / "session";
  fs::create_directory(session);
  OperationRun run(setup_, test::at_once(setup_), [&] { return session; });
  TheatreSource source = test::plain_source(0, false, sources::SourceKind::Live);
  // The others are of a minute ahead: no busy machine makes them old.
  source.open = [] { return std::make_unique<AgedSource>(8, -60'000, 2000); };
  run.start(source);
  const auto step_to = [&](std::int64_t index) {
    while (run.step().picture->index < index) {
    }
  };
  step_to(4);
  run.apply(operation::ConfirmTimeOut{});  // without it a live source takes none of any picture
  run.apply(operation::TakeTouch{});
  EXPECT_EQ(run.state()->touch_refusal, operation::TouchRefusal::TipUnknown) << "looked at, and no tip there";
  run.apply(operation::ForgetTouches{});
  step_to(5);
  const auto before = run.state()->touch_asked_ns;
  run.apply(operation::TakeTouch{});
  run.apply(operation::TouchControlPoint{});
  run.apply(operation::CheckGuide{});
  run.apply(operation::Draw{true});
  EXPECT_EQ(run.state()->touch_asked_ns, before);
  EXPECT_FALSE(run.state()->draws);
  EXPECT_EQ(run.refusal().count, 5) << "the tip that was not known, and these four";
  EXPECT_EQ(run.refusal().words.find("not drawing: picture 2."), 0U) << run.refusal().words;
  step_to(6);
  run.apply(operation::ForgetTouches{});
  EXPECT_FALSE(run.refusal().words.empty()) << "that is of no moment";
  run.apply(operation::Draw{true});
  EXPECT_TRUE(run.state()->draws);
  EXPECT_TRUE(run.refusal().words.empty());
  EXPECT_EQ(run.refusal().count, 5);
  (void)run_to_end(run);
  std::vector<std::string> refused;
  const recording::RecordedSession recorded(session);
  for (const recording::SessionEvent& event : recorded.events())
    if (event.kind == recording::kCommandRefusedEvent) refused.push_back(event.text);
  ASSERT_EQ(refused.size(), 4U);
  EXPECT_EQ(refused[0].find("touch: the newest picture is "), 0U) << refused[0];
}

// What is pressed while no picture comes, and after the end of the source, has its own time in the record,
// and a tunnel that is said to be drilled while none comes has no pose to rest on.
TEST_F(OperationRunTest, Hazard29WhatIsSaidWithoutAPictureIsDatedWhenItIsSaid) {
  const fs::path session = folder_ / "session";
  fs::create_directory(session);
  OperationRun run(setup_, test::at_once(setup_), [&] { return session; });
  TheatreSource source = test::plain_source(0, false, sources::SourceKind::Live);
  source.open = [] { return std::make_unique<AgedSource>(6, -60'000, 29'000); };
  run.start(source);
  while (run.step().picture->index < 4) {
  }
  run.apply(operation::ReadDepthStop{20});
  while (run.step().picture->index < 5) {
  }
  const std::int64_t last_ns = run.state_of_frame()->frame.timestamp_ns;
  run.apply(operation::TunnelDrilled{});
  EXPECT_EQ(run.state()->drilled.evidence, guidance::EvidenceOutcome::NoPicture);
  operation::PlannedTunnel wider = run.state()->plan.value();
  wider.tunnel.diameter_mm += 1;
  run.apply(operation::OfferPlan{wider});
  run.apply(operation::TakePlanOver{});
  give(run);
  run.apply(operation::MarkerOut{});
  run.end_source();
  run.apply(operation::ReadDepthStop{21});
  std::vector<std::int64_t> said_ns;
  double out_without_picture_s = 0;
  const recording::RecordedSession recorded(session);
  for (const recording::SessionEvent& event : recorded.events()) {
    if (event.kind != recording::kCommandEvent) continue;
    said_ns.push_back(event.timestamp_ns);
    const operation::Command command = operation::command_from_text(event.text, "events");
    if (const auto* const out = std::get_if<operation::MarkerOut>(&command))
      out_without_picture_s = out->without_picture_s;
  }
  EXPECT_NEAR(out_without_picture_s, 29, 5) << "the word that the marker is out, likewise";
  ASSERT_EQ(said_ns.size(), 7U);
  EXPECT_LT(said_ns[0], last_ns) << "of the picture that was there";
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  EXPECT_NEAR(static_cast<double>(said_ns[1] - last_ns) / kSecond_ns, 29, 5);
  EXPECT_GE(said_ns[6], said_ns[1]);
  const auto newest_ns = [&](std::string_view kind) {
    std::int64_t at_ns = -1;
    for (const recording::SessionEvent& event : recorded.events())
      if (event.kind == kind) at_ns = event.timestamp_ns;
    return at_ns;
  };
  EXPECT_EQ(newest_ns(recording::kPlanEvent), said_ns[3]) << "taken over without a picture";
  EXPECT_EQ(newest_ns(recording::kGivenRegistrationEvent), said_ns[4]);
  const auto word = std::find_if(
      recorded.events().begin(), recorded.events().end(),
      [](const recording::SessionEvent& event) { return event.kind == recording::kDrilledByWordEvent; });
  ASSERT_NE(word, recorded.events().end());
  EXPECT_EQ(word->timestamp_ns, said_ns[1]);
}

// The pictures of a recording tell the time while they come, and none once they have ended: what is said then
// is dated by how long ago that was.
TEST_F(OperationRunTest, Hazard29WhatIsSaidAfterARecordingIsDatedWhenItIsSaid) {
  const fs::path session = folder_ / "session";
  fs::create_directory(session);
  OperationRun run(setup_, test::at_once(setup_), [&] { return session; });
  run.start(test::plain_source(3));
  (void)run_to_end(run);
  const std::int64_t last_ns = run.state_of_frame()->frame.timestamp_ns;
  std::this_thread::sleep_for(std::chrono::milliseconds(700));
  run.apply(operation::TunnelDrilled{});
  const recording::RecordedSession recorded(session);
  const recording::SessionEvent& word = recorded.events().back();
  ASSERT_EQ(word.kind, recording::kDrilledByWordEvent);
  EXPECT_GE(word.timestamp_ns - last_ns, 700'000'000);
  EXPECT_LT(word.timestamp_ns - last_ns, 60'000'000'000);
}

// Nor has one that is said over pictures that show nothing: a scope that was drawn out with its light off,
// and one whose picture stands still. They count from the last one that showed something.
TEST_F(OperationRunTest, Hazard29WhatIsSaidOverAPlainOrAFrozenPictureRestsOnNoPose) {
  constexpr int kCount = 65, kRate = 30;
  class DeadPictures : public test::PlainSource {
   public:
    explicit DeadPictures(bool is_frozen) : PlainSource(kCount, false, kRate), is_frozen_(is_frozen) {}
    [[nodiscard]] camera::FramePtr next() override {
      const camera::FramePtr plain = PlainSource::next();
      if (plain == nullptr) return nullptr;
      constexpr std::int64_t kAlive = 5;
      const auto alive = static_cast<std::uint8_t>(100 + 7 * std::min(plain->index, kAlive));
      auto frame = std::make_shared<camera::Frame>(test::round_frame(plain->index, alive));
      if (plain->index > kAlive && !is_frozen_)
        std::fill(frame->bgr.begin(), frame->bgr.end(), std::uint8_t{0});
      frame->timestamp_ns = frame->index * 1'000'000'000 / kRate;
      frame->decoded_ns = frame->received_ns = frame->captured_ns = sources::steady_now_ns();
      return frame;
    }

   private:
    bool is_frozen_;
  };
  for (const bool is_frozen : {false, true}) {
    OperationRun run(setup_, test::at_once(setup_), {});
    TheatreSource source = test::plain_source(0, false, sources::SourceKind::Live);
    source.open = [=] { return std::make_unique<DeadPictures>(is_frozen); };
    run.start(source);
    while (run.step().picture == nullptr || run.state_of_frame()->frame.frame_index < 4) {
    }
    run.apply(operation::TunnelDrilled{});
    EXPECT_EQ(run.state()->drilled.evidence, guidance::EvidenceOutcome::NoGuidance) << "that was seen";
    run.apply(operation::TakeBackDrilled{});
    while (run.state_of_frame()->frame.frame_index < kCount - 2) (void)run.step();
    run.apply(operation::TunnelDrilled{});
    EXPECT_EQ(run.state()->drilled.evidence, guidance::EvidenceOutcome::NoPicture) << is_frozen;
    run.end_source();
    run.apply(operation::TakeBackDrilled{});
    run.apply(operation::TunnelDrilled{});
    EXPECT_EQ(run.state()->drilled.evidence, guidance::EvidenceOutcome::NoPicture) << "after its end, too";
  }
}

// A time-out that is confirmed while the picture shows nothing is recorded as such.
TEST_F(OperationRunTest, Hazard20ATimeOutBesideADeadPictureIsRecordedAsSuch) {
  class PlainPictures : public test::PlainSource {
   public:
    PlainPictures() : PlainSource(3, false) {}
    [[nodiscard]] camera::FramePtr next() override {
      const camera::FramePtr plain = PlainSource::next();
      if (plain == nullptr) return nullptr;
      auto frame = std::make_shared<camera::Frame>(*plain);
      std::fill(frame->bgr.begin(), frame->bgr.end(), std::uint8_t{0});
      return frame;
    }
  };
  for (const bool is_dead : {true, false}) {
    const fs::path session = folder_ / (is_dead ? "dead" : "seen");
    fs::create_directory(session);
    OperationRun run(setup_, test::at_once(setup_), [&] { return session; });
    TheatreSource source = test::plain_source(0, false, sources::SourceKind::Live);
    source.open = [=]() -> std::unique_ptr<sources::FrameSource> {
      if (is_dead) return std::make_unique<PlainPictures>();
      return std::make_unique<AgedSource>(3, -60'000, 0);
    };
    run.start(source);
    while (run.step().picture->index < 2) {
    }
    run.apply(operation::ConfirmTimeOut{});
    EXPECT_EQ(run.state()->time_out, operation::TimeOut::Confirmed);
    run.end_source();
    std::string text;
    const recording::RecordedSession recorded(session);
    for (const recording::SessionEvent& event : recorded.events())
      if (event.kind == recording::kTimeOutConfirmedEvent) text = event.text;
    EXPECT_EQ(text.starts_with("BESIDE plain picture; "), is_dead) << text;
  }
}

// Once the source has ended, that there is none is the reason, not how old its last picture is.
TEST_F(OperationRunTest, AfterALiveSourceATouchIsRefusedForWantOfOne) {
  OperationRun run(setup_, test::at_once(setup_), {});
  TheatreSource source = test::plain_source(0, false, sources::SourceKind::Live);
  source.open = [] { return std::make_unique<AgedSource>(3, 2000, 2000); };
  run.start(source);
  (void)run_to_end(run);
  run.apply(operation::TakeTouch{});
  EXPECT_EQ(run.state()->touch_refusal, operation::TouchRefusal::NoSource);
}

// How long each picture of a live source took is in its record, stage by stage; that one was late is an
// event.
TEST_F(OperationRunTest, Hazard3LatencyAndLatePicturesAreInTheRecord) {
  const fs::path session = folder_ / "session";
  fs::create_directory(session);
  OperationRun run(setup_, test::at_once(setup_), [&] { return session; });
  TheatreSource source = test::plain_source(0, false, sources::SourceKind::Live);
  source.open = [] { return std::make_unique<AgedSource>(12); };
  run.start(source);
  (void)run_to_end(run);
  const LatencyReport report = run.latency().report();
  EXPECT_EQ(of(report, Stage::Capture).count, 12U);
  EXPECT_NEAR(of(report, Stage::Capture).median_ms, 11, 0.2);
  EXPECT_NEAR(of(report, Stage::Decode).median_ms, 7, 0.2);
  EXPECT_GE(of(report, Stage::ToGuidance).median_ms, 18);
  EXPECT_GE(of(report, Stage::ToGuidance).worst_ms, 147);

  recording::SessionDatabase database = recording::SessionDatabase::open(session / "session.sqlite");
  recording::Statement row = database.prepare(
      "SELECT COUNT(*), AVG(decode_ms), MAX(guidance_ms), MIN(queue_ms), MIN(tracking_ms) FROM latency");
  ASSERT_TRUE(row.step());
  EXPECT_EQ(row.integer(0), 12);
  EXPECT_NEAR(row.number(1), 7, 0.2);
  EXPECT_GE(row.number(2), 147);
  EXPECT_GE(row.number(3), 0);
  EXPECT_GE(row.number(4), 0);
  std::string told, summary;
  const recording::RecordedSession recorded(session);
  for (const recording::SessionEvent& event : recorded.events()) {
    if (event.kind == recording::kSourceTroubleEvent && told.empty()) told = event.text;
    if (event.kind == recording::kLatencyEvent) summary = event.text;
  }
  EXPECT_NE(told.find("late"), std::string::npos) << told;
  EXPECT_NE(summary.find("12 pictures"), std::string::npos) << summary;
}

// A record that cannot begin is told and ends nothing: the operation goes on to the last frame, guiding.
TEST_F(OperationRunTest, ARecordThatCannotBeginIsToldAndNothingEnds) {
  OperationRun run(setup_, test::at_once(setup_),
                   []() -> fs::path { throw IoError("sessions", "the folder is read-only"); });
  run.start(test::plain_source(8));
  EXPECT_NE(run.record_trouble().find("read-only"), std::string::npos) << run.record_trouble();
  give(run);
  EXPECT_EQ(run_to_end(run), 8);
  EXPECT_EQ(run.state()->registration->in_force.standing, Standing::Stands);
  EXPECT_EQ(run.state()->frame_count, 8);
}

// The same of a folder that is no place to write to; the next source gets its chance anew.
TEST_F(OperationRunTest, AFolderThatCannotBeWrittenIsToldAndTheNextSourceIsRecorded) {
  std::ofstream(folder_ / "file").put('x');
  fs::path next = folder_ / "file" / "session";
  OperationRun run(setup_, test::at_once(setup_), [&] { return next; });
  run.start(test::plain_source(4));
  EXPECT_NE(run.record_trouble(), "");
  EXPECT_EQ(run_to_end(run), 4);
  next = folder_ / "good";
  fs::create_directory(next);
  run.start(test::plain_source(4));
  EXPECT_EQ(run.record_trouble(), "");
  EXPECT_EQ(run_to_end(run), 4);
  EXPECT_EQ(recording::RecordedSession(next).frames().size(), 4U);
}

// Midway the folder goes: that is told, the frames go on.
TEST_F(OperationRunTest, ARecordThatFailsMidwayIsToldAndNothingEnds) {
  const fs::path session = folder_ / "session";
  OperationRun run(setup_, test::at_once(setup_), [&] {
    fs::create_directory(session);
    return session;
  });
  run.start(test::plain_source(40));
  give(run);
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(run.step().picture);
  fs::rename(session, folder_ / "elsewhere");  // at one stroke, whatever is being written in there
  EXPECT_EQ(run_to_end(run), 30);
  EXPECT_NE(run.record_trouble(), "");
  EXPECT_EQ(run.state()->registration->in_force.standing, Standing::Stands);
}

// A file system that takes no larger file of video ends the video and nothing else: the journal goes on to
// its end and beyond, and the reason is told beside it.
TEST_F(OperationRunTest, Hazard12AVideoThatCannotBeWrittenLeavesTheJournal) {
  const fs::path session = folder_ / "session";
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    int exit_code = 1;
    try {
      fs::create_directory(session);
      OperationRun run(setup_, test::at_once(setup_), [&] { return session; });
      TheatreSource source = test::plain_source(300);
      source.open = [] { return std::make_unique<NoisySource>(300); };
      run.start(source);
      run.keep_video(true);
      const rlimit limit{1'500'000, 1'500'000};
      ::setrlimit(RLIMIT_FSIZE, &limit);
      for (int i = 0; i < 250; ++i) (void)run.step();
      give(run);
      const bool kept = run.keeps_video();
      (void)run_to_end(run);
      run.apply(operation::SkipVerification{});  // after the end of the source
      const bool is_told = run.video_trouble().find("video.mkv: cannot write") == 0;
      exit_code = !run.record_trouble().empty() ? 2 : !is_told ? 3 : kept ? 4 : 0;
    } catch (const std::exception&) {
      exit_code = 5;
    }
    ::_exit(exit_code);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  const recording::RecordedSession recorded(session);
  EXPECT_TRUE(recorded.was_finished());
  EXPECT_EQ(recorded.frames().size(), 300U);
  EXPECT_TRUE(recorded.registration());
  const auto has = [&](std::string_view kind) {
    return std::ranges::count(recorded.events(), kind, &recording::SessionEvent::kind) == 1;
  };
  EXPECT_TRUE(has(recording::kVideoStoppedEvent));
  EXPECT_TRUE(has(recording::kVerificationSkippedEvent));
  const recording::SessionCheck check = recording::check_session(session);
  EXPECT_TRUE(check.is_unbroken()) << recording::check_words(check);
}

// A copy of the video that the disk does not take leaves the record whole, too.
TEST_F(OperationRunTest, Hazard12AVideoThatCannotBeCopiedLeavesTheJournal) {
  const fs::path session = folder_ / "session";
  OperationRun run(setup_, test::at_once(setup_), [&] {
    fs::create_directory(session);
    return session;
  });
  run.start(test::plain_source(5));
  run.keep_video(recording::KeepVideo::Copy, folder_ / "gone.mkv");
  EXPECT_EQ(run_to_end(run), 5);
  EXPECT_EQ(run.record_trouble(), "");
  EXPECT_NE(run.video_trouble().find("no such video"), std::string::npos) << run.video_trouble();
  EXPECT_TRUE(recording::RecordedSession(session).was_finished());
}

// A source that fails is ended with its record, whole; what was made stays in force, and its kind is what it
// was.
TEST_F(OperationRunTest, WhatWasMadeIsKeptWhenTheSourceFails) {
  const fs::path session = folder_ / "session";
  OperationRun run(setup_, test::at_once(setup_), [&] {
    fs::create_directory(session);
    return session;
  });
  run.start(test::plain_source(5, true));
  give(run);
  EXPECT_THROW(run_to_end(run), DeviceError);
  run.end_source();
  EXPECT_FALSE(run.has_source());
  EXPECT_FALSE(run.state()->has_source);
  EXPECT_EQ(run.state()->source->kind, sources::SourceKind::Recording);
  EXPECT_EQ(run.state()->registration->in_force.standing, Standing::Stands);
  EXPECT_EQ(run.record_trouble(), "");
  const recording::RecordedSession recorded(session);
  EXPECT_TRUE(recorded.was_finished());
  EXPECT_EQ(recorded.frames().size(), 5U);
  ASSERT_TRUE(recorded.registration());
  EXPECT_EQ(recorded.registration()->marker_from_bone.translation_mm, trial_.marker_from_bone.translation_mm);
  // A decision after the end belongs to the same record.
  run.apply(operation::SkipVerification{});
  const recording::RecordedSession after(session);
  EXPECT_TRUE(std::any_of(after.events().begin(), after.events().end(),
                          [](const auto& event) { return event.kind == "verification skipped"; }));
}

// A source that cannot be opened is no source; what was there before has ended.
TEST_F(OperationRunTest, ASourceThatCannotBeOpenedIsNone) {
  OperationRun run(setup_, test::at_once(setup_), {});
  run.start(test::plain_source(5));
  TheatreSource broken = test::plain_source(5);
  broken.open = []() -> std::unique_ptr<sources::FrameSource> { throw DeviceError("no such device"); };
  EXPECT_THROW(run.start(broken), DeviceError);
  EXPECT_FALSE(run.has_source());
}

// Video that was asked for is kept of the source that follows, too, until it is asked for no more.
TEST_F(OperationRunTest, VideoThatWasAskedForIsKeptOfTheNextSourceToo) {
  int sessions = 0;
  OperationRun run(setup_, test::at_once(setup_), [&] {
    const fs::path session = folder_ / ("session" + std::to_string(++sessions));
    fs::create_directory(session);
    return session;
  });
  run.start(test::plain_source(3));
  EXPECT_FALSE(run.keeps_video());
  run.keep_video(true);
  EXPECT_TRUE(run.keeps_video());
  EXPECT_EQ(run_to_end(run), 3);
  run.start(test::plain_source(3));
  EXPECT_TRUE(run.keeps_video());
  run.keep_video(false);
  EXPECT_EQ(run_to_end(run), 3);
  run.start(test::plain_source(3));
  EXPECT_FALSE(run.keeps_video());
  run.end_source();
}

}  // namespace
}  // namespace arthronaut::theatre
