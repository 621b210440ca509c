#include "navigation/recording/session_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sqlite3.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <random>
#include <thread>

#include "navigation/recording/hash_chain.h"
#include "navigation/recording/operation_record.h"
#include "navigation/recording/session_hashes.h"
#include "navigation/recording/session_timeline.h"
#include "planning/geometry/error.h"
#include "tests/navigation/recording/recorded_frames.h"
#include "tests/temporary_folder.h"

namespace {

std::mutex synced_mutex;
std::map<ino_t, std::int64_t> synced_sizes;  // of files, when they were last forced to the disk

}  // namespace

// In the place of the C library's: what is on the disk for certain is seen nowhere else.
extern "C" int fdatasync(int descriptor) {
  struct stat status {};
  if (::fstat(descriptor, &status) == 0) {
    const std::scoped_lock lock(synced_mutex);
    synced_sizes[status.st_ino] = status.st_size;
  }
  return static_cast<int>(::syscall(SYS_fdatasync, descriptor));
}

namespace arthronaut::recording {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Outcome = SessionCheck::Outcome;

constexpr int kFrames = 90;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}
void put_text(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary | std::ios::trunc) << text;
}

// Noise, so that the video is longer than its head.
camera::FramePtr noisy_picture(int number) {
  std::mt19937 random(static_cast<std::uint32_t>(number));
  auto frame = std::make_shared<camera::Frame>();
  frame->index = number;
  frame->width = 160;
  frame->height = 96;
  frame->bgr.resize(static_cast<std::size_t>(3) * 160 * 96);
  for (std::uint8_t& value : frame->bgr) value = static_cast<std::uint8_t>(random());
  return frame;
}

class SessionCheckTest : public ::testing::Test {
 protected:
  // A session with everything that one can hold; pictures over more than a second, so that its hashes are
  // written piece by piece.
  void record(bool with_pictures = true) {
    SessionRecorder recorder(folder_, test::session_header(), test::scripted_options());
    for (int i = 0; i < kFrames; ++i) {
      if (with_pictures) recorder.append_picture(noisy_picture(i));
      recorder.append(test::frame_result(i));
      recorder.append_digests({static_cast<std::uint64_t>(i), 7});
      recorder.append_latency({.tracking_ms = 3});
      if (i == 40) recorder.set_registration(test::some_registration());
      if (i % 30 == 0) recorder.add_event({test::frame_result(i).timestamp_ns, "note", "a note"});
      std::this_thread::sleep_for(std::chrono::milliseconds(17));
    }
    recorder.set_curves({{0, 0.5, {1, 2, 3}}, {0, 0.6, {1, 2, 4}}});
    recorder.finish();
  }
  void change_database(const std::string& sql) const {
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open((folder_ / "session.sqlite").c_str(), &database), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK);
    sqlite3_close(database);
  }
  void flip_byte(const std::string& name, std::size_t at) const {
    std::string text = text_of(folder_ / name);
    ASSERT_LT(at, text.size());
    text[at] = static_cast<char>(text[at] ^ 0x20);
    put_text(folder_ / name, text);
  }
  // The one finding; its range must hold `place` and be a part of all.
  void expect_one_finding(const std::string& of, std::int64_t place, const std::string& words) const {
    const SessionCheck check = check_session(folder_);
    EXPECT_EQ(check.outcome, Outcome::Broken);
    ASSERT_EQ(check.findings.size(), 1u) << check_words(check);
    const CheckFinding& finding = check.findings.front();
    EXPECT_EQ(finding.of, of);
    EXPECT_LE(finding.from, place);
    EXPECT_GT(finding.to, place);
    EXPECT_THAT(finding.text(), HasSubstr(words));
  }

  const test::TemporaryFolder temporary_;
  const fs::path& folder_ = temporary_.path();
};

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

