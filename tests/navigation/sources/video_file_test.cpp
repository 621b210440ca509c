#include <gmock/gmock.h>

#include <fstream>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "navigation/sources/frame_source.h"
#include "planning/geometry/error.h"
#include "tests/navigation/sources/cut_file.h"
#include "tests/temporary_folder.h"

namespace arthronaut::sources {
namespace {

using test::TemporaryFolder;
using ::testing::HasSubstr;

constexpr int kFrames = 30;

// A bright disc that moves 8 px a frame, on noise so that frames have a size.
cv::Mat make_frame(int index) {
  cv::Mat frame(240, 320, CV_8UC3);
  cv::RNG rng(static_cast<std::uint64_t>(index) + 1);
  rng.fill(frame, cv::RNG::UNIFORM, 0, 40);
  cv::circle(frame, {20 + 8 * index, 120}, 15, cv::Scalar(250, 240, 230), cv::FILLED);
  return frame;
}

void write_video(const std::filesystem::path& file, const char* code) {
  cv::VideoWriter writer(file.string(), cv::VideoWriter::fourcc(code[0], code[1], code[2], code[3]), 50,
                         {320, 240});
  ASSERT_TRUE(writer.isOpened());
  for (int i = 0; i < kFrames; ++i) writer.write(make_frame(i));
}

struct Played {
  int frames = 0;
  std::string message;  // of the InvalidInput that ended it; empty where none did
};

Played play(const std::filesystem::path& file) {
  Played played;
  try {
    const auto source = open_video(file);
    while (source->next()) ++played.frames;
  } catch (const InvalidInput& error) {
    played.message = error.what();
  }
  return played;
}

// Every frame comes, in order, with its time, and looks as OpenCV's own reader shows it.
TEST(VideoFile, DecodesEveryFrameAsOpenCvDoes) {
  const TemporaryFolder folder;
  write_video(folder / "v.mkv", "mp4v");
  const auto source = open_video(folder / "v.mkv");
  EXPECT_EQ(source->info().image_size_px, Eigen::Vector2i(320, 240));
  EXPECT_NEAR(source->info().frames_per_second, 50, 1e-9);
  EXPECT_EQ(source->info().encoded_file, folder / "v.mkv");
  cv::VideoCapture reference((folder / "v.mkv").string(), cv::CAP_FFMPEG);
  for (int i = 0; i < kFrames; ++i) {
    const camera::FramePtr frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->index, i);
    EXPECT_EQ(frame->timestamp_ns, i * 20'000'000);
    cv::Mat expected;
    ASSERT_TRUE(reference.read(expected));
    EXPECT_TRUE(std::equal(frame->bgr.begin(), frame->bgr.end(), expected.datastart, expected.dataend)) << i;
  }
  EXPECT_FALSE(source->next());
}

// Complete files of every container end without a complaint.
TEST(VideoFile, EndsQuietlyWhenComplete) {
  const TemporaryFolder folder;
  for (const auto& [name, code] : {std::pair{"v.mkv", "mp4v"}, {"v.mp4", "mp4v"}, {"v.avi", "MJPG"}}) {
    write_video(folder / name, code);
    const Played played = play(folder / name);
    EXPECT_EQ(played.frames, kFrames) << name;
    EXPECT_EQ(played.message, "") << name;
  }
}

// A copy that was interrupted gives its whole frames and then says at which frame it breaks off. OpenCV's
// reader ends as if the video were complete.
TEST(VideoFile, TellsWhereItBreaksOff) {
  const TemporaryFolder folder;
  for (const auto& [name, code] : {std::pair{"v.mkv", "mp4v"}, {"v.avi", "MJPG"}}) {
    write_video(folder / name, code);
    for (const double share : {0.3, 0.55, 0.9}) {
      const std::string cut = std::string("cut_") + name;
      copy_beginning(folder / name, folder / cut, share);
      const Played played = play(folder / cut);
      EXPECT_GT(played.frames, 0) << name << " " << share;
      EXPECT_LT(played.frames, kFrames) << name << " " << share;
      EXPECT_THAT(played.message, HasSubstr(cut));
      EXPECT_THAT(played.message, HasSubstr("frame " + std::to_string(played.frames))) << share;
    }
  }
}

// An MP4 whose index, which stands at its end, is lost can't be opened at all.
TEST(VideoFile, RefusesAnMp4WithoutItsIndex) {
  const TemporaryFolder folder;
  write_video(folder / "v.mp4", "mp4v");
  copy_beginning(folder / "v.mp4", folder / "cut.mp4", 0.6);
  EXPECT_THAT(play(folder / "cut.mp4").message, HasSubstr("cut.mp4"));
}

// Something that is no video is refused with its name.
TEST(VideoFile, RefusesWhatIsNoVideo) {
  const TemporaryFolder folder;
  std::ofstream(folder / "text.mkv") << std::string(5000, 'x');
  std::ofstream(folder / "empty.mkv");
  EXPECT_THAT(play(folder / "text.mkv").message, HasSubstr("text.mkv"));
  EXPECT_THAT(play(folder / "empty.mkv").message, HasSubstr("empty.mkv"));
}

// A device that does not exist is a DeviceError.
TEST(CameraDevice, TellsThatItIsAbsent) { EXPECT_THROW((void)open_device(61), DeviceError); }

}  // namespace
}  // namespace arthronaut::sources
