#include "navigation/recording/session_check.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <optional>

#include "navigation/recording/operation_record.h"
#include "navigation/recording/session_hashes.h"
#include "navigation/recording/session_timeline.h"
#include "planning/geometry/error.h"
#include "tests/navigation/recording/checked_session.h"

namespace arthronaut::recording {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Outcome = SessionCheck::Outcome;

TEST_F(SessionCheckTest, FindsAWholeSessionUnbroken) {
  record();
  std::int64_t told = 0;
  const SessionCheck check = check_session(folder_, [&](std::int64_t done, std::int64_t) { told = done; });
  EXPECT_EQ(check.outcome, Outcome::Unbroken) << check_words(check);
  EXPECT_TRUE(check.was_finished);
  EXPECT_THAT(check.notes, testing::IsEmpty());
  EXPECT_GT(told, 10);
  EXPECT_EQ(check.head, chain_head(folder_));
  EXPECT_EQ(check.head.size(), 64u);
  // All bytes of the files that it speaks of were looked at, each once.
  std::int64_t size = 0;
  for (const char* const name :
       {"session.json", "camera.json", "tools.json", "poses.csv", "guidance.csv", "curves.csv",
        "registration.json", "registration_1.json", "video.mkv", "session.sqlite"})
    size += static_cast<std::int64_t>(fs::file_size(folder_ / name));
  EXPECT_EQ(check.covered_bytes, size);
}

// Reading a session, marks and what is decided after its end leave it unbroken.
TEST_F(SessionCheckTest, StaysUnbrokenWithWhatComesLater) {
  record(false);
  (void)RecordedSession(folder_);
  append_event(folder_, {9'000'000'000, "note", "after the end"});
  rewrite_file(folder_, "achieved.json", [&] { put_text(folder_ / "achieved.json", "{}\n"); });
  put_text(folder_ / "marks.json", "{}\n");
  const SessionCheck check = check_session(folder_);
  EXPECT_EQ(check.outcome, Outcome::Unbroken) << check_words(check);
  put_text(folder_ / "achieved.json", "[]\n");
  EXPECT_EQ(check_session(folder_).findings.size(), 1u);
}

// Whoever looks at a session while it is recorded keeps it from nothing, however long: a time line that stays
// open lets go of the file by itself.
TEST_F(SessionCheckTest, EndsWholeWhileATimeLineOfItIsLookedAt) {
  std::optional<SessionTimeline> looked_at;
  SessionRecorder recorder(folder_, test::session_header(), test::scripted_options());
  for (int i = 0; i < kFrames; ++i) {
    recorder.append(test::frame_result(i));
    std::this_thread::sleep_for(std::chrono::milliseconds(17));
    if (i == kFrames / 2) looked_at.emplace(folder_);
  }
  ASSERT_FALSE(looked_at->frames().empty());
  EXPECT_NO_THROW(recorder.finish());
  EXPECT_TRUE(looked_at->is_readable(looked_at->frames().size() - 1));
  EXPECT_FALSE(fs::exists(folder_ / "session.sqlite-wal"));
  const SessionCheck check = check_session(folder_);
  EXPECT_TRUE(check.is_unbroken()) << check_words(check);
  EXPECT_THAT(check.notes, testing::IsEmpty());
}

// Another program that holds the file open when the session ends: all is kept, and what comes later finds one
// file that is whole.
TEST_F(SessionCheckTest, EndsWholeWhileAnotherProgramReadsIt) {
  std::optional<SessionRecorder> recorder(std::in_place, folder_, test::session_header(),
                                          test::scripted_options());
  std::optional<SessionDatabase> reader;
  for (int i = 0; i < kFrames; ++i) {
    recorder->append(test::frame_result(i));
    std::this_thread::sleep_for(std::chrono::milliseconds(17));
    if (i == kFrames / 2) reader.emplace(SessionDatabase::open(folder_ / "session.sqlite"));
  }
  EXPECT_NO_THROW(recorder->finish());
  recorder.reset();
  const SessionCheck meanwhile = check_session(folder_);
  EXPECT_TRUE(meanwhile.is_unbroken()) << check_words(meanwhile);
  EXPECT_THAT(meanwhile.notes, testing::ElementsAre(HasSubstr("session.sqlite: its rows were looked at")));
  append_event(folder_, {9'000'000'000, "note", "after the end, still read"});
  EXPECT_TRUE(check_session(folder_).is_unbroken());
  reader.reset();
  const RecordedSession session(folder_);
  EXPECT_TRUE(session.was_finished());
  EXPECT_EQ(session.frames().size(), std::size_t{kFrames});
  EXPECT_FALSE(fs::exists(folder_ / "session.sqlite-wal"));
  append_event(folder_, {9'500'000'000, "note", "after the end"});
  const SessionCheck check = check_session(folder_);
  EXPECT_TRUE(check.is_unbroken()) << check_words(check);
  EXPECT_THAT(check.notes, testing::IsEmpty());
}

// One byte anywhere, in the head, in the middle and at the end: the stretch that holds it is named, and no
// other.
TEST_F(SessionCheckTest, SaysWhichBytesAreWrong) {
  record();
  for (const char* const name : {"video.mkv", "poses.csv", "guidance.csv"}) {
    const auto size = static_cast<std::int64_t>(fs::file_size(folder_ / name));
    for (const std::int64_t at : {std::int64_t{3}, size / 2, size - 1}) {
      SCOPED_TRACE(name + std::string(" at ") + std::to_string(at));
      flip_byte(name, static_cast<std::size_t>(at));
      expect_one_finding(name, at, "are not what was recorded");
      EXPECT_LT(check_session(folder_).findings.front().to - check_session(folder_).findings.front().from,
                size);
      flip_byte(name, static_cast<std::size_t>(at));
    }
  }
  flip_byte("camera.json", 5);
  expect_one_finding("camera.json", 5, "are not what was recorded");
}

// A number in the database is part of what is hashed, in whatever table it stands.
TEST_F(SessionCheckTest, SaysWhichFramesAndEventsWereChanged) {
  record(false);
  const std::string whole = text_of(folder_ / "session.sqlite");
  for (const char* const change : {"UPDATE guidance SET angle_deg = angle_deg + 1 WHERE frame = 60",
                                   "UPDATE latency SET tracking_ms = 4 WHERE frame = 60",
                                   "INSERT INTO bodies(frame, body_id) VALUES(60, 0)",
                                   "INSERT INTO outside(frame, place, body_id) VALUES(60, 0, 0)"}) {
    SCOPED_TRACE(change);
    change_database(change);
    expect_one_finding("session.sqlite:frames.2", 60, "session.sqlite: frames ");
    put_text(folder_ / "session.sqlite", whole);
  }
  EXPECT_TRUE(check_session(folder_).is_unbroken());
  change_database("UPDATE events SET text = 'another note' WHERE id = 2");
  expect_one_finding("session.sqlite:events", 2, "are not what was recorded");
}

// Bytes that no number is read from, too: beside the rows of a page, in its header, in a table that is empty.
TEST_F(SessionCheckTest, FindsDamageAnywhereInTheDatabase) {
  record(false);
  const std::string whole = text_of(folder_ / "session.sqlite");
  std::mt19937 random(14);
  for (int i = 0; i < 60; ++i) {
    const std::size_t at = std::uniform_int_distribution<std::size_t>(0, whole.size() - 14)(random);
    SCOPED_TRACE(at);
    std::string damaged = whole;
    for (std::size_t k = 0; k < 14; ++k) damaged[at + k] = static_cast<char>(damaged[at + k] ^ 0x55);
    put_text(folder_ / "session.sqlite", damaged);
    const SessionCheck check = check_session(folder_);
    EXPECT_EQ(check.outcome, Outcome::Broken);
    EXPECT_THAT(check_words(check), HasSubstr("session.sqlite: "));
  }
  put_text(folder_ / "session.sqlite", whole);
  EXPECT_TRUE(check_session(folder_).is_unbroken());
  put_text(folder_ / "session.sqlite", whole + "more");
  expect_one_finding("session.sqlite", static_cast<std::int64_t>(whole.size()), "are not in the chain");
}

TEST_F(SessionCheckTest, SaysWhatIsMissingAndWhatWasAdded) {
  record();
  const std::string poses = text_of(folder_ / "poses.csv"), chain = text_of(folder_ / "chain.csv");
  put_text(folder_ / "poses.csv", poses.substr(0, poses.size() - 10));
  expect_one_finding("poses.csv", static_cast<std::int64_t>(poses.size()) - 5, "are missing");
  // From where the file really ends on; what is left before has no hash of its own.
  EXPECT_EQ(check_session(folder_).findings.front().from, static_cast<std::int64_t>(poses.size()) - 10);
  EXPECT_THAT(check_session(folder_).notes, ElementsAre(HasSubstr("not looked at")));
  put_text(folder_ / "poses.csv", poses + "90,0");
  expect_one_finding("poses.csv", static_cast<std::int64_t>(poses.size()), "are not in the chain");
  put_text(folder_ / "poses.csv", poses);
  const std::string database = text_of(folder_ / "session.sqlite");
  change_database("INSERT INTO events(after_frame, timestamp_ns, kind, text) VALUES(1, 2, 'note', 'new')");
  EXPECT_EQ(check_session(folder_).findings.size(), 1u);
  put_text(folder_ / "session.sqlite", database);
  EXPECT_TRUE(check_session(folder_).is_unbroken());
  fs::remove(folder_ / "camera.json");
  expect_one_finding("camera.json", 0, "are missing");
}

TEST_F(SessionCheckTest, ChecksTheRestWhereTheDatabaseCannotBeRead) {
  record();
  put_text(folder_ / "session.sqlite", "not a database at all, and long enough to be none for certain");
  const SessionCheck check = check_session(folder_);
  EXPECT_EQ(check.outcome, Outcome::Broken);
  EXPECT_THAT(check_words(check), HasSubstr("session.sqlite: is not readable"));
  // Where the session lies is not told: a folder may bear the patient's name.
  EXPECT_THAT(check_words(check), testing::Not(HasSubstr(folder_.string())));
  EXPECT_GT(check.covered_bytes, 65536);
}

TEST_F(SessionCheckTest, CoversACopiedVideoAndSaysWhatLiesElsewhere) {
  const fs::path video = temporary_.path() / "came.mkv";
  const test::TemporaryFolder copied, referred;
  put_text(video, std::string(200000, 'v'));
  for (const fs::path& folder : {copied.path(), referred.path()}) {
    SessionRecorder recorder(folder, test::session_header(), test::scripted_options());
    recorder.append(test::frame_result(0));
    folder == copied.path() ? recorder.copy_video(video) : recorder.refer_to_video(video);
    recorder.finish();
    EXPECT_TRUE(check_session(folder).is_unbroken());
  }
  EXPECT_GT(check_session(copied.path()).covered_bytes, 200000);
  ASSERT_EQ(check_session(referred.path()).notes.size(), 1u);
  EXPECT_THAT(check_session(referred.path()).notes.front(), HasSubstr("lies elsewhere"));
  EXPECT_THROW((void)check_session(folder_ / "none"), IoError);
}

// Killed at seeded moments, a session holds to its last whole hash; nothing is called changed that was not.
TEST_F(SessionCheckTest, HoldsAfterAKillUpToItsLastWholeRecord) {
  std::mt19937 random(5);
  for (int round = 0; round < 6; ++round) {
    const test::TemporaryFolder folder;
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      SessionRecorder recorder(folder.path(), test::session_header(), test::scripted_options());
      for (int i = 0;; ++i) {
        recorder.append_picture(noisy_picture(i));
        recorder.append(test::frame_result(i));
        if (i % 20 == 10) recorder.set_registration(test::some_registration());
        ::usleep(4000);
      }
    }
    // On a machine that does other things, too, its first records take a while.
    const auto covered_bytes = [&] {
      try {
        return check_session(folder.path()).covered_bytes;
      } catch (const IoError&) {
        return decltype(SessionCheck::covered_bytes){0};
      }
    };
    for (int i = 0; i < 200 && covered_bytes() <= 65536; ++i) ::usleep(100'000);
    ::usleep(std::uniform_int_distribution(0, 800'000)(random));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    const SessionCheck check = check_session(folder.path());
    EXPECT_EQ(check.outcome, Outcome::Unbroken) << round << ": " << check_words(check);
    EXPECT_FALSE(check.was_finished);
    EXPECT_GT(check.record_count, 8);
    EXPECT_GT(check.covered_bytes, 65536);
  }
}

}  // namespace
}  // namespace arthronaut::recording
