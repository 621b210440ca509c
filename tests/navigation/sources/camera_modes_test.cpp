#include "navigation/sources/camera_modes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "navigation/sources/lost_pictures.h"
#include "planning/geometry/error.h"
#include "tests/message_of.h"

namespace arthronaut::sources {
namespace {

using test::message_of;
using ::testing::HasSubstr;

TEST(CameraAddress, IsKnownByItsForm) {
  for (const char* camera : {"/dev/video0", "/dev/video12", "/dev/video0?rate=60", "/dev/video0?nonsense"})
    EXPECT_TRUE(is_camera_address(camera)) << camera;
  for (const char* other :
       {"/dev/video", "/dev/videox", "/dev/video0/x", "/dev/video-1", "clip.mkv", "?", ""})
    EXPECT_FALSE(is_camera_address(other)) << other;
}

TEST(CameraAddress, SaysWhatIsWished) {
  EXPECT_EQ(read_camera_address("/dev/video3").index, 3);
  const CameraAddress all =
      read_camera_address("/dev/video2?format=mjpeg&size=1920x1080&rate=59.94&standard=pal&input=1");
  EXPECT_EQ(all.index, 2);
  EXPECT_EQ(all.wish.format, "mjpeg");
  EXPECT_EQ(all.wish.size_px, Eigen::Vector2i(1920, 1080));
  EXPECT_DOUBLE_EQ(all.wish.frames_per_second, 59.94);
  EXPECT_EQ(all.wish.standard, "pal");
  EXPECT_EQ(all.wish.input, 1);
}

// What is not understood is never passed over: a mode that was asked for is the mode that comes.
TEST(CameraAddress, RefusesWhatItDoesNotUnderstand) {
  const auto refusal = [](const std::string& wish) {
    return message_of<InvalidInput>([&] { (void)read_camera_address("/dev/video0?" + wish); });
  };
  EXPECT_THAT(refusal("fromat=mjpeg"), HasSubstr("\"fromat=mjpeg\": format=, size="));
  EXPECT_THAT(refusal("format=h264"), HasSubstr("\"h264\": is no format that can be read: nv12, "));
  for (const char* size : {"1920", "1920x", "x1080", "0x0", "-1x5", "1920x1080p"})
    EXPECT_THAT(refusal(std::string("size=") + size), HasSubstr("is no size")) << size;
  for (const char* rate : {"0", "-5", "fast", "nan", ""})
    EXPECT_THAT(refusal(std::string("rate=") + rate), HasSubstr("is no rate")) << rate;
  EXPECT_THAT(refusal("input=-1"), HasSubstr("is no input"));
  EXPECT_THAT(refusal("standard="), HasSubstr("may stand here"));
}

// A webcam as they are: uncompressed is slow where it is large.
const std::vector<CameraMode> kWebcam{{"yuyv", {1920, 1080}, 5},   {"yuyv", {1280, 720}, 10},
                                      {"yuyv", {640, 480}, 30},    {"mjpeg", {1920, 1080}, 30},
                                      {"mjpeg", {1920, 1080}, 60}, {"mjpeg", {1280, 720}, 60},
                                      {"H264", {3840, 2160}, 60}};

TEST(ChooseMode, TakesTheLargestThatIsFastEnough) {
  EXPECT_EQ(choose_mode(kWebcam, {}), (CameraMode{"mjpeg", {1920, 1080}, 60}));
}

// The same size and rate come without the decoder's time and the compression's traces.
TEST(ChooseMode, TakesUncompressedWhereItsRateAllows) {
  const std::vector<CameraMode> card{{"mjpeg", {1920, 1080}, 60},
                                     {"yuyv", {1920, 1080}, 59.94},
                                     {"nv12", {1920, 1080}, 60},
                                     {"yuyv", {1920, 1080}, 120}};
  EXPECT_EQ(choose_mode(card, {})->format, "nv12");
  EXPECT_EQ(choose_mode(std::span(card).first(2), {})->format, "yuyv");
}

TEST(ChooseMode, TakesTheFastestWhereAllAreSlow) {
  const std::vector<CameraMode> slow{
      {"yuyv", {1920, 1080}, 5}, {"yuyv", {640, 480}, 15}, {"mjpeg", {800, 600}, 15}};
  EXPECT_EQ(choose_mode(slow, {}), (CameraMode{"mjpeg", {800, 600}, 15}));
}

TEST(ChooseMode, GivesWhatIsWishedOrNothing) {
  EXPECT_EQ(choose_mode(kWebcam, {.format = "yuyv"}), (CameraMode{"yuyv", {640, 480}, 30}));
  EXPECT_EQ(choose_mode(kWebcam, {.size_px = {1280, 720}}), (CameraMode{"mjpeg", {1280, 720}, 60}));
  EXPECT_EQ(choose_mode(kWebcam, {.frames_per_second = 29.97}), (CameraMode{"mjpeg", {1920, 1080}, 30}));
  EXPECT_FALSE(choose_mode(kWebcam, {.size_px = {1921, 1080}}));
  EXPECT_FALSE(choose_mode(kWebcam, {.format = "nv12"}));
  EXPECT_FALSE(choose_mode(kWebcam, {.frames_per_second = 50}));
  // The calibration's size is a preference.
  EXPECT_EQ(choose_mode(kWebcam, {.prefers_px = {640, 480}}), (CameraMode{"yuyv", {640, 480}, 30}));
  EXPECT_EQ(choose_mode(kWebcam, {.prefers_px = {800, 600}})->size_px, Eigen::Vector2i(1920, 1080));
  // Of what is not known what comes decides.
  const std::vector<CameraMode> untold{{"uyvy", {1920, 1080}, 0}};
  EXPECT_TRUE(choose_mode(untold, {.frames_per_second = 50}));
}

// What the driver cannot give in a form that is read is never chosen.
TEST(ChooseMode, LeavesOutWhatItCannotRead) {
  const std::vector<CameraMode> stream{{"H264", {1920, 1080}, 60}};
  EXPECT_FALSE(choose_mode(stream, {}));
}

constexpr std::int64_t kInterval_ns = 16'666'667;

// One in ten is told within 2 s and taken back in the 2 s that follow; the count goes over 2^32.
TEST(LostPictures, AreToldByTheDriversCount) {
  LostPictures lost;
  std::uint32_t sequence = 0xFFFFFFFF - 50;
  std::int64_t now_ns = 1'000'000'000, missing = 0;
  const auto come = [&](int count, bool loses) {
    for (int i = 0; i < count; ++i) {
      const std::uint32_t step = loses && i % 10 == 9 ? 2 : 1;
      sequence += step;
      now_ns += step * kInterval_ns;
      missing += lost.came(sequence, false, now_ns);
    }
  };
  come(130, true);
  EXPECT_EQ(missing, 13);
  EXPECT_EQ(lost.lost(), 13);
  EXPECT_THAT(lost.words(), HasSubstr("pictures were lost"));
  come(260, false);
  EXPECT_EQ(lost.words(), "");
  EXPECT_EQ(lost.lost(), 13);
}

// A damaged one is missing before the next; a driver that counts anew loses nothing; a single one is no news.
TEST(LostPictures, CountWhatIsDamagedAndNoNewBeginning) {
  LostPictures lost;
  EXPECT_EQ(lost.came(10, false, 0), 0);
  EXPECT_EQ(lost.came(11, true, kInterval_ns), 0);
  EXPECT_EQ(lost.came(12, false, 2 * kInterval_ns), 1);
  EXPECT_EQ(lost.came(0, false, 3 * kInterval_ns), 0);
  EXPECT_EQ(lost.came(0, false, 4 * kInterval_ns), 0);
  EXPECT_EQ(lost.lost(), 1);
  for (std::uint32_t i = 1; i < 200; ++i) EXPECT_EQ(lost.came(i, false, (4 + i) * kInterval_ns), 0);
  EXPECT_EQ(lost.words(), "");
}

}  // namespace
}  // namespace arthronaut::sources
