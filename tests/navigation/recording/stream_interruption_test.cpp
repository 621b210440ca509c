// Sessions of a stream that is kept as it came, cut off at any moment by a kill, a full disk and a power cut.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <deque>
#include <map>
#include <random>

#include "navigation/recording/recorded_pictures.h"
#include "navigation/recording/session.h"
#include "navigation/recording/session_check.h"
#include "tests/navigation/recording/given_picture.h"
#include "tests/navigation/recording/recorded_frames.h"
#include "tests/navigation/recording/stream_session.h"

namespace arthronaut::recording {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using test::GivenPicture;
using test::luma_of_picture;

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
