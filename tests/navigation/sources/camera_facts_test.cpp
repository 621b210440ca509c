// What is said of cameras that are none (tests/fake_camera), without a picture being taken.
#include "navigation/sources/camera_facts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <utility>

#include "navigation/sources/connected_cameras.h"
#include "tests/fake_camera/camera_room.h"

namespace arthronaut::sources {
namespace {

using test::CameraRoom;
using ::testing::HasSubstr;

TEST(CameraFacts, TellsWhatIsConnected) {
  CameraRoom room;
  room.add_mode(0, V4L2_PIX_FMT_MJPEG, {160, 120}, {{1, 2, 3}}, {60, 30});
  room.add_mode(0, V4L2_PIX_FMT_H264, {1920, 1080}, {{1, 2, 3}}, {60});
  room.camera().standards = V4L2_STD_PAL | V4L2_STD_NTSC;
  room.camera().standard = V4L2_STD_PAL;
  room.camera().input_status = V4L2_IN_ST_NO_SIGNAL;
  room.plug(0);
  room.plug(1);  // without modes: metadata
  const auto connected = connected_cameras();
  ASSERT_EQ(connected.size(), 1U);
  EXPECT_EQ(connected[0].name, "Fake camera 0");
  const CameraFacts facts = camera_facts({0});
  EXPECT_EQ(facts.trouble, "");
  EXPECT_THAT(facts.identity, HasSubstr("fake, Fake camera 0"));
  EXPECT_EQ(facts.modes,
            (std::vector<CameraMode>{
                {"mjpeg", {160, 120}, 60}, {"mjpeg", {160, 120}, 30}, {"H264", {1920, 1080}, 60}}));
  EXPECT_EQ(facts.chosen, (CameraMode{"mjpeg", {160, 120}, 60}));
  ASSERT_EQ(facts.inputs.size(), 1U);
  EXPECT_EQ(facts.inputs[0].standards, (std::vector<std::string>{"PAL", "NTSC"}));
  EXPECT_EQ(facts.inputs[0].standard, "PAL");
  EXPECT_THAT(facts.inputs[0].trouble, HasSubstr("no signal"));
  EXPECT_EQ(camera_facts({3}).trouble, "camera 3: is not connected");
}

// A range of sizes instead of a list: that of the calibration is on offer, too; and a format whose range
// holds none of the usual sizes is given at its largest, whatever other formats there are.
TEST(CameraFacts, ChoosesTheCalibratedSizeOutOfARange) {
  CameraRoom room;
  room.add_mode(0, V4L2_PIX_FMT_H264, {640, 480}, {{1, 2, 3}}, {30});
  for (const auto& [width, height] : {std::pair{64, 48}, {312, 232}, {316, 236}})
    room.add_mode(0, V4L2_PIX_FMT_YUYV, {width, height}, {{1, 2, 3}}, {30});
  room.camera().size_step = 4;
  room.plug();
  CameraAddress address{0};
  EXPECT_EQ(camera_facts(address).chosen.value().size_px, Eigen::Vector2i(316, 236));
  address.wish.prefers_px = {312, 232};
  EXPECT_EQ(camera_facts(address).chosen.value().size_px, Eigen::Vector2i(312, 232));
}

}  // namespace
}  // namespace arthronaut::sources
