// The whole program on cameras that are none: what `arthronaut sources` lists, and `arthronaut navigate` on
// one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <thread>

#include "navigation/sources/frame_source.h"
#include "tests/app/command_line/marker_clip.h"
#include "tests/fake_camera/camera_room.h"
#include "tests/resources/described.h"

namespace arthronaut {
namespace {

using test::run_program;
using ::testing::HasSubstr;

class CameraProgram : public ::testing::Test {
 protected:
  CameraProgram() {
    test::write_marker_clip(folder_);
    std::vector<std::uint8_t> scratch;
    const auto clip = sources::open_video(folder_ / "clip.mkv");
    while (const auto frame = clip->next()) {
      std::vector<std::uint8_t> bgr = bgr_of(*frame, scratch);
      pictures_.push_back(cv::Mat(frame->height, frame->width, CV_8UC3, bgr.data()).clone());
    }
    ::setenv("LD_PRELOAD", FAKE_CAMERA_LIBRARY, 1);
  }
  ~CameraProgram() override { ::unsetenv("LD_PRELOAD"); }

  test::TemporaryFolder folder_;
  test::CameraRoom room_;
  std::vector<cv::Mat> pictures_;
};

TEST_F(CameraProgram, ListsWhatIsConnected) {
  EXPECT_THAT(run_program({"sources"}).output, HasSubstr("No camera is connected"));
  room_.add_mode(0, V4L2_PIX_FMT_MJPEG, pictures_, {60, 30});
  room_.add_mode(0, V4L2_PIX_FMT_YUYV, pictures_, {10});
  room_.add_mode(1, V4L2_PIX_FMT_UYVY, pictures_, {25});
  room_.camera(1).standards = V4L2_STD_PAL | V4L2_STD_NTSC;
  room_.camera(1).standard = V4L2_STD_PAL;
  room_.camera(1).input_status = V4L2_IN_ST_NO_SIGNAL;
  room_.plug(0);
  room_.plug(1);
  const auto listed = run_program({"sources"});
  EXPECT_EQ(listed.exit_code, 0) << listed.errors;
  EXPECT_THAT(listed.output, HasSubstr("/dev/video0: Fake camera 0\n"));
  EXPECT_THAT(listed.output, HasSubstr("mjpeg   640 x 480  at 60 30 pictures/s\n"));
  EXPECT_THAT(listed.output, HasSubstr("is opened as 640 x 480, 60/s, mjpeg\n"));
  EXPECT_THAT(listed.output, HasSubstr("standards [PAL] NTSC\n  ! no signal: check the cable"));
  const auto document = nlohmann::json::parse(run_program({"sources", "--json"}).output);
  EXPECT_EQ(test::undescribed(document, "sources"), "");
  const auto list = document.at("cameras");
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0]["source"], "/dev/video0");
  EXPECT_EQ(list[0]["modes"].size(), 3U);
  EXPECT_EQ(list[0]["opened_as"]["frames_per_second"], 60);
  EXPECT_EQ(list[1]["inputs"][0]["standard"], "PAL");

  EXPECT_THAT(run_program({"sources", "/dev/video0?format=yuyv"}).output,
              HasSubstr("opened as 640 x 480, 10/s, yuyv"));
  const auto absent = run_program({"sources", "/dev/video3"});
  EXPECT_EQ(absent.exit_code, 3);
  EXPECT_THAT(absent.errors, HasSubstr("camera 3: is not connected"));
  const auto unknown = run_program({"sources", "/dev/video0?colour=red"});
  EXPECT_EQ(unknown.exit_code, 3);
  EXPECT_THAT(unknown.errors, HasSubstr("\"colour=red\""));
  const auto clip = run_program({"sources", "clip.mkv"});
  EXPECT_EQ(clip.exit_code, 3);
  EXPECT_THAT(clip.errors, HasSubstr("clip.mkv: is no camera; one is named as /dev/video0 is"));
}

// From the driver's memory to a recorded session, with the plug pulled out and put in again on the way.
TEST_F(CameraProgram, NavigatesOnACamera) {
  room_.add_mode(0, V4L2_PIX_FMT_NV12, pictures_, {30});
  room_.plug();
  const std::string knee = folder_ / "knee.arthro";
  ASSERT_EQ(run_program({"phantom", "-o", knee}).exit_code, 0);
  std::jthread hand([this] {
    // A program that shares its processor takes seconds for its first picture.
    while (room_.camera().given < 150) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    room_.unplug();
    std::this_thread::sleep_for(std::chrono::milliseconds(1000));
    room_.plug();
  });
  const auto navigated = run_program({"navigate", knee, "--video", "/dev/video0?rate=30", "--duration-s",
                                      "11", "--camera", folder_ / "camera.json", "--tools",
                                      folder_ / "tools.json", "--medium", "air", "--fixed-lens"});
  // Nothing reliable comes of a probe that touches no bone.
  EXPECT_EQ(navigated.exit_code, 4) << navigated.errors;
  EXPECT_THAT(navigated.output, HasSubstr("source: No picture comes: "));
  EXPECT_THAT(navigated.output, HasSubstr("camera 0: "));
  EXPECT_THAT(navigated.output, HasSubstr("latency: "));
  EXPECT_GT(room_.camera().given, 155);
  EXPECT_EQ(room_.camera().streaming, 0);
  const auto refused =
      run_program({"navigate", knee, "--video", "/dev/video0?size=1x1", "--duration-s", "1"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.errors, HasSubstr("it gives 640 x 480, 30/s, nv12"));
}

}  // namespace
}  // namespace arthronaut