// A record of before the outside tracker's poses were hashed: its chain says so, and is followed as it is.
TEST_F(SessionCheckTest, FollowsAChainOfBefore) {
  record(false);
  const ReadChain newer = read_chain(folder_);
  fs::remove(folder_ / "chain.csv");
  SessionDatabase database = SessionDatabase::open(folder_ / "session.sqlite");
  HashChain chain(folder_);
  for (const ChainRecord& line : newer.records) {
    const bool is_of_frames = line.of == kFrameRows;
    const std::string of = is_of_frames ? kFrameRowsOfBefore : line.of;
    chain.append(of, line.from, line.to,
                 is_of_frames ? sha256_of_rows(database, of, line.from, line.to) : line.sha256);
  }
  EXPECT_TRUE(check_session(folder_).is_unbroken()) << check_words(check_session(folder_));
  change_database("UPDATE guidance SET angle_deg = angle_deg + 1 WHERE frame = 60");
  expect_one_finding("session.sqlite:frames", 60, "session.sqlite: frames ");
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

// The chain itself: a line that is changed, left out or put elsewhere breaks it there; its end that is gone
// leaves what it spoke of uncovered.
TEST_F(SessionCheckTest, FindsItsOwnChainBroken) {
  record(false);
  const std::string chain = text_of(folder_ / "chain.csv");
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < chain.size(); at = chain.find('\n', at) + 1)
    lines.push_back(chain.substr(at, chain.find('\n', at) + 1 - at));
  ASSERT_GT(lines.size(), 12u);
  const auto joined = [](const std::vector<std::string>& all) {
    std::string text;
    for (const std::string& line : all) text += line;
    return text;
  };
  const auto expect_broken = [&](const std::vector<std::string>& all, const std::string& words) {
    put_text(folder_ / "chain.csv", joined(all));
    const SessionCheck check = check_session(folder_);
    EXPECT_EQ(check.outcome, Outcome::Broken) << words;
    EXPECT_THAT(check_words(check), HasSubstr(words));
    // What the other lines speak of is as recorded, and is not called anything else.
    if (words.find("line ") != std::string::npos) {
      EXPECT_EQ(check.findings.size(), 1u) << words;
    }
  };
  std::vector<std::string> changed = lines;
  changed[8][changed[8].find(',') + 1] ^= 1;
  expect_broken(changed, "chain.csv: is broken: line 9");
  changed = lines;
  changed.erase(changed.begin() + 7);
  expect_broken(changed, "line 8: does not follow");
  changed = lines;
  std::swap(changed[6], changed[7]);
  expect_broken(changed, "line 7: does not follow");
  // Lines after the break still tell what is not as they say.
  flip_byte("camera.json", 5);
  changed = lines;
  const auto of_heading = std::find_if(
      lines.begin(), lines.end(), [](const std::string& line) { return line.ends_with(",session.json\n"); });
  ASSERT_NE(of_heading, lines.end());
  changed[static_cast<std::size_t>(of_heading - lines.begin())][0] = 'x';
  put_text(folder_ / "chain.csv", joined(changed));
  std::vector<std::string> named;
  for (const CheckFinding& finding : check_session(folder_).findings) named.push_back(finding.of);
  EXPECT_THAT(named, ::testing::ElementsAre("chain.csv", "camera.json"));
  flip_byte("camera.json", 5);
  changed.assign(lines.begin(), lines.end() - 4);
  expect_broken(changed, "are not in the chain");
  put_text(folder_ / "chain.csv", "not a chain\n");
  EXPECT_THAT(check_words(check_session(folder_)), HasSubstr("line 1"));
}

std::string without_last_lines(std::string text, int count) {
  for (; count > 0; --count) text.erase(text.rfind('\n', text.size() - 2) + 1);
  return text;
}

