// Sessions of a stream that is kept as it came: whole, looked at, tampered with, and cut off at any moment by
// a kill, a full disk and a power cut.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <deque>
#include <fstream>
#include <map>
#include <random>

#include "navigation/recording/recorded_pictures.h"
#include "navigation/recording/session.h"
#include "navigation/recording/session_check.h"
#include "tests/navigation/recording/given_picture.h"
#include "tests/navigation/recording/recorded_frames.h"
#include "tests/navigation/recording/streams.h"
#include "tests/temporary_folder.h"

namespace arthronaut::recording {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using test::GivenPicture;
using test::luma_of_picture;
using test::open_when_there;
using test::record;
using test::stream_port;

// A sender of H.264 with key frames a second and a half apart.
class StreamSession : public ::testing::Test {
 protected:
  StreamSession() {
    test::make_clip(clips_ / "clip.mkv", 900,
                    {"-c:v", "libx264", "-preset", "ultrafast", "-tune", "zerolatency", "-g", "45"});
    sender_ = test::send_by_rtsp(port_, test::h264_clip_launch(clips_ / "clip.mkv"));
  }
  [[nodiscard]] std::unique_ptr<sources::FrameSource> open() const {
    return open_when_there(test::rtsp_address(port_));
  }

  const test::TemporaryFolder clips_;
  const std::string port_ = stream_port(0);
  std::unique_ptr<test::ChildProcess> sender_;
};

// What is passed on the way to a picture is the picture of the frame that it says it is, and what no frame
// has is none of any. Going back goes on at once where what lies before was read meanwhile, across a key
// frame, too.
TEST_F(StreamSession, NamesWhatIsPassedAndReadsBefore) {
  const test::TemporaryFolder folder;
  std::map<std::int64_t, std::uint64_t> given;
  {
    const auto source = open();
    SessionRecorder recorder(folder.path(), test::session_header(), test::scripted_options());
    record(*source, recorder, [&](const GivenPicture& picture) {
      if (picture.frame % 11 != 4) given.emplace(picture.frame, picture.luma);
      return given.size() == 150;
    });
    recorder.finish();
  }
  RecordedPictures pictures(read_overview(folder.path()));
  const auto time_of = [](std::int64_t frame) { return test::frame_result(frame).timestamp_ns; };
  int passed = 0, without_frame = 0;
  const auto note = [&](const auto& make) {
    ++passed;
    const camera::FramePtr picture = make();
    if (picture == nullptr) return ++without_frame, true;
    EXPECT_EQ(picture->timestamp_ns, -1);
    const auto same = given.find(picture->index);
    EXPECT_TRUE(same != given.end() && luma_of_picture(*picture) == same->second) << picture->index;
    return true;
  };
  // The last is up to 44 pictures behind its key frame, of which 16 are remembered.
  auto at = std::prev(given.end());
  ASSERT_NE(pictures.picture(at->first, time_of(at->first), note), nullptr);
  std::mt19937 random(4);
  for (int i = 0; i < 30; ++i) {
    at = std::next(given.begin(), std::uniform_int_distribution(0, 149)(random));
    ASSERT_NE(pictures.picture(at->first, time_of(at->first), note), nullptr);
  }
  EXPECT_GT(passed, 100);
  EXPECT_GT(without_frame, 0);

  at = std::prev(given.end());
  ASSERT_NE(pictures.picture(at->first, time_of(at->first)), nullptr);
  passed = 0;
  for (int back = 0; back < 110; ++back) {
    --at;
    pictures.read_before_remembered([] { return true; });
    const camera::FramePtr picture = pictures.picture(at->first, time_of(at->first), note);
    ASSERT_NE(picture, nullptr) << at->first;
    EXPECT_EQ(luma_of_picture(*picture), at->second);
  }
  EXPECT_EQ(passed, 0);
}

// A session of its own: whole by its hashes, every picture under its frame, in order and across; it says how
// its pictures were kept. A bit that is changed in the video is told by the hashes.
TEST_F(StreamSession, ComesBackWholeAndTellsTampering) {
  const test::TemporaryFolder folder;
  std::vector<GivenPicture> given;
  {
    const auto source = open();
    SessionRecorder recorder(folder.path(), test::session_header(), test::scripted_options());
    record(*source, recorder, [&](const GivenPicture& picture) {
      given.push_back(picture);
      return given.size() == 130;
    });
    recorder.finish();
  }
  EXPECT_TRUE(check_session(folder.path()).is_unbroken()) << check_words(check_session(folder.path()));
  const RecordedSession session(folder.path());
  EXPECT_TRUE(session.header().video_has_exact_luma);
  ASSERT_EQ(session.header().video_parts.size(), 1U);
  EXPECT_EQ(session.header().video_parts[0].codec, "h264");
  const auto said = std::find_if(session.events().begin(), session.events().end(),
                                 [](const SessionEvent& event) { return event.kind == kPicturesKeptEvent; });
  ASSERT_NE(said, session.events().end());
  EXPECT_EQ(said->text, "as they came (h264), video.mkv");

  const auto video = open_recorded_video(session);
  RecordedPictures pictures(read_overview(folder.path()));
  for (const GivenPicture& picture : given) {
    if (picture.frame % 11 == 4) continue;
    const camera::FramePtr replayed = video->next();
    ASSERT_NE(replayed, nullptr) << picture.frame;
    EXPECT_EQ(replayed->index, picture.frame);
    EXPECT_EQ(luma_of_picture(*replayed), picture.luma) << picture.frame;
  }
  EXPECT_EQ(video->next(), nullptr);
  std::mt19937 random(2);
  for (int i = 0; i < 60; ++i) {
    const GivenPicture& picture =
        given[std::uniform_int_distribution<std::size_t>(0, given.size() - 1)(random)];
    const camera::FramePtr shown =
        pictures.picture(picture.frame, test::frame_result(picture.frame).timestamp_ns);
    ASSERT_EQ(shown != nullptr, picture.frame % 11 != 4) << picture.frame;
    if (shown != nullptr) {
      EXPECT_EQ(luma_of_picture(*shown), picture.luma) << picture.frame;
    }
  }

  std::fstream file(folder / "video.mkv", std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(fs::file_size(folder / "video.mkv") / 2));
  file.put('x');
  file.close();
  EXPECT_EQ(check_session(folder.path()).outcome, SessionCheck::Outcome::Broken);
}

// A process that records the stream for a while, and tells each picture that it has given to its recorder.
class RecordingProcess {
 public:
  RecordingProcess(const fs::path& folder, const std::string& address, double seconds,
                   rlim_t largest_file = RLIM_INFINITY)
      : seconds_(seconds) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
    process_ = test::run_program(
        {ARTHRONAUT_RECORDING_PROGRAM, folder, address, std::to_string(largest_file)}, ends[1]);
    ::close(ends[1]);
    pipe_ = ends[0];
  }
  ~RecordingProcess() {
    kill();
    ::close(pipe_);
  }
  RecordingProcess(const RecordingProcess&) = delete;
  RecordingProcess& operator=(const RecordingProcess&) = delete;

