#include "navigation/recording/session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <chrono>
#include <fstream>
#include <future>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <thread>

#include "navigation/recording/cut_short.h"
#include "navigation/recording/recording_lock.h"
#include "navigation/recording/session_check.h"
#include "navigation/recording/session_facts.h"
#include "navigation/recording/session_overview.h"
#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "tests/navigation/recording/recorded_frames.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

namespace fs = std::filesystem;

class Session : public ::testing::Test {
 protected:
  const test::TemporaryFolder temporary_;
  const fs::path& folder_ = temporary_.path();
  pipeline::PipelineOptions options_ = test::scripted_options();
};

// Doubles are stored as they are, so all that is read back equals to the last bit what was written.
TEST_F(Session, ReadsBackExactlyWhatWasRecorded) {
  {
    recording::SessionRecorder recorder(folder_, test::session_header(), options_);
    for (int i = 0; i < 20; ++i) recorder.append(test::frame_result(i));
    recorder.add_event({5, "note", "a \"quoted\" note"});
    recorder.finish();
  }
  const recording::RecordedSession session(folder_);
  EXPECT_TRUE(session.was_finished());
  EXPECT_EQ(session.header().id, test::session_header().id);
  EXPECT_EQ(session.header().side, bones::Side::Left);
  EXPECT_EQ(session.pipeline_options().tools.tools.size(), 2u);
  EXPECT_EQ(session.pipeline_options().refractive_index, 1.3345);
  EXPECT_FALSE(session.pipeline_options().follow_lens);
  ASSERT_EQ(session.frames().size(), 20u);
  for (int i = 0; i < 20; ++i) {
    const pipeline::FrameResult wanted = test::frame_result(i);
    const recording::RecordedFrame& frame = session.frames()[static_cast<std::size_t>(i)];
    EXPECT_EQ(frame.timestamp_ns, wanted.timestamp_ns);
    EXPECT_EQ(frame.lens.mark_angle_deg, wanted.lens.mark_angle_deg);
    EXPECT_EQ(frame.lens.circle.center_px, wanted.lens.circle.center_px);
    ASSERT_EQ(frame.poses.size(), 2u);
    EXPECT_EQ(frame.poses[0].camera_from_marker.rotation.coeffs(),
              wanted.markers[0].camera_from_marker.rotation.coeffs());
    EXPECT_EQ(frame.poses[1].camera_from_marker.translation_mm,
              wanted.markers[2].camera_from_marker.translation_mm);
    ASSERT_EQ(frame.markers.size(), 3u);
    EXPECT_EQ(frame.markers[1].state, markers::MarkerState::Glare);
    EXPECT_EQ(frame.tip_is_valid, wanted.tip_is_valid);
    if (wanted.tip_is_valid) {
      EXPECT_EQ(frame.tip_in_world_mm, wanted.tip_in_world_mm);
    }
    EXPECT_EQ(frame.guidance.state, wanted.guidance.state);
    if (wanted.guidance.is_valid()) {
      EXPECT_EQ(frame.guidance.angle_deg, wanted.guidance.angle_deg);
      EXPECT_EQ(frame.guidance.offset_lateral_mm, wanted.guidance.offset_lateral_mm);
    }
    // With its guide and without.
    ASSERT_EQ(frame.guidance.drill.has_value(), wanted.guidance.drill.has_value());
    if (wanted.guidance.drill) {
      const guidance::DrillDepth &drill = *frame.guidance.drill, &shown = *wanted.guidance.drill;
      EXPECT_EQ(drill.marker_id, shown.marker_id);
      EXPECT_EQ(drill.tip_mm, shown.tip_mm);
      EXPECT_EQ(drill.direction, shown.direction);
      EXPECT_EQ(drill.depth_mm, shown.depth_mm);
      EXPECT_EQ(drill.remaining_mm, shown.remaining_mm);
      EXPECT_EQ(drill.to_exit_mm, shown.to_exit_mm);
      EXPECT_EQ(drill.lateral_mm, shown.lateral_mm);
      EXPECT_EQ(drill.sigma_mm, shown.sigma_mm);
      EXPECT_EQ(drill.sigma_offset_mm, shown.sigma_offset_mm);
      EXPECT_EQ(drill.sigma_angle_deg, shown.sigma_angle_deg);
    }
  }
  ASSERT_EQ(session.events().size(), 1u);
  EXPECT_EQ(session.events()[0].text, "a \"quoted\" note");
  EXPECT_EQ(session.events()[0].after_frame, 19);
  EXPECT_TRUE(session.video().empty());
}

