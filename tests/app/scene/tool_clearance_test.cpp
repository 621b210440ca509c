#include "app/scene/tool_clearance.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "tests/app/scope.h"

namespace arthronaut::scene {
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
          [&](const ClearDisc& disc) { return (*pixel - disc.center_px).norm() < disc.radius_px; }))
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
  for (const ClearDisc& disc : clear_discs_of(result, tools))
    EXPECT_GT((*pixel - disc.center_px).norm(), disc.radius_px);
}

// Wherever the guide stands, also with its shaft through the rim of the view and past it, where a lens'
// scale grows without bound: the clearing is never larger than the shaft is in the picture, and most of the
// picture stays free for the plan.
TEST(OverlayHazard30, ClearingIsBoundedAtTheRimOfTheView) {
  const tools::ToolSet tools = tools::standard_tools();
  const tools::ToolAxis axis = *tools.find_tool("femoral guide")->axis;
  pipeline::FrameResult result = frame_with_guide();
  const camera::Boundary view = result.camera.boundary();
  int discs_seen = 0;
  for (double lean = 0.35; lean < 1.5; lean += 0.05) {
    for (double turn = 0; turn < 6.28; turn += 0.4) {
      const Eigen::Vector3d aim(-std::sin(lean) * std::cos(turn), -std::sin(lean) * std::sin(turn),
                                std::cos(lean));
      const Eigen::Quaterniond rotation = Eigen::Quaterniond::FromTwoVectors(axis.direction, aim);
      result.markers[0].camera_from_marker = {rotation, Eigen::Vector3d(1, 0, 28) - rotation * axis.point_mm};
      const auto discs = clear_discs_of(result, tools);
      ASSERT_FALSE(discs.empty());
      long all = 0, cleared = 0;
      for (int y = 0; y < 1080; y += 12)
        for (int x = 0; x < 1920; x += 12) {
          const Eigen::Vector2d pixel(x, y);
          if (!result.camera.is_inside_view(pixel)) continue;
          ++all;
          cleared += std::any_of(discs.begin(), discs.end(), [&](const ClearDisc& disc) {
            return (pixel - disc.center_px).norm() < disc.radius_px;
          });
        }
      for (const ClearDisc& disc : discs) {
        ++discs_seen;
        // Small against the view, also over a shaft that is so near that it fills much of it.
        EXPECT_LT(disc.radius_px, 0.13 * view.radius_px) << lean << " " << turn;
        EXPECT_LT((disc.center_px - view.center_px).norm(), 1.06 * view.radius_px);
      }
      EXPECT_LT(static_cast<double>(cleared) / static_cast<double>(all), 0.5) << lean << " " << turn;
    }
  }
  EXPECT_GT(discs_seen, 5'000);
}

// A tool that is not tracked in this very frame clears nothing.
TEST(ToolClearance, NeedsTheToolOfThisFrame) {
  pipeline::FrameResult result = frame_with_guide();
  result.markers[0].state = markers::MarkerState::Glare;
  EXPECT_TRUE(clear_discs_of(result, tools::standard_tools()).empty());
}

}  // namespace
}  // namespace arthronaut::scene
