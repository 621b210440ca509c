#include "app/widgets/undistorted_texture.h"

#include <GL/glew.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/scene/offscreen_context.h"
#include "app/widgets/picture_placement.h"
#include "navigation/camera/medium.h"
#include "planning/geometry/error.h"
#include "tests/app/scope.h"

namespace arthronaut::widgets {
namespace {

constexpr int kSize_px = 600;

camera::CameraModel small_scope(double lens_angle_rad) {
  return camera::CameraModel(test::scope(0.5), lens_angle_rad, camera::kSalineIndex);
}

// Smooth stripes, a different period in each colour.
camera::FramePtr stripes() {
  auto frame = std::make_shared<camera::Frame>();
  frame->width = 960;
  frame->height = 540;
  frame->bgr.resize(static_cast<std::size_t>(3) * 960 * 540);
  for (int y = 0; y < 540; ++y)
    for (int x = 0; x < 960; ++x)
      for (int channel = 0; channel < 3; ++channel)
        frame->bgr[3 * static_cast<std::size_t>(y * 960 + x) + static_cast<std::size_t>(channel)] =
            static_cast<std::uint8_t>(128 + 100 * std::sin(0.05 * (x + channel * y)));
  return frame;
}

std::vector<std::uint8_t> read_texture(std::uint32_t texture) {
  std::vector<std::uint8_t> bgr(static_cast<std::size_t>(3) * kSize_px * kSize_px);
  glBindTexture(GL_TEXTURE_2D, texture);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTexImage(GL_TEXTURE_2D, 0, GL_BGR, GL_UNSIGNED_BYTE, bgr.data());
  return bgr;
}

class UndistortedTextureTest : public ::testing::Test {
 protected:
  void SetUp() override {
    try {
      context_.emplace();
    } catch (const DeviceError& error) {
      GTEST_SKIP() << error.what();
    }
    glewExperimental = GL_TRUE;
    glewInit();  // reports the missing display and loads every entry point all the same
  }
  std::optional<scene::OffscreenContext> context_;
};

// The shader and the CPU show the same picture, also after the lens was turned without a new table.
TEST_F(UndistortedTextureTest, ShaderAndProcessorAgree) {
  VideoTexture video;
  UndistortedTexture on_gpu, on_cpu(false);
  const camera::FramePtr frames[] = {stripes(), stripes()};
  const camera::UndistortedView* view = nullptr;
  for (const int turn : {0, 1}) {
    const camera::CameraModel camera = small_scope(1.8 * turn);
    const camera::FramePtr& frame = frames[turn];
    video.upload(frame);
    on_gpu.draw(frame, video, camera, kSize_px);
    on_cpu.draw(frame, video, camera, kSize_px);
    ASSERT_TRUE(on_gpu.is_on_gpu());
    ASSERT_FALSE(on_cpu.is_on_gpu());
    EXPECT_TRUE(turn == 0 || &on_gpu.view() == view) << "turning the lens made a new table";
    view = &on_gpu.view();
    const auto a = read_texture(on_gpu.texture()), b = read_texture(on_cpu.texture());
    long lit = 0, different = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      lit += a[i] > 0 ? 1 : 0;
      // Both weigh four pixels, the CPU in steps of 1/32 px: 5 levels/px are 0.2 levels of rounding, and one
      // of each's own. The rim itself may fall either way.
      different += std::abs(int{a[i]} - int{b[i]}) > 2 ? 1 : 0;
    }
    EXPECT_GT(lit, 3L * kSize_px * kSize_px / 2);
    EXPECT_LT(different, 3L * 12 * kSize_px / 10) << "more than a few pixels of the rim differ";
  }
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

// Of a picture of which only the round view was uploaded the same is made.
TEST_F(UndistortedTextureTest, TheRoundViewAloneIsEnough) {
  const camera::FramePtr frame = stripes();
  const camera::CameraModel camera = small_scope(0.4);
  const camera::Boundary& view = camera.boundary();
  VideoTexture whole, part;
  EXPECT_EQ(whole.upload(frame), static_cast<std::size_t>(3) * 960 * 540);
  const Rect wanted = shown_part(view, frame->width, frame->height);
  EXPECT_LT(part.upload(frame, wanted), static_cast<std::size_t>(3) * 960 * 540 * 2 / 3);
  EXPECT_EQ(part.upload(frame, wanted), 0U) << "it is there already";
  UndistortedTexture of_whole, of_part;
  of_whole.draw(frame, whole, camera, kSize_px);
  of_part.draw(frame, part, camera, kSize_px);
  const auto a = read_texture(of_whole.texture()), b = read_texture(of_part.texture());
  int worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(int{a[i]} - int{b[i]}));
  EXPECT_LE(worst, 1);
  // As it came: the same pixel stands at the same place of the picture.
  const ImVec2 first = part.place_of(wanted.min()), last = part.place_of(wanted.max());
  const Rect held = part.held();
  EXPECT_NEAR(held.x + first.x * held.width, wanted.x, 1e-3);
  EXPECT_NEAR(held.y + last.y * held.height, wanted.y + wanted.height, 1e-3);
}

// Drawing leaves what others had set up as it was.
TEST_F(UndistortedTextureTest, KeepsTheStateOfOthers) {
  VideoTexture video;
  UndistortedTexture texture;
  const camera::FramePtr frame = stripes();
  video.upload(frame);
  glEnable(GL_BLEND);
  glViewport(3, 4, 50, 60);
  glActiveTexture(GL_TEXTURE1);
  texture.draw(frame, video, small_scope(0), kSize_px);
  GLint viewport[4] = {}, unit = 0, program = -1;
  glGetIntegerv(GL_VIEWPORT, viewport);
  glGetIntegerv(GL_ACTIVE_TEXTURE, &unit);
  glGetIntegerv(GL_CURRENT_PROGRAM, &program);
  EXPECT_EQ(viewport[2], 50);
  EXPECT_EQ(unit, GL_TEXTURE1);
  EXPECT_EQ(program, 0);
  EXPECT_EQ(glIsEnabled(GL_BLEND), GL_TRUE);
}

}  // namespace
}  // namespace arthronaut::widgets