// The same frames one by one, for as long as they are wanted.
TEST_F(Session, WithoutItsFramesItIsGoneThrough) {
  for (const char* const name : {"empty", "whole"}) fs::create_directory(folder_ / name);
  EXPECT_FALSE([this] {
    recording::SessionRecorder recorder(folder_ / "empty", test::session_header(), options_);
    recorder.finish();
    return recording::RecordedSession::without_frames(folder_ / "empty").first_frame_ns();
  }());
  recording::SessionRecorder recorder(folder_ / "whole", test::session_header(), options_);
  for (int i = 7; i < 2500; ++i) recorder.append(test::frame_result(i));
  recorder.finish();
  const recording::RecordedSession whole(folder_ / "whole");
  const auto gone_through = recording::RecordedSession::without_frames(folder_ / "whole");
  EXPECT_EQ(gone_through.first_frame_ns(), whole.frames().front().timestamp_ns);
  EXPECT_EQ(gone_through.first_frame_ns(), whole.first_frame_ns());
  for (const recording::RecordedSession* const session : {&whole, &gone_through}) {
    auto next = whole.frames().begin();
    EXPECT_TRUE(session->for_each_frame([&](const recording::RecordedFrame& frame) {
      EXPECT_EQ(frame.index, next->index);
      EXPECT_EQ(frame.guidance.angle_deg, next->guidance.angle_deg);
      EXPECT_EQ(frame.poses.size(), next->poses.size());
      return ++next != whole.frames().end() || frame.index == 2499;
    }));
    EXPECT_EQ(next, whole.frames().end());
    int seen = 0;
    EXPECT_FALSE(session->for_each_frame([&](const auto& /*frame*/) { return ++seen < 1500; }));
    EXPECT_EQ(seen, 1500);
  }
}

// Offsets are said along these axes: run again along others, the same poses give other numbers.
TEST_F(Session, KeepsTheAxesThatOffsetsAreSaidIn) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 3).normalized()).toRotationMatrix();
  options_.axes = {landmarks::AnatomicalAxes::Origin::FromShaft, turn.col(0), turn.col(1), turn.col(2)};
  recording::SessionRecorder(folder_, test::session_header(), options_).finish();
  const auto axes = recording::RecordedSession(folder_).pipeline_options().axes;
  ASSERT_TRUE(axes.has_value());
  EXPECT_EQ(axes->origin, landmarks::AnatomicalAxes::Origin::FromShaft);
  EXPECT_EQ(axes->anterior, turn.col(0));  // to the bit
  EXPECT_EQ(axes->proximal, turn.col(1));
  EXPECT_EQ(axes->lateral, turn.col(2));

  auto header = nlohmann::json::parse(files::read_text(folder_ / "session.json"));
  header["axes"]["proximal"] = header["axes"]["anterior"];
  files::write_atomically(folder_ / "session.json", header.dump());
  EXPECT_THROW(recording::RecordedSession{folder_}, InvalidInput);
}

// Plans and registrations come back at the frame where they took effect; the open formats stand beside the
// record.
TEST_F(Session, KeepsPlansAndRegistrationsWithTheirMoment) {
  recording::SessionRecorder recorder(folder_, test::session_header(), options_);
  tunnels::Tunnel plan;
  plan.entry_mm = {1.1, -2.2, 3.3};
  recorder.set_plan(plan, 27.5);
  recorder.append(test::frame_result(0));
  recorder.set_registration(test::some_registration());
  recorder.append(test::frame_result(1));
  recorder.set_curves({{0, 0.5, {1, 2, 3}}, {0, 0.6, {1, 2, 4}}});
  recorder.finish();

  const recording::RecordedSession session(folder_);
  ASSERT_EQ(session.events().size(), 2u);
  EXPECT_EQ(session.events()[0].after_frame, -1);
  EXPECT_EQ(session.plan_of(session.events()[0]).plan->entry_mm, plan.entry_mm);
  EXPECT_EQ(session.plan_of(session.events()[0]).planned_length_mm, 27.5);
  EXPECT_EQ(session.events()[1].after_frame, 0);
  const auto registration = session.registration_of(session.events()[1]);
  EXPECT_LT(
      geometry::log(registration.marker_from_bone.inverse() * test::some_registration().marker_from_bone)
          .norm(),
      1e-12);
  EXPECT_LT((registration.covariance - test::some_registration().covariance).norm(), 1e-12);
  EXPECT_TRUE(session.registration().has_value());
  EXPECT_EQ(session.curves().size(), 2u);
  for (const char* file : {"poses.csv", "guidance.csv", "curves.csv", "registration.json", "camera.json"}) {
    EXPECT_TRUE(fs::exists(folder_ / file)) << file;
  }
  EXPECT_EQ(strokes::read_poses_file(folder_ / "poses.csv").size(), 4u);
}

