#include "app/navigate/tool_clearance.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "tests/app/scope.h"

namespace arthronaut::navigate {
namespace {

// The femoral guide before the camera, its shaft across the picture.
pipeline::FrameResult frame_with_guide() {
  pipeline::FrameResult result;
  result.camera = camera::CameraModel(test::scope(), 0, 1.3345);
  result.intrinsics_are_known = true;
  result.markers.resize(1);
  result.markers[0].id = 3;
  result.markers[0].state = markers::MarkerState::Tracked;
  // The marker faces the camera: its z towards the lens, its y up in the picture.
  result.markers[0].camera_from_marker = {
      Eigen::Quaterniond(Eigen::AngleAxisd(3.14159265, Eigen::Vector3d::UnitX())), {2, -14, 28}};
  return result;
}

// A point on the shaft's surface, anywhere along the axis from the tip to beyond the marker, lies in a disc.
TEST(ToolClearance, CoversTheShaftFromTheTipToTheHandle) {
  const pipeline::FrameResult result = frame_with_guide();
  const tools::ToolSet tools = tools::standard_tools();
  const tools::ToolAxis axis = *tools.find_tool("femoral guide")->axis;
  const auto discs = clear_discs_of(result, tools);
  ASSERT_FALSE(discs.empty());
  constexpr double kSleeveRadius_mm = 2.2;
  int seen = 0;
  for (double along = 0; along < 60; along += 0.5) {
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector3d on_sleeve =
          axis.point_mm - along * axis.direction + side * kSleeveRadius_mm * Eigen::Vector3d::UnitX();
      const auto pixel = result.camera.project(result.markers[0].camera_from_marker * on_sleeve);
      if (!pixel || !result.camera.is_inside_view(*pixel)) continue;
      ++seen;
      EXPECT_TRUE(std::any_of(
          discs.begin(), discs.end(),
          [&](const scene::ClearDisc& disc) { return (*pixel - disc.center_px).norm() < disc.radius_px; }))
          << along << " mm from the tip";
    }
  }
  EXPECT_GT(seen, 40);
}

// Beside the shaft by its own thickness again lines are drawn: the clearing is not the whole picture.
TEST(ToolClearance, LeavesTheRestOfThePicture) {
  const pipeline::FrameResult result = frame_with_guide();
  const tools::ToolSet tools = tools::standard_tools();
  const tools::ToolAxis axis = *tools.find_tool("femoral guide")->axis;
  const Eigen::Vector3d beside = axis.point_mm - 25 * axis.direction + 6 * Eigen::Vector3d::UnitX();
  const auto pixel = result.camera.project(result.markers[0].camera_from_marker * beside);
  ASSERT_TRUE(pixel);
  for (const scene::ClearDisc& disc : clear_discs_of(result, tools))
    EXPECT_GT((*pixel - disc.center_px).norm(), disc.radius_px);
}

// A tool that is not tracked in this very frame clears nothing.
TEST(ToolClearance, NeedsTheToolOfThisFrame) {
  pipeline::FrameResult result = frame_with_guide();
  result.markers[0].state = markers::MarkerState::Glare;
  EXPECT_TRUE(clear_discs_of(result, tools::standard_tools()).empty());
}

}  // namespace
}  // namespace arthronaut::navigate
