// A record that goes on for hours: what its end costs, and what a disk that fills up does to it.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <future>
#include <iostream>
#include <memory>
#include <thread>

#include "navigation/recording/picture_writer.h"
#include "navigation/recording/session.h"
#include "planning/files/atomic_file.h"
#include "planning/geometry/error.h"
#include "tests/message_of.h"
#include "tests/navigation/recording/recorded_frames.h"
#include "tests/temporary_folder.h"

namespace arthronaut {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double resident_mb() {
  std::ifstream statm("/proc/self/statm");
  long all = 0, resident = 0;
  statm >> all >> resident;
  return static_cast<double>(resident) * 4096e-6;
}

class BoundedRecording : public ::testing::Test {
 protected:
  // Waits for the recorder's own thread, 10 s at most.
  template <typename Happened>
  static bool eventually(const Happened& happened) {
    const auto deadline = Clock::now() + std::chrono::seconds(10);
    while (!happened()) {
      if (Clock::now() > deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return true;
  }

  const test::TemporaryFolder folder_;
  const pipeline::PipelineOptions options_ = test::scripted_options();
  std::shared_ptr<std::atomic<std::uintmax_t>> free_ =
      std::make_shared<std::atomic<std::uintmax_t>>(std::uintmax_t{100} << 30);
  const recording::DiskLimits limits_{.free_bytes = [free = free_](const fs::path&) { return free->load(); }};
};

// 100,000 frames, half an hour: the record's memory is that of its queue (4096 frames of 4 kB, twice over for
// the allocator), and nothing is read back at the end. The times are told, not judged.
TEST_F(BoundedRecording, StoppingCostsTheSameAfterHalfAnHour) {
  constexpr int kFrames = 100'000;
  constexpr double kQueue_mb = 2 * 4096 * 4096e-6;
  recording::SessionRecorder recorder(folder_.path(), test::session_header(), options_);
  for (int i = 0; i < 1000; ++i) recorder.append(test::frame_result(i));
  const double before_mb = resident_mb();
  double peak_mb = before_mb;
  for (int i = 1000; i < kFrames; ++i) {
    recorder.append(test::frame_result(i));
    if (i % 500 == 0) peak_mb = std::max(peak_mb, resident_mb());
  }
  // In theatre the writer is at most a commit behind.
  const auto rows_on_disk = [&] { return fs::file_size(folder_ / "poses.csv.part"); };
  std::uintmax_t last = 0;
  EXPECT_TRUE(eventually([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(900));
    return std::exchange(last, rows_on_disk()) == rows_on_disk();
  }));
  const auto begin = Clock::now();
  recorder.finish();
  const double finish_s = std::chrono::duration<double>(Clock::now() - begin).count();
  peak_mb = std::max(peak_mb, resident_mb());
  std::cout << kFrames << " frames: finish() " << finish_s << " s, memory grew by " << peak_mb - before_mb
            << " MB\n";
  EXPECT_LT(peak_mb - before_mb, kQueue_mb);
  EXPECT_FALSE(fs::exists(folder_ / "poses.csv.part") || fs::exists(folder_ / "guidance.csv.part"));
  std::ifstream guidance(folder_ / "guidance.csv");
  int lines = 0;
  for (std::string line; std::getline(guidance, line);) ++lines;
  EXPECT_EQ(lines, kFrames + 1);

  // Whoever goes through the frames holds some hundreds of them: all of these would take 150 MB and more.
  const double read_from_mb = resident_mb();
  std::int64_t next = 0;
  double read_peak_mb = read_from_mb;
  const auto session = recording::RecordedSession::without_frames(folder_.path());
  EXPECT_TRUE(session.for_each_frame([&](const recording::RecordedFrame& frame) {
    if (next % 500 == 0) read_peak_mb = std::max(read_peak_mb, resident_mb());
    return frame.index == next++;
  }));
  EXPECT_EQ(next, kFrames);
  EXPECT_LT(read_peak_mb - read_from_mb, kQueue_mb);
}

// A disk that fills up: first the video stops and the record goes on, then the record stops before the disk
// is full, with one error that says why. What was made is a whole session.
TEST_F(BoundedRecording, StopsBeforeTheDiskIsFullAndKeepsWhatWasMade) {
  recording::SessionRecorder recorder(folder_.path(), test::session_header(), options_, limits_);
  const auto picture = [](int i) { return std::make_shared<camera::Frame>(test::plain_frame(i, 80)); };
  int frame = 0;
  for (; frame < 10; ++frame) {
    EXPECT_TRUE(recorder.try_append_picture(picture(frame)));
    recorder.append(test::frame_result(frame));
  }
  EXPECT_FALSE(recorder.has_stopped_video());
  *free_ = std::uintmax_t{1} << 30;
  EXPECT_TRUE(eventually([&] {
    recorder.append(test::frame_result(frame));
    return !recorder.try_append_picture(picture(frame++));
  }));
  EXPECT_TRUE(recorder.has_stopped_video());
  EXPECT_EQ(recorder.video_trouble(), "only 1.0 GiB are free on the disk");
  const int with_video = frame;
  for (; frame < with_video + 10; ++frame) recorder.append(test::frame_result(frame));

  *free_ = std::uintmax_t{50} << 20;
  std::string message;
  EXPECT_TRUE(eventually([&] {
    try {
      recorder.append(test::frame_result(frame++));
    } catch (const IoError& error) {
      message = error.what();
    }
    return !message.empty();
  }));
  EXPECT_NE(message.find("recording stopped: only 50 MiB are free"), std::string::npos) << message;
  EXPECT_NO_THROW(recorder.finish());

  const recording::RecordedSession session(folder_.path());
  EXPECT_TRUE(session.was_finished());
  EXPECT_GE(session.frames().size(), static_cast<std::size_t>(with_video + 10));
  std::vector<std::string> kinds;
  for (const recording::SessionEvent& event : session.events()) kinds.push_back(event.kind);
  const auto has = [&](std::string_view kind) { return std::count(kinds.begin(), kinds.end(), kind) == 1; };
  EXPECT_TRUE(has(recording::kVideoStoppedEvent) && has(recording::kRecordingStoppedEvent));
  EXPECT_EQ(strokes::read_poses_file(folder_ / "poses.csv").size(), 2 * session.frames().size());
  const auto video = recording::open_recorded_video(session);
  int pictures = 0;
  while (video->next()) ++pictures;
  EXPECT_GE(pictures, 10);
}

// A disk that hangs: its writer stands at its first word of a picture, and the queue before it is full.
// Whoever switches the video off does not stand with it, and what was handed over is in its part, the end of
// the part too.
TEST_F(BoundedRecording, EndsAPartOfTheVideoWhileTheDiskHangs) {
  std::promise<void> disk;
  const std::shared_future<void> goes_on = disk.get_future().share();
  std::vector<std::string> said;
  recording::PictureNews news;
  news.begun = [&, goes_on](const recording::VideoPart& part, const camera::Frame& first,
                            const std::string&) {
    goes_on.wait();
    said.push_back("begun " + part.file + " " + std::to_string(first.index));
  };
  std::vector<std::int64_t> kept;
  news.kept = [&](const recording::KeptPicture& picture) { kept.push_back(picture.frame); };
  news.ended = [&](const recording::VideoPart& part) { said.push_back("ended " + part.file); };
  recording::PictureWriter writer(folder_.path(), {}, news);
  const auto picture = [](std::int64_t i) {
    return std::make_shared<camera::Frame>(test::plain_frame(static_cast<int>(i), 80));
  };
  std::vector<std::int64_t> taken;
  std::int64_t frame = 0;
  while (writer.try_write(picture(frame))) taken.push_back(frame++);
  EXPECT_TRUE(eventually([&] {  // the one that the writer stands at has left the queue
    const bool is_taken = writer.try_write(picture(frame));
    if (is_taken) taken.push_back(frame++);
    return !is_taken && taken.size() > 32;
  }));
  // However often it is switched, it is one end: the queue must not grow by it.
  auto switching = std::async(std::launch::async, [&] {
    for (int i = 0; i < 1000; ++i) writer.end_part();
  });
  EXPECT_EQ(switching.wait_for(std::chrono::seconds(1)), std::future_status::ready);
  disk.set_value();
  switching.wait();
  writer.write(picture(1000));
  taken.push_back(1000);
  writer.finish();
  EXPECT_EQ(kept, taken);
  EXPECT_EQ(said, (std::vector<std::string>{"begun video.mkv 0", "ended video.mkv", "begun video_2.mkv 1000",
                                            "ended video_2.mkv"}));
}

// What is kept free on the disk is kept free of a video that is copied at the end, too: it stays where it is,
// and the record is whole.
TEST_F(BoundedRecording, LeavesAVideoThatTheDiskHasNoRoomFor) {
  const fs::path video = folder_ / "came.mp4";
  std::ofstream(video) << std::string(3 << 20, 'x');
  const fs::path session = folder_ / "session";
  fs::create_directory(session);
  *free_ = limits_.video_stops_below_bytes + (std::uintmax_t{2} << 20);
  recording::SessionRecorder recorder(session, test::session_header(), options_, limits_);
  recorder.refer_to_video(video);
  for (int i = 0; i < 10; ++i) recorder.append(test::frame_result(i));
  recorder.copy_video(video);
  EXPECT_NE(recorder.video_trouble().find("2.0 GiB"), std::string::npos) << recorder.video_trouble();
  EXPECT_NO_THROW(recorder.finish());
  EXPECT_FALSE(fs::exists(session / "video.mp4"));
  const recording::RecordedSession record(session);
  EXPECT_TRUE(record.was_finished());
  EXPECT_EQ(record.video(), video);
}

// Half of the stills would pass for all of them.
TEST_F(BoundedRecording, LeavesNoPartOfStillsThatCouldNotBeCopied) {
  const fs::path stills = folder_ / "stills", session = folder_ / "session";
  for (const fs::path& made : {stills, session}) fs::create_directory(made);
  for (int i = 0; i < 3; ++i) std::ofstream(stills / ("f_" + std::to_string(i) + ".png")) << "x";
  fs::create_directory(stills / "f_3.png");  // no file: it cannot be copied
  recording::SessionRecorder recorder(session, test::session_header(), options_, limits_);
  recorder.refer_to_video(stills / "f_%d.png");
  recorder.append(test::frame_result(0));
  recorder.copy_video(stills / "f_%d.png");
  EXPECT_NE(recorder.video_trouble(), "");
  recorder.finish();
  EXPECT_FALSE(fs::exists(session / "pictures"));
}

// A recorder that cannot begin says so at once, with the folder's name: there is no thread behind it that
// could stop anything else.
TEST_F(BoundedRecording, SaysAtOnceThatItCannotBegin) {
  EXPECT_NE(test::message_of<IoError>([&] {
              recording::SessionRecorder(folder_ / "missing", test::session_header(), options_);
            }).find("missing"),
            std::string::npos);
}

}  // namespace
}  // namespace arthronaut