// Of several drills the table says which one its depth is of.
TEST_F(Session, ItsTableNamesTheDrill) {
  constexpr int kDrill = 9;
  tools::Tool drill;
  drill.name = "drill, \"long\"";
  drill.kind = tools::ToolKind::Drill;
  drill.marker_id = kDrill;
  options_.tools.tools.push_back(drill);
  pipeline::FrameResult with_drill = test::frame_result(0), without = test::frame_result(1);
  with_drill.guidance.drill.emplace().marker_id = kDrill;
  without.guidance.drill.reset();
  {
    recording::SessionRecorder recorder(folder_, test::session_header(), options_);
    recorder.append(with_drill);
    recorder.append(without);
    recorder.finish();
  }
  std::ifstream table(folder_ / "guidance.csv");
  std::string header, first, second;
  std::getline(table, header);
  std::getline(table, first);
  std::getline(table, second);
  EXPECT_TRUE(header.ends_with(",drill_to_exit_mm,drill")) << header;
  EXPECT_TRUE(first.ends_with(",\"drill, \"\"long\"\"\"")) << first;
  EXPECT_TRUE(second.ends_with(",")) << second;
}

// A child records in real time and is killed with no chance to tidy up: all but the last second can be read.
TEST_F(Session, LosesAtMostOneSecondWhenKilled) {
  int last_frame_pipe[2];
  ASSERT_EQ(::pipe(last_frame_pipe), 0);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    recording::SessionRecorder recorder(folder_, test::session_header(), options_);
    for (int i = 0;; ++i) {
      recorder.append(test::frame_result(i));
      if (::write(last_frame_pipe[1], &i, sizeof i) != sizeof i) ::_exit(1);
      std::this_thread::sleep_for(std::chrono::milliseconds(17));
    }
  }
  ::close(last_frame_pipe[1]);
  int last_appended = -1;
  while (last_appended < 130)
    ASSERT_EQ(::read(last_frame_pipe[0], &last_appended, sizeof last_appended), sizeof last_appended);
  ASSERT_EQ(::kill(child, SIGKILL), 0);
  ::waitpid(child, nullptr, 0);
  for (int i = 0; ::read(last_frame_pipe[0], &i, sizeof i) == sizeof i;) last_appended = i;
  ::close(last_frame_pipe[0]);

  const recording::RecordedSession session(folder_);
  EXPECT_FALSE(session.was_finished());
  ASSERT_FALSE(session.frames().empty());
  EXPECT_EQ(session.frames().back().index + 1, static_cast<std::int64_t>(session.frames().size()));
  EXPECT_GE(session.frames().back().index, last_appended - 60);
}

// A disk that takes nothing for long ends the record of a live source, and no call of it waits; what was
// handed over is written once the disk takes it.
TEST_F(Session, Hazard13ADiskThatHangsKeepsNoLiveSourceWaiting) {
  std::promise<void> disk;
  recording::DiskLimits limits;
  limits.free_bytes = [works = disk.get_future().share()](const fs::path&) {
    works.wait();
    return std::uintmax_t{1} << 40;
  };
  int taken = 0;
  {
    recording::SessionRecorder recorder(folder_, test::session_header(), options_, limits);
    recorder.never_wait();
    EXPECT_THROW(
        for (; taken < 1'000'000; ++taken) {
          recorder.append(test::frame_result(taken));
          // The writer takes what comes until it looks at the disk for the first time.
          if (taken == 2000) std::this_thread::sleep_for(std::chrono::seconds(1));
        },
        IoError);
    EXPECT_TRUE(recorder.is_stuck());
    EXPECT_THROW(recorder.append(test::frame_result(taken)), IoError);
    disk.set_value();
  }
  EXPECT_GE(taken, 8192);
  const recording::RecordedSession session(folder_);
  EXPECT_EQ(session.frames().size(), static_cast<std::size_t>(taken));
  EXPECT_FALSE(session.was_finished()) << "it ends before its operation";
}

