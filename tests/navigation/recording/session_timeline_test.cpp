#include "navigation/recording/session_timeline.h"

#include <gtest/gtest.h>

#include <fstream>

#include "navigation/recording/session_database.h"
#include "navigation/recording/session_files.h"
#include "navigation/recording/session_overview.h"
#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "tests/navigation/recording/recorded_frames.h"
#include "tests/temporary_folder.h"

namespace arthronaut::recording {
namespace {

namespace fs = std::filesystem;
constexpr int kFrames = 3000;

void record(const fs::path& folder, int frames = kFrames) {
  SessionRecorder recorder(folder, test::session_header(), test::scripted_options());
  for (int i = 0; i < frames; ++i) recorder.append(test::frame_result(i));
  recorder.add_event({test::frame_result(frames - 1).timestamp_ns, "note", "the end"});
  recorder.finish();
}

// Of frame 102, on which guidance is valid.
void change(const fs::path& folder, const std::string& values) {
  SessionDatabase::open(database_file(folder)).execute(("UPDATE " + values + " WHERE frame = 102").c_str());
}

bool has_pose(const RecordedFrame& frame, int id) {
  return std::any_of(frame.poses.begin(), frame.poses.end(),
                     [&](const strokes::PoseRow& row) { return row.marker_id == id; });
}

// At a glance and in full the same as read whole.
TEST(SessionTimeline, SaysWhatTheWholeRecordSays) {
  const test::TemporaryFolder folder;
  record(folder.path(), 200);
  const RecordedSession whole(folder.path());
  const SessionTimeline timeline(folder.path());
  ASSERT_EQ(timeline.frames().size(), whole.frames().size());
  EXPECT_TRUE(timeline.problems().empty());
  for (std::size_t i = 0; i < timeline.frames().size(); ++i) {
    const RecordedFrame& frame = whole.frames()[i];
    const FrameGlance& glance = timeline.frames()[i];
    EXPECT_EQ(glance.index, frame.index);
    EXPECT_EQ(glance.timestamp_ns, frame.timestamp_ns);
    EXPECT_EQ(glance.guidance, frame.guidance.state);
    EXPECT_EQ(glance.intrinsics_are_known, frame.intrinsics_are_known);
    if (glance.is_guided()) {
      EXPECT_NEAR(static_cast<double>(glance.offset_mm), frame.guidance.offset_mm, 1e-5);
      EXPECT_NEAR(static_cast<double>(glance.angle_deg), frame.guidance.angle_deg, 1e-5);
    }
    for (std::size_t bit = 0; bit < timeline.marker_ids().size(); ++bit)
      EXPECT_EQ((glance.posed >> bit & 1U) != 0, has_pose(frame, timeline.marker_ids()[bit]));
    const RecordedFrame& read = timeline.frame(i);
    EXPECT_EQ(read.poses.size(), frame.poses.size());
    EXPECT_EQ(read.tip_in_world_mm, frame.tip_in_world_mm);
    EXPECT_EQ(read.guidance.guide_point_mm, frame.guidance.guide_point_mm);
    EXPECT_EQ(timeline.at_index(frame.index), i);
    EXPECT_EQ(timeline.at_time(timeline.time_s(i) + 1e-6), i);
  }
  EXPECT_EQ(timeline.at_time(-1), 0U);
  EXPECT_EQ(timeline.at_index(1'000'000), timeline.frames().size() - 1);
}

// A record of which the second half of the file is rotten: what lies before is shown, what is missing is told
// with the file's name, and nothing throws that a time line asks.
TEST(SessionTimeline, ReadsADamagedRecordAsFarAsItIsWhole) {
  const test::TemporaryFolder folder;
  record(folder.path());
  const fs::path file = folder / "session.sqlite";
  const auto size = static_cast<std::streamoff>(fs::file_size(file));
  {
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(size / 2);
    stream << std::string(static_cast<std::size_t>(size / 2), '\xA5');
  }
  const SessionTimeline timeline(folder.path());
  EXPECT_GT(timeline.frames().size(), static_cast<std::size_t>(kFrames / 10));
  EXPECT_LT(timeline.frames().size(), static_cast<std::size_t>(kFrames));
  ASSERT_FALSE(timeline.problems().empty());
  EXPECT_NE(timeline.problems().front().find("session.sqlite"), std::string::npos);
  EXPECT_TRUE(timeline.problems().front().ends_with(": the record cannot be read after frame " +
                                                    std::to_string(timeline.frames().back().index)))
      << timeline.problems().front();
  for (std::size_t i = 0; i < timeline.frames().size(); ++i)
    EXPECT_EQ(timeline.frame(i).index, timeline.frames()[i].index);
  EXPECT_THROW(RecordedSession{folder.path()}, IoError) << "whoever computes with it is told";
  const SessionOverview looked_at = read_overview(folder.path());
  EXPECT_EQ(looked_at.header.probe_name, "probe");
}

// A few damaged pages in the middle: what lies behind them is shown at its own time, and which frames are
// missing is told.
TEST(SessionTimeline, GoesOnBehindDamage) {
  const test::TemporaryFolder folder;
  record(folder.path());
  const fs::path file = folder / "session.sqlite";
  const auto middle = static_cast<std::streamoff>(fs::file_size(file)) / 2 / 4096 * 4096;
  {
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(middle);
    stream << std::string(8 * 4096, '\xA5');
  }
  const SessionTimeline timeline(folder.path());
  ASSERT_FALSE(timeline.problems().empty());
  EXPECT_GT(timeline.frames().size(), static_cast<std::size_t>(kFrames - 600));
  EXPECT_EQ(timeline.frames().back().index, kFrames - 1);
  EXPECT_TRUE(timeline.is_readable(timeline.frames().size() - 1));
  EXPECT_TRUE(timeline.frame(timeline.frames().size() - 1).tip_is_valid ==
              test::frame_result(kFrames - 1).tip_is_valid);
  for (const std::string& problem : timeline.problems()) {
    EXPECT_NE(problem.find(" cannot be read of frames "), std::string::npos) << problem;
    EXPECT_EQ(problem.find(" after frame "), std::string::npos) << problem;
  }
}

// A state that no program writes, as a changed row may hold, is never shown as one: guidance is known up to
// there, and whoever computes with the record is told which number it is.
TEST(SessionTimeline, ShowsNoStateThatThereIsNot) {
  const test::TemporaryFolder folder;
  record(folder.path(), 200);
  change(folder.path(), "guidance SET state = 99");
  const SessionTimeline timeline(folder.path());
  ASSERT_EQ(timeline.frames().size(), 200U);
  ASSERT_EQ(timeline.problems().size(), 1U);
  EXPECT_NE(timeline.problems().front().find("session.sqlite: state: 99 is out of range"), std::string::npos)
      << timeline.problems().front();
  EXPECT_TRUE(timeline.frames()[99].is_guided());
  EXPECT_FALSE(timeline.frames()[102].is_guided());
  EXPECT_FALSE(timeline.frame(102).guidance.is_valid());
  EXPECT_TRUE(timeline.is_readable(99));
  EXPECT_FALSE(timeline.is_readable(102)) << "nobody knows that there was no plan";
  EXPECT_TRUE(timeline.problems().front().ends_with(": the guidance cannot be read after frame 101"));
  EXPECT_THROW(RecordedSession{folder.path()}, InvalidInput);
  for (const char* row :
       {"markers SET state = -1", "frames SET mark_state = 6", "frames SET mark_polarity = 3"}) {
    SCOPED_TRACE(row);
    const test::TemporaryFolder other;
    record(other.path(), 110);
    change(other.path(), row);
    EXPECT_THROW(RecordedSession{other.path()}, InvalidInput);
    const SessionTimeline looked_at(other.path());
    EXPECT_EQ(looked_at.problems().size(), 1U);
    EXPECT_EQ(looked_at.frames().size(), 110U);
  }
}

// Files that are gone or of tomorrow: the rest is there, and each is told.
TEST(SessionTimeline, TellsWhatIsMissing) {
  const test::TemporaryFolder folder;
  record(folder.path(), 10);
  fs::remove(folder / "camera.json");
  files::write_atomically(folder / "tools.json", "{\"format\": \"arthronaut.tools\", \"version\": 99}");
  const SessionOverview session = read_overview(folder.path());
  ASSERT_EQ(session.problems.size(), 2U);
  EXPECT_NE(session.problems[0].find("camera.json"), std::string::npos);
  EXPECT_NE(session.problems[1].find("tools.json"), std::string::npos);
  EXPECT_EQ(session.events.size(), 1U);
  EXPECT_TRUE(session.was_finished && session.end_was_read);
  EXPECT_EQ(SessionTimeline(folder.path()).frames().size(), 10U);
  // Of a record that cannot be read nobody knows how it ended: it was not cut off for that.
  std::ofstream(folder / "session.sqlite") << "spoilt";
  EXPECT_FALSE(read_overview(folder.path()).end_was_read);
}

// Of a damaged page each table says the same, and the file of what was found last is missed only where
// something was found.
TEST(SessionTimeline, TellsWhatIsMissingOnce) {
  const test::TemporaryFolder folder;
  record(folder.path(), 10);
  EXPECT_TRUE(read_overview(folder.path()).problems.empty()) << "nothing was registered";
  const test::TemporaryFolder other;
  {
    SessionRecorder recorder(other.path(), test::session_header(), test::scripted_options());
    recorder.append(test::frame_result(0));
    recorder.set_registration(test::some_registration());
    recorder.finish();
  }
  EXPECT_TRUE(read_overview(other.path()).problems.empty());
  fs::remove(other / "registration.json");
  EXPECT_EQ(read_overview(other.path()).problems,
            std::vector<std::string>{(other / "registration.json").string() + ": is not there any more"});
  {
    std::fstream stream(folder / "session.sqlite", std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(200);  // where the tables are listed
    stream << std::string(3000, '\xA5');
  }
  EXPECT_EQ(read_overview(folder.path()).problems.size(), 1U);
}

// A record that is none, or of a newer program, is refused with its name.
TEST(SessionTimeline, RefusesWhatIsNoRecord) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(SessionTimeline{folder.path()}, IoError);
  std::ofstream(folder / "session.sqlite") << "this is a letter to my aunt, and no record of anything";
  EXPECT_THROW(SessionTimeline{folder.path()}, IoError);
}

}  // namespace
}  // namespace arthronaut::recording
