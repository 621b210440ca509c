#include "navigation/calibration/capture_guide.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planning/geometry/error.h"
#include "tests/navigation/calibration/board_scene.h"

namespace arthronaut::calibration {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

GrayPicture drawn(double tilt_deg, double lens_angle_deg) {
  return draw_board(true_scope(), {board_pose(20, tilt_deg, 40, 20), lens_angle_deg}, 2, 1.5, 8);
}

// The way through: a picture, the lens turned too little, turned enough, until three pictures are enough.
TEST(CaptureGuide, LeadsThroughThreePictures) {
  CaptureGuide guide;
  const GrayPicture first = drawn(26, 0);
  EXPECT_THAT(guide.look(first.view()).rejections, IsEmpty());
  ASSERT_TRUE(guide.advice().quality.tilt_deg);
  EXPECT_NEAR(*guide.advice().quality.tilt_deg, 26, 3);
  guide.take();
  EXPECT_EQ(guide.advice().wanted, "Turn the lens");

  EXPECT_THAT(guide.look(drawn(26, 20).view()).rejections,
              Contains(HasSubstr("20 degrees from a picture taken")));
  for (const double lens_angle_deg : {60.0, 120.0}) {
    const GrayPicture picture = drawn(26, lens_angle_deg);
    guide.look(picture.view());
    // Looked at twice: it stands still.
    EXPECT_THAT(guide.look(picture.view()).rejections, IsEmpty()) << lens_angle_deg;
    EXPECT_FALSE(guide.advice().is_complete);
    guide.take();
  }
  EXPECT_TRUE(guide.advice().is_complete);
  CalibrationOptions options;
  options.square_mm = 2;
  EXPECT_THAT(calibrate(guide.taken(), options).reasons, IsEmpty());
  guide.drop_last();
  EXPECT_FALSE(guide.advice().is_complete);
}

// Each fault has its own reason: glare, motion, no board.
TEST(CaptureGuide, NamesWhatIsWrong) {
  CaptureGuide guide;
  GrayPicture glare = drawn(26, 0);
  for (int y = 0; y < glare.height; ++y)
    for (int x = 0; x < glare.width; ++x)
      if (std::hypot(x - 960, y - 500) < 220) glare.gray[static_cast<std::size_t>(y) * glare.width + x] = 255;
  EXPECT_THAT(guide.look(glare.view()).rejections, Contains(HasSubstr("glare")));

  guide.look(drawn(26, 0).view());
  EXPECT_THAT(guide.look(drawn(27, 0).view()).rejections, Contains(HasSubstr("it moves")));

  const std::vector<std::uint8_t> black(640 * 480, 3);
  EXPECT_THAT(guide.look({black.data(), 640, 480, 640}).rejections, Contains(HasSubstr("no checkerboard")));
  EXPECT_THROW(guide.take(), InvalidInput);
}

}  // namespace
}  // namespace arthronaut::calibration