// A disk that is full is said at the next call, as an error that names the file; it is not lost in the
// writer's thread.
TEST_F(Session, ReportsADiskThatIsFull) {
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    recording::SessionRecorder recorder(folder_, test::session_header(), options_);
    const rlimit limit{300'000, 300'000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    int exit_code = 1;
    try {
      for (int i = 0; i < 20000; ++i) recorder.append(test::frame_result(i));
      recorder.finish();
    } catch (const IoError& error) {
      exit_code = std::string(error.what()).find("session.sqlite") != std::string::npos ? 0 : 2;
    }
    ::_exit(exit_code);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

// A disk that takes no more of the video ends the video alone: the record goes on to its end, it says why,
// and the pictures that were written can be looked at.
TEST_F(Session, Hazard12AVideoThatCannotBeWrittenEndsAlone) {
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    int exit_code = 1;
    try {
      recording::SessionRecorder recorder(folder_, test::session_header(), options_);
      const rlimit limit{2'000'000, 2'000'000};
      ::setrlimit(RLIMIT_FSIZE, &limit);
      std::mt19937 random(1);
      camera::Frame noise = test::plain_frame(0, 0);
      for (std::uint8_t& value : noise.bgr) value = static_cast<std::uint8_t>(random());
      for (int i = 0; i < 1000; ++i) {
        noise.index = i;
        recorder.append(test::frame_result(i));
        recorder.append_picture(std::make_shared<camera::Frame>(noise));
      }
      recorder.set_registration(test::some_registration());
      recorder.finish();
      exit_code = recorder.video_trouble().find("video.mkv: cannot write") == 0 ? 0 : 2;
    } catch (const IoError&) {
      exit_code = 3;
    }
    ::_exit(exit_code);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  ASSERT_EQ(WEXITSTATUS(status), 0);

  const recording::RecordedSession session(folder_);
  EXPECT_TRUE(session.was_finished());
  EXPECT_EQ(session.frames().size(), 1000U);
  EXPECT_TRUE(session.registration());
  const auto count = [&](std::string_view kind) {
    return std::ranges::count(session.events(), kind, &recording::SessionEvent::kind);
  };
  EXPECT_EQ(count(recording::kVideoStoppedEvent), 1);
  EXPECT_EQ(count(recording::kRegistrationEvent), 1);
  const std::string words = recording::cut_short_in_words(session.was_finished(), session.events());
  EXPECT_EQ(words.find("the video stopped: video.mkv: cannot write"), 0U) << words;
  int pictures = 0;
  const auto video = recording::open_recorded_video(session);
  while (video->next()) ++pictures;
  EXPECT_GT(pictures, 5);
  const recording::SessionCheck check = recording::check_session(folder_);
  EXPECT_TRUE(check.is_unbroken()) << recording::check_words(check);
}

// It kept the numbers alone: which scope it was, and when it was calibrated, nobody knew afterwards.
TEST_F(Session, KeepsWhichCalibrationItRanWith) {
  camera::CalibrationRecord record;
  record.rms_px = 0.3;
  record.date_utc = "2026-02-03T10:00:00Z";
  record.scope_name = "Scope 3";
  record.provenance.origin = provenance::Origin::Simulated;
  options_.calibrated = std::make_shared<const camera::CalibrationRecord>(record);
  recording::SessionRecorder(folder_, test::session_header(), options_).finish();
  for (const pipeline::PipelineOptions& read :
       {recording::RecordedSession(folder_).pipeline_options(), recording::read_overview(folder_).options}) {
    ASSERT_NE(read.calibrated, nullptr);
    EXPECT_EQ(read.calibrated->rms_px, 0.3);
    EXPECT_EQ(read.calibrated->date_utc, "2026-02-03T10:00:00Z");
    EXPECT_EQ(read.calibrated->scope_name, "Scope 3");
    EXPECT_EQ(read.calibrated->provenance.origin, provenance::Origin::Simulated);
    EXPECT_EQ(read.calibration.focal_px, options_.calibration.focal_px) << "as it was navigated with";
  }
}

// A session that goes on is not one that was cut off, for whoever looks at it.
TEST_F(Session, SaysThatItIsBeingRecorded) {
  const auto overview = [&] { return recording::read_overview(folder_); };
  std::optional<recording::SessionRecorder> recorder(std::in_place, folder_, test::session_header(),
                                                     options_);
  EXPECT_TRUE(recording::is_being_recorded(folder_));
  EXPECT_TRUE(overview().goes_on());
  EXPECT_EQ(recording::read_session_facts(folder_).outcome(), "not registered, being recorded");
  EXPECT_THAT(recording::check_words(recording::check_session(folder_)),
              testing::EndsWith("; being recorded, whole up to its last hash"));
  recorder->finish();
  EXPECT_FALSE(overview().goes_on());
  EXPECT_FALSE(recording::is_being_recorded(folder_));
  EXPECT_EQ(recording::read_session_facts(folder_).outcome(), "not registered");
  EXPECT_FALSE(recording::is_being_recorded(folder_ / "nowhere"));
}

// A whole session says nothing of the kind, also after one that stopped for want of room was finished.
TEST_F(Session, SaysWhyItIsCutShort) {
  const auto words = [](bool was_finished, const std::vector<recording::SessionEvent>& events,
                        bool is_being_recorded = false) {
    return recording::cut_short_in_words(was_finished, events, is_being_recorded);
  };
  EXPECT_EQ(words(true, {{0, "note", "all well"}}), "");
  EXPECT_EQ(words(false, {}), "the program ended before the session did");
  EXPECT_EQ(words(false, {}, true), "it is being recorded now");
  EXPECT_EQ(words(true, {}, true), "");  // it ended just now
  EXPECT_EQ(words(true, {{0, std::string(recording::kVideoStoppedEvent), "only 1.9 GiB are free"},
                         {0, std::string(recording::kRecordingStoppedEvent), "only 0.1 GiB are free"}}),
            "the video stopped: only 1.9 GiB are free; the recording stopped: only 0.1 GiB are free");
}

// Stills are copied under their names, and nothing else of their folder.
TEST_F(Session, CopiesAPatternOfStills) {
  const fs::path stills = folder_ / "stills";
  fs::create_directory(stills);
  for (const char* name : {"f_0001.png", "f_0002.png", "g_0001.png", "f_0001.txt"})
    std::ofstream(stills / name) << name;
  const fs::path session_folder = folder_ / "session";
  fs::create_directory(session_folder);
  recording::SessionRecorder recorder(session_folder, test::session_header(), options_);
  recorder.copy_video(stills / "f_%04d.png");
  recorder.finish();
  EXPECT_EQ(files::read_text(session_folder / "pictures/f_0002.png"), "f_0002.png");
  EXPECT_FALSE(fs::exists(session_folder / "pictures/g_0001.png"));
  EXPECT_FALSE(fs::exists(session_folder / "pictures/f_0001.txt"));
  EXPECT_EQ(recording::RecordedSession(session_folder).video(), session_folder / "pictures/f_%04d.png");
}

// A file that is no session, and a session of tomorrow, are refused with the file's name.
TEST_F(Session, RefusesWhatItCannotRead) {
  EXPECT_THROW(recording::RecordedSession{folder_ / "nowhere"}, IoError);
  EXPECT_THROW(recording::RecordedSession{folder_}, IoError);
  recording::SessionRecorder(folder_, test::session_header(), options_).finish();
  std::string header = files::read_text(folder_ / "session.json");
  header.replace(header.find("\"version\": 1"), 12, "\"version\": 9");
  files::write_atomically(folder_ / "session.json", header);
  EXPECT_THROW(recording::RecordedSession{folder_}, InvalidInput);
}

}  // namespace
}  // namespace arthronaut
