#include "app/previews/source_previews.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <chrono>
#include <thread>

#include "navigation/sources/device_turns.h"
#include "planning/geometry/error.h"
#include "tests/fake_camera/camera_room.h"

namespace arthronaut::previews {
namespace {

using test::CameraRoom;
using ::testing::HasSubstr;

template <typename IsSo>
bool wait_until(const IsSo& is_so) {
  for (int i = 0; i < 2000 && !is_so(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  return is_so();
}

// A camera is shown with its size and the rate at which pictures come, which a busy machine may lower; when
// it is pulled out that is said.
TEST(SourcePreview, ShowsACameraWithItsSizeAndRate) {
  CameraRoom room;
  room.add_mode(0, V4L2_PIX_FMT_YUYV, {cv::Mat(48, 64, CV_8UC3, cv::Scalar(90, 90, 90))}, {50});
  room.plug();
  const SourcePreview preview([] { return sources::open_device(0); });
  ASSERT_TRUE(wait_until([&] { return preview.latest().frames_per_second > 0; }));
  const Preview seen = preview.latest();
  EXPECT_EQ(seen.size_px, Eigen::Vector2i(64, 48));
  EXPECT_NE(seen.picture, nullptr);
  EXPECT_LT(seen.frames_per_second, 60);
  EXPECT_THAT(words_of(seen), HasSubstr("64 x 48, "));
  room.unplug();
  EXPECT_TRUE(
      wait_until([&] { return words_of(preview.latest()).find("is not connected") != std::string::npos; }));
}

// The operation gets the camera that was looked at, and who looks is refused what the operation has.
TEST(SourcePreview, TakesNoCameraFromTheOperation) {
  CameraRoom room;
  room.add_mode(0, V4L2_PIX_FMT_YUYV, {cv::Mat(48, 64, CV_8UC3, cv::Scalar(90, 90, 90))}, {50});
  room.plug();
  const sources::DeviceTurns turns(sources::open_camera, 60);
  auto preview = std::make_unique<SourcePreview>([turns] { return turns.open_if_free({0}); });
  ASSERT_TRUE(wait_until([&] { return preview->latest().picture != nullptr; }));
  std::jthread closes([&] { preview.reset(); });
  const auto operation = turns.open({0});
  EXPECT_NE(operation->next(), nullptr);
  EXPECT_EQ(room.camera().most_streaming, 1);
  closes.join();
  const SourcePreview refused([turns] { return turns.open_if_free({0}); });
  EXPECT_TRUE(wait_until([&] { return words_of(refused.latest()).find("in use") != std::string::npos; }));
  EXPECT_NE(operation->next(), nullptr);
}

TEST(SourcePreview, SaysWhatItWaitsForAndWhyThereIsNone) {
  EXPECT_EQ(words_of({}), "is being opened");
  EXPECT_EQ(words_of({.waited_s = 5}), "does not answer");
  EXPECT_EQ(words_of({.trouble = "camera 0: no signal"}), "camera 0: no signal");
  const SourcePreview none(
      []() -> std::unique_ptr<sources::FrameSource> { throw DeviceError("nobody there"); });
  EXPECT_TRUE(wait_until([&] { return words_of(none.latest()) == "nobody there"; }));
  const SourcePreview open([]() -> std::unique_ptr<sources::FrameSource> { return nullptr; });
  EXPECT_TRUE(wait_until([&] { return words_of(open.latest()) == "is open now"; }));
  EXPECT_FALSE(open.latest().does_not_answer());
}

}  // namespace
}  // namespace arthronaut::previews