  // Its time has passed since its first picture, or it has ended by itself.
  [[nodiscard]] bool is_over() {
    listen();
    int status = 0;
    if (::waitpid(process_, &status, WNOHANG) == process_) {
      process_ = -1;
      ended_ = Clock::now();
      listen();
    }
    return has_ended() || recorded_s() >= seconds_;
  }
  [[nodiscard]] bool has_ended() const { return process_ < 0; }
  void kill(int signal = SIGKILL) {
    if (process_ < 0) return;
    ::kill(process_, signal);
    ended_ = Clock::now();
    if (signal == SIGKILL) ::waitpid(std::exchange(process_, -1), nullptr, 0);
    listen();
  }
  // Those that were given more than a second before the end.
  [[nodiscard]] std::vector<GivenPicture> must_be_there() const {
    std::vector<GivenPicture> pictures;
    for (const auto& [when, picture] : given_)
      if (std::chrono::duration<double>(ended_ - when).count() > 1) pictures.push_back(picture);
    return pictures;
  }

 private:
  // Takes in what it has told.
  void listen() {
    GivenPicture picture;
    while (::read(pipe_, &picture, sizeof picture) == static_cast<ssize_t>(sizeof picture))
      given_.emplace_back(Clock::now(), picture);
  }
  [[nodiscard]] double recorded_s() const {
    return given_.empty() ? 0 : std::chrono::duration<double>(Clock::now() - given_.front().first).count();
  }

