// A whole video of a simulated ruler, and what of it is written.
#include "navigation/pipeline/track_video.h"

#include <gtest/gtest.h>

#include <optional>

#include "navigation/camera/medium.h"
#include "navigation/simulator/simulated_ruler.h"

namespace arthronaut::pipeline {
namespace {

constexpr int kPerSecond = 30, kDry = 45, kWet = 90;

// The ruler in air for a while, and then in saline: fluid that was turned on too late.
class TurnedOn : public sources::FrameSource {
 public:
  TurnedOn() : wet_(scene(camera::kSalineIndex, kWet)), dry_(scene(camera::kAirIndex, kDry)) {}
  [[nodiscard]] const sources::SourceInfo& info() const override { return wet_.info(); }
  [[nodiscard]] camera::FramePtr next() override {
    const std::int64_t index = next_++;
    const camera::FramePtr picture = index < kDry ? dry_.next() : wet_.next();
    if (picture == nullptr) return nullptr;
    const auto frame = std::make_shared<camera::Frame>(*picture);
    frame->index = index;
    frame->timestamp_ns = index * 1'000'000'000 / kPerSecond;
    return frame;
  }
  static simulator::RulerOptions scene(double index, int frame_count) {
    simulator::RulerOptions scene;
    scene.camera = simulator::standard_camera();
    scene.refractive_index = index;
    scene.frame_count = frame_count;
    scene.frames_per_second = kPerSecond;
    scene.rotation_deg = 20;
    return scene;
  }

 private:
  simulator::SimulatedRuler wet_, dry_;
  std::int64_t next_ = 0;
};

// What was measured in the wrong medium is not written because the video ends in the right one, and what was
// measured in the right one is; the reason says from when to when.
TEST(TrackVideo, Hazard27OnlyTheStretchInTheWrongMediumIsDropped) {
  ViewTrackerOptions options;
  options.calibration = simulator::standard_camera();
  options.refractive_index = camera::kSalineIndex;
  tools::ToolSet tools;
  tools.world_markers = {{bones::BoneKind::Femur, 5, 2.89}};
  tools::Tool end;
  end.name = "ruler end";
  end.marker_id = 6;
  end.size_mm = 2.89;
  tools.tools = {end};
  TurnedOn source;
  const TrackedVideo video = track_video(source, options, tools);
  ASSERT_EQ(video.statistics.frame_count, kWet + kDry);
  ASSERT_EQ(video.reasons.size(), 1U);
  EXPECT_NE(video.reasons.front().find("the markers look as in air, not as in saline"), std::string::npos)
      << video.reasons.front();
  EXPECT_EQ(video.reasons.front().find("from "), 0U) << video.reasons.front();
  ASSERT_FALSE(video.rows.empty());
  EXPECT_GT(video.rows.size(), 20U);
  for (const strokes::PoseRow& row : video.rows) EXPECT_GE(row.frame, kDry);
}

// The camera of another scope: its mark is seen in every frame, and yet next to nothing stands. That is no
// reliable result of a lens whose angle is not known.
TEST(TrackVideo, TellsThatTheViewIsNotThisCameras) {
  simulator::RulerOptions scene;
  scene.camera = simulator::standard_camera();
  scene.refractive_index = camera::kSalineIndex;
  scene.frame_count = 8;
  scene.frames_per_second = 30;
  simulator::SimulatedRuler source(scene);
  ViewTrackerOptions options;
  options.calibration = simulator::standard_camera();
  options.calibration.boundary.radius_px *= 1.04;
  options.refractive_index = camera::kSalineIndex;
  tools::ToolSet tools;
  tools.world_markers = {{bones::BoneKind::Femur, 5, 2.89}};
  const TrackedVideo video = track_video(source, options, tools);
  EXPECT_EQ(video.statistics.frames_with_mark, 8);
  ASSERT_EQ(video.reasons.size(), 1U);
  EXPECT_NE(video.reasons.front().find("not of this camera"), std::string::npos) << video.reasons.front();
  EXPECT_NE(video.reasons.front().find("smaller than calibrated"), std::string::npos)
      << video.reasons.front();
}

}  // namespace
}  // namespace arthronaut::pipeline