// What the chain says of a copied video stands in its last lines: without them nothing speaks of it.
TEST_F(SessionCheckTest, FindsThatTheEndOfAFinishedChainIsGone) {
  const test::TemporaryFolder came;
  put_text(came / "came.mkv", std::string(200000, 'v'));
  {
    SessionRecorder recorder(folder_, test::session_header(), test::scripted_options());
    for (int i = 0; i < 3; ++i) recorder.append(test::frame_result(i));
    recorder.copy_video(came / "came.mkv");
    recorder.finish();
  }
  const std::string chain = text_of(folder_ / "chain.csv");
  ASSERT_TRUE(check_session(folder_).is_unbroken());
  for (const int lines : {2, 3}) {
    SCOPED_TRACE(lines);
    put_text(folder_ / "chain.csv", without_last_lines(chain, lines));
    const SessionCheck check = check_session(folder_);
    EXPECT_EQ(check.outcome, Outcome::Broken);
    EXPECT_THAT(check_words(check), HasSubstr("chain.csv: is cut off"));
  }
  put_text(folder_ / "chain.csv", chain);
  append_event(folder_, {9'000'000'000, "note", "after the end"});
  EXPECT_TRUE(check_session(folder_).is_unbroken());
}

TEST_F(SessionCheckTest, FindsThatTheEndIsGoneOfASessionWithPictures) {
  record();
  const std::string chain = text_of(folder_ / "chain.csv");
  put_text(folder_ / "chain.csv", without_last_lines(chain, 2));
  const SessionCheck check = check_session(folder_);
  EXPECT_EQ(check.outcome, Outcome::Broken);
  EXPECT_THAT(check_words(check), HasSubstr("chain.csv: is cut off"));
  // As a power cut leaves it between the seal and the database's own hash.
  put_text(folder_ / "chain.csv", without_last_lines(chain, 1));
  EXPECT_TRUE(check_session(folder_).is_unbroken());
  EXPECT_THAT(check_session(folder_).notes,
              ElementsAre(HasSubstr("session.sqlite: its rows were looked at")));
}

// A chain that was deleted is told from one that never was.
TEST_F(SessionCheckTest, FindsThatTheChainIsGone) {
  record(false);
  fs::remove(folder_ / "chain.csv");
  EXPECT_EQ(check_session(folder_).outcome, Outcome::Broken);
  EXPECT_EQ(check_words(check_session(folder_)), "chain.csv: is missing");
  std::string header = text_of(folder_ / "session.json");
  const std::size_t at = header.find("\"hash_chain\": true");
  ASSERT_NE(at, std::string::npos);
  put_text(folder_ / "session.json", header.replace(at, 18, "\"older\": true"));
  EXPECT_EQ(check_session(folder_).outcome, Outcome::NoChain);
  EXPECT_EQ(check_words(check_session(folder_)), "holds no hashes");
  put_text(folder_ / "session.json", "{");
  EXPECT_EQ(check_session(folder_).outcome, Outcome::Broken);
}

// After a power cut a file may be the new one while the chain is as it was last forced to the disk: that it
// was about to be written must stand there.
TEST_F(SessionCheckTest, AnnouncesOnTheDiskWhatIsWrittenAnew) {
  record(false);
  const fs::path chain = folder_ / "chain.csv";
  bool is_on_disk = false;
  rewrite_file(folder_, "achieved.json", [&] {
    struct stat status {};
    ASSERT_EQ(::stat(chain.c_str(), &status), 0);
    const std::scoped_lock lock(synced_mutex);
    is_on_disk =
        synced_sizes[status.st_ino] == status.st_size && text_of(chain).ends_with(",achieved.json\n");
    put_text(folder_ / "achieved.json", "{}\n");
  });
  EXPECT_TRUE(is_on_disk);
  EXPECT_TRUE(check_session(folder_).is_unbroken());
}

// Two hours of a chain are megabytes, and the surgeon waits: it is read once, however much is decided.
TEST_F(SessionCheckTest, ReadsAFinishedChainOnceForAllEntries) {
  record(false);
  const auto closings_with = [&](std::size_t count) {
    const int watch = ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    EXPECT_GE(::inotify_add_watch(watch, (folder_ / "chain.csv").c_str(), IN_CLOSE), 0);
    operation::JournalEntry note;
    note.kind = operation::JournalKind::Note;
    append_entries(folder_, std::vector<operation::JournalEntry>(count, note));
    int closings = 0;  // by turns of a reader and of a writer: those that are alike would be joined
    std::array<char, 4096> events{};
    while (::read(watch, events.data(), sizeof(inotify_event)) == static_cast<ssize_t>(sizeof(inotify_event)))
      ++closings;
    ::close(watch);
    return closings;
  };
  EXPECT_EQ(closings_with(1), 2);
  EXPECT_EQ(closings_with(5), 2);
  EXPECT_TRUE(check_session(folder_).is_unbroken());
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