  double seconds_;
  pid_t process_ = -1;
  int pipe_ = -1;
  std::vector<std::pair<Clock::time_point, GivenPicture>> given_;
  Clock::time_point ended_;
};

// They record side by side. `over`: what is done with each, by its number, as soon as it is over.
template <typename Over>
void record(std::deque<RecordingProcess>& processes, const Over& over) {
  std::vector<bool> was_over(processes.size());
  while (std::count(was_over.begin(), was_over.end(), false) > 0) {
    for (std::size_t i = 0; i < processes.size(); ++i) {
      if (was_over[i] || !processes[i].is_over()) continue;
      was_over[i] = true;
      over(i);
    }
    ::usleep(1000);
  }
}

void expect_all_there(const fs::path& folder, const std::vector<GivenPicture>& wanted) {
  ASSERT_FALSE(wanted.empty());
  const SessionOverview session = read_overview(folder);
  const SessionCheck check = check_session(folder);
  EXPECT_TRUE(check.is_unbroken()) << check_words(check);
  const RecordedSession record(folder);
  ASSERT_FALSE(record.frames().empty());
  EXPECT_GE(record.frames().back().index, wanted.back().frame);
  // As they are replayed.
  std::map<std::int64_t, std::uint64_t> replayed;
  const auto video = open_recorded_video(record);
  while (const camera::FramePtr frame = video->next()) replayed[frame->index] = luma_of_picture(*frame);
  // And as they are looked at, across: the file's index was never written.
  RecordedPictures pictures(session);
  std::mt19937 random(4);
  for (const GivenPicture& picture : wanted) {
    if (picture.frame % 11 == 4) continue;
    ASSERT_TRUE(replayed.contains(picture.frame)) << picture.frame << " of " << wanted.back().frame;
    EXPECT_EQ(replayed[picture.frame], picture.luma) << picture.frame;
  }
  for (int i = 0; i < 20; ++i) {
    const GivenPicture& picture =
        wanted[std::uniform_int_distribution<std::size_t>(0, wanted.size() - 1)(random)];
    if (picture.frame % 11 == 4) continue;
    const camera::FramePtr shown =
        pictures.picture(picture.frame, test::frame_result(picture.frame).timestamp_ns);
    ASSERT_NE(shown, nullptr) << picture.frame << " of " << wanted.back().frame;
    EXPECT_EQ(luma_of_picture(*shown), picture.luma) << picture.frame;
  }
}

// Killed at 20 seeded moments: everything but the last second is there.
TEST_F(StreamSession, LosesAtMostASecondAtAnyOf20Kills) {
  constexpr std::size_t kAtOnce = 10, kRounds = 2;
  std::mt19937 random(23);
  for (std::size_t round = 0; round < kRounds; ++round) {
    const std::deque<test::TemporaryFolder> folders(kAtOnce);
    std::deque<RecordingProcess> processes;
    for (const test::TemporaryFolder& folder : folders)
      processes.emplace_back(folder.path(), test::rtsp_address(port_),
                             std::uniform_real_distribution(1.3, 4.0)(random));
    record(processes, [&](std::size_t i) {
      EXPECT_FALSE(processes[i].has_ended()) << i;
      processes[i].kill();
    });
    for (std::size_t i = 0; i < kAtOnce; ++i) {
      SCOPED_TRACE("round " + std::to_string(round) + ", process " + std::to_string(i));
      expect_all_there(folders[i].path(), processes[i].must_be_there());
    }
  }
}

