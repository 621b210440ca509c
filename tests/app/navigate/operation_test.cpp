#include "app/navigate/operation.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "app/navigate/navigate_display.h"
#include "app/navigate/operation_job.h"
#include "navigation/simulator/simulated_operation.h"
#include "tests/planning/geometry/shapes.h"

namespace arthronaut::navigate {
namespace {

// A block of bone; what matters here are the pictures.
geometry::TriangleMesh block() { return test::box({20, 20, 15}, {0, 0, -15}); }

// The same grey picture again and again, 60 times a second.
class FrozenSource : public sources::FrameSource {
 public:
  FrozenSource(int width, int height) {
    info_.name = "frozen";
    info_.image_size_px = {width, height};
    frame_.width = width;
    frame_.height = height;
    frame_.bgr.assign(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 60);
  }
  const sources::SourceInfo& info() const override { return info_; }
  camera::FramePtr next() override {
    frame_.index = count_;
    frame_.timestamp_ns = count_++ * 1'000'000'000 / 60;
    return std::make_shared<const camera::Frame>(frame_);
  }

 private:
  sources::SourceInfo info_;
  camera::Frame frame_;
  std::int64_t count_ = 0;
};

OperationSetup setup_with(int width, int height) {
  OperationSetup setup;
  setup.pipeline.calibration = simulator::standard_camera();
  setup.pipeline.tools = tools::standard_tools();
  setup.surface = std::make_shared<geometry::Surface>(block());
  setup.drawn_bone = std::make_shared<geometry::TriangleMesh>(block());
  static std::promise<SurfaceIndexPtr> never_ready;
  static const std::shared_future<SurfaceIndexPtr> bone = never_ready.get_future().share();
  setup.registration = std::make_shared<BoneRegistration>(bone, std::nullopt, setup.surface);
  setup.open_source = [=] { return std::make_unique<FrozenSource>(width, height); };
  return setup;
}

// The same picture again and again is told after 0.3 s of it, before anything else that may be missing.
TEST(OperationJob, AFrozenPictureIsToldInTime) {
  const OperationSetup setup = setup_with(1920, 1080);
  OperationJob job(setup);
  OperationStatus status;
  status.phase = OperationStatus::Phase::Running;
  for (int frame = 0; frame <= 20; ++frame) {
    status.live = job.step();
    const auto display = display_of(&status, &setup.pipeline, 0);
    EXPECT_EQ(display.headline == "Picture frozen", frame >= 18) << "frame " << frame;
    EXPECT_FALSE(display.overlay_is_valid);
  }
}

// A picture of another size than the camera's ends the source; the screen says both sizes.
TEST(Operation, AnotherPictureSizeIsTold) {
  const OperationSetup setup = setup_with(640, 480);
  Operation operation(setup, [] {});
  OperationStatus status;
  for (int i = 0; i < 1000 && status.phase != OperationStatus::Phase::Failed; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    status = operation.status();
  }
  const auto display = display_of(&status, &setup.pipeline, 0);
  EXPECT_EQ(display.headline, "Source failed");
  EXPECT_NE(display.detail.find("640 x 480"), std::string::npos) << display.detail;
  EXPECT_NE(display.detail.find("1920 x 1080"), std::string::npos) << display.detail;
}

// A touch asked for while the tip is not known is refused with the reason, and the probe stops drawing.
TEST(Operation, ATouchNeedsTheTip) {
  Operation operation(setup_with(1920, 1080), [] {});
  operation.take_touch(false);
  OperationStatus status;
  for (int i = 0; i < 1000 && status.touch_notice.empty(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    status = operation.status();
  }
  EXPECT_NE(status.touch_notice.find("not known"), std::string::npos) << status.touch_notice;
  EXPECT_FALSE(status.digitises);
}

}  // namespace
}  // namespace arthronaut::navigate
