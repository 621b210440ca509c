// The chain of a session's hashes as a file: followed, broken, cut off, gone, forced to the disk.
#include "navigation/recording/hash_chain.h"

#include <sys/inotify.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <map>
#include <mutex>

#include "navigation/recording/operation_record.h"
#include "navigation/recording/session_hashes.h"
#include "tests/navigation/recording/checked_session.h"

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
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Outcome = SessionCheck::Outcome;

std::string without_last_lines(std::string text, int count) {
  for (; count > 0; --count) text.erase(text.rfind('\n', text.size() - 2) + 1);
  return text;
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

}  // namespace
}  // namespace arthronaut::recording