// A disk that takes no more, all at once and at seeded sizes of a file: nobody watched the room on it. The
// recorder ends with an error, and what was made before is there.
TEST_F(StreamSession, LosesAtMostASecondOnADiskThatIsFullAtOnce) {
  std::mt19937 random(29);
  const std::deque<test::TemporaryFolder> folders(4);
  std::vector<rlim_t> largest;
  std::deque<RecordingProcess> processes;
  for (const test::TemporaryFolder& folder : folders) {
    largest.push_back(std::uniform_int_distribution<rlim_t>(150'000, 1'500'000)(random));
    processes.emplace_back(folder.path(), test::rtsp_address(port_), 12, largest.back());
  }
  record(processes, [&](std::size_t i) { processes[i].kill(); });
  for (std::size_t i = 0; i < folders.size(); ++i) {
    SCOPED_TRACE("no file beyond " + std::to_string(largest[i]) + " bytes");
    const std::vector<GivenPicture> wanted = processes[i].must_be_there();
    if (wanted.empty()) continue;  // full before the first second was over
    expect_all_there(folders[i].path(), wanted);
  }
}

// A file system of its own in a file, on which what was not brought to the disk on purpose stays in memory.
class PowerlessDisk {
 public:
  explicit PowerlessDisk(const fs::path& folder) : folder_(folder) {
    fs::create_directories(mount_point());
    is_mounted_ = run("truncate -s 96M " + image().string()) && run("mkfs.ext4 -q " + image().string()) &&
                  run("mount -o loop,commit=300 " + image().string() + " " + mount_point().string());
  }
  ~PowerlessDisk() { unmount(); }
  PowerlessDisk(const PowerlessDisk&) = delete;
  PowerlessDisk& operator=(const PowerlessDisk&) = delete;

  [[nodiscard]] bool is_mounted() const { return is_mounted_; }
  [[nodiscard]] fs::path mount_point() const { return folder_ / "disk"; }
  // What has reached the disk by now. Nobody may write meanwhile.
  [[nodiscard]] bool remember() {
    return run("cp --sparse=always " + image().string() + " " + remembered().string());
  }
  // What was remembered is all that is there.
  [[nodiscard]] bool come_back() {
    unmount();
    fs::rename(remembered(), image());
    is_mounted_ = run("mount -o loop " + image().string() + " " + mount_point().string());
    return is_mounted_;
  }

 private:
  [[nodiscard]] fs::path image() const { return folder_ / "disk.img"; }
  [[nodiscard]] fs::path remembered() const { return folder_ / "remembered.img"; }
  static bool run(const std::string& command) { return std::system((command + " 2>/dev/null").c_str()) == 0; }
  void unmount() {
    if (std::exchange(is_mounted_, false)) (void)run("umount " + mount_point().string());
  }
  fs::path folder_;
  bool is_mounted_ = false;
};

// The power goes at seeded moments: everything but the last second is on the disk. Where file systems cannot
// be mounted (root alone can) nothing is tried.
TEST_F(StreamSession, LosesAtMostASecondWhenThePowerGoes) {
  std::mt19937 random(31);
  const std::deque<test::TemporaryFolder> folders(6);
  std::deque<PowerlessDisk> disks;
  std::deque<RecordingProcess> processes;
  const auto session_on = [](const PowerlessDisk& disk) { return disk.mount_point() / "session"; };
  for (const test::TemporaryFolder& folder : folders) {
    disks.emplace_back(folder.path());
    if (!disks.back().is_mounted()) GTEST_SKIP() << "no file system can be mounted here";
    fs::create_directory(session_on(disks.back()));
  }
  for (const PowerlessDisk& disk : disks)
    processes.emplace_back(session_on(disk), test::rtsp_address(port_),
                           std::uniform_real_distribution(1.6, 5.0)(random));
  std::vector<std::vector<GivenPicture>> wanted(disks.size());
  record(processes, [&](std::size_t i) {
    SCOPED_TRACE(i);
    ASSERT_FALSE(processes[i].has_ended());
    processes[i].kill(SIGSTOP);
    wanted[i] = processes[i].must_be_there();
    ::usleep(50'000);  // a write that was under way comes to its end
    ASSERT_TRUE(disks[i].remember());
    processes[i].kill();
  });
  for (std::size_t i = 0; i < disks.size() && !HasFailure(); ++i) {
    SCOPED_TRACE(i);
    ASSERT_TRUE(disks[i].come_back());
    expect_all_there(session_on(disks[i]), wanted[i]);
  }
}

}  // namespace
}  // namespace arthronaut::recording
