#include "app/scene/plan_overlay.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "tests/app/scope.h"
#include "tests/planning/geometry/shapes.h"

namespace arthronaut::scene {
namespace {

using Kind = OverlayLine::Kind;

// A block of bone, 40 x 40 x 30 mm, whose front face lies at z = 0.
geometry::TriangleMesh block() { return test::box({20, 20, 15}, {0, 0, 15}); }

camera::CameraModel turned_scope() { return camera::CameraModel(test::scope(), 0.3, 1.3345); }

struct Scene {
  std::shared_ptr<const geometry::Surface> surface = std::make_shared<geometry::Surface>(block());
  camera::CameraModel camera = turned_scope();
  geometry::RigidTransform camera_from_bone{
      Eigen::Quaterniond(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY())), {1, -2, 35}};
  tunnels::Tunnel plan;
  OverlayModel model;
  Scene() : plan(into_the_front()), model(surface, block(), plan, 25) {}
  static tunnels::Tunnel into_the_front() {
    tunnels::Tunnel tunnel;
    tunnel.entry_mm = {2, 3, 0};
    tunnel.direction = Eigen::Vector3d(0.1, 0, 1).normalized();
    tunnel.diameter_mm = 8;
    return tunnel;
  }
};

std::vector<Eigen::Vector2d> points_of(const PlanOverlay& overlay, Kind kind, bool hidden) {
  std::vector<Eigen::Vector2d> points;
  for (const OverlayLine& line : overlay)
    if (line.kind == kind && line.is_hidden == hidden)
      points.insert(points.end(), line.points_px.begin(), line.points_px.end());
  return points;
}

// The mouth of the tunnel is where the camera model puts the drill's cylinder on the face: exact under
// distortion.
TEST(PlanOverlay, EntryRingLiesWhereTheCameraModelSaysItDoes) {
  const Scene scene;
  const PlanOverlay overlay = scene.model.project(scene.camera, scene.camera_from_bone, {});
  const auto ring = points_of(overlay, Kind::EntryRing, false);
  ASSERT_GT(ring.size(), 40U);
  for (const Eigen::Vector2d& pixel : ring) {
    // Back through the camera onto the face z = 0: the distance from the axis must be the radius.
    const auto ray = scene.camera.ray(pixel);
    ASSERT_TRUE(ray);
    const geometry::RigidTransform bone_from_camera = scene.camera_from_bone.inverse();
    const Eigen::Vector3d eye = bone_from_camera.translation_mm, along = bone_from_camera.rotate(*ray);
    const Eigen::Vector3d on_face = eye - eye.z() / along.z() * along;
    const double from_axis = (on_face - scene.plan.entry_mm).cross(scene.plan.direction).norm();
    EXPECT_NEAR(from_axis, 4.0, 0.25);  // the ring is lifted off the face by 0.15 mm
  }
}

// The outline of the tunnel is where rays of the eye just touch the drill's cylinder, and the wall that is
// shaded lies between: no ray of either passes farther from the axis than the radius.
TEST(PlanOverlay, TheTunnelReadsAsABody) {
  const Scene scene;
  const PlanOverlay overlay = scene.model.project(scene.camera, scene.camera_from_bone, {});
  const geometry::RigidTransform bone_from_camera = scene.camera_from_bone.inverse();
  const auto ray_to_axis_mm = [&](const Eigen::Vector2d& pixel) {
    const Eigen::Vector3d along = bone_from_camera.rotate(*scene.camera.ray(pixel));
    const Eigen::Vector3d normal = along.cross(scene.plan.direction).normalized();
    return std::abs((bone_from_camera.translation_mm - scene.plan.entry_mm).dot(normal));
  };
  // The ring that walls begin at is of 64 points: between two of them they are nearer to the axis by 0.005
  // mm.
  constexpr double kChord_mm = 0.02;
  int edges = 0, faces = 0;
  for (const OverlayLine& line : overlay) {
    if (line.kind == Kind::TunnelFace) {
      ++faces;
      EXPECT_EQ(line.points_px.size(), 4U);
      EXPECT_GE(line.shade, 0);
      EXPECT_LE(line.shade, 1);
      for (const Eigen::Vector2d& pixel : line.points_px) EXPECT_LE(ray_to_axis_mm(pixel), 4 + kChord_mm);
    }
    if (line.kind != Kind::TunnelWall) continue;
    const bool touches = std::all_of(
        line.points_px.begin(), line.points_px.end(),
        [&](const Eigen::Vector2d& pixel) { return std::abs(ray_to_axis_mm(pixel) - 4) < kChord_mm; });
    edges += touches && line.points_px.size() > 20 ? 1 : 0;
  }
  EXPECT_EQ(edges, 2);
  EXPECT_GT(faces, 40);
}

// No piece of the wall is drawn where a tool lies.
TEST(PlanOverlay, TheShadedWallKeepsOffTools) {
  const Scene scene;
  const auto middle =
      scene.camera.project(scene.camera_from_bone * (scene.plan.entry_mm + 5 * scene.plan.direction));
  ASSERT_TRUE(middle);
  const std::vector<ClearDisc> clear{{*middle, 60}};
  for (const OverlayLine& line : scene.model.project(scene.camera, scene.camera_from_bone, clear))
    for (const Eigen::Vector2d& pixel : line.points_px)
      EXPECT_GE((pixel - *middle).norm(), line.kind == Kind::TunnelFace ? 60 : 0);
}

// What is inside the bone is marked as hidden, what is in front of it is not.
TEST(PlanOverlay, TunnelInsideTheBoneIsHidden) {
  const Scene scene;
  const PlanOverlay overlay = scene.model.project(scene.camera, scene.camera_from_bone, {});
  EXPECT_FALSE(points_of(overlay, Kind::TunnelAxis, false).empty());
  EXPECT_GT(points_of(overlay, Kind::TunnelAxis, true).size(), 15U);
  const auto in_front =
      scene.camera.project(scene.camera_from_bone * (scene.plan.entry_mm - 5 * scene.plan.direction));
  ASSERT_TRUE(in_front);
  const auto seen = points_of(overlay, Kind::TunnelAxis, false);
  EXPECT_TRUE(std::any_of(seen.begin(), seen.end(),
                          [&](const Eigen::Vector2d& p) { return (p - *in_front).norm() < 1e-6; }));
}

// Nothing is drawn over the tip of a tool, and nothing outside the round view.
TEST(PlanOverlay, KeepsOffTheToolTipAndInsideTheView) {
  const Scene scene;
  const auto entry = scene.camera.project(scene.camera_from_bone * scene.plan.entry_mm);
  ASSERT_TRUE(entry);
  const ClearDisc disc{*entry, 60};
  const PlanOverlay overlay = scene.model.project(scene.camera, scene.camera_from_bone, std::span(&disc, 1));
  ASSERT_FALSE(overlay.empty());
  for (const OverlayLine& line : overlay)
    for (const Eigen::Vector2d& pixel : line.points_px) {
      EXPECT_GE((pixel - disc.center_px).norm(), 60);
      EXPECT_TRUE(scene.camera.is_inside_view(pixel));
    }
}

// A line whose points lie on either side of a tool's shaft does not cross it.
TEST(PlanOverlay, NoLineCrossesAShaftBetweenItsPoints) {
  const camera::CameraModel camera = turned_scope();
  const std::vector<Eigen::Vector3d> points{{-3, 0, 30}, {-1.5, 0, 30}, {0, 0, 30}, {1.5, 0, 30}, {3, 0, 30}};
  // Between the third and the fourth point, on neither.
  const Eigen::Vector2d between = *camera.project({0.75, 0, 30});
  const ClearDisc shaft{between, 8};
  PlanOverlay overlay;
  add_curves(overlay, camera, points, 5, std::span(&shaft, 1));
  ASSERT_EQ(overlay.size(), 2U);
  EXPECT_EQ(overlay[0].points_px.size(), 3U);
  EXPECT_EQ(overlay[1].points_px.size(), 2U);
}

// A curve breaks where the tip hopped.
TEST(PlanOverlay, CurvesBreakAtHops) {
  const camera::CameraModel camera = turned_scope();
  const std::vector<Eigen::Vector3d> points{{0, 0, 30}, {1, 0, 30}, {2, 0, 30}, {8, 0, 30}, {9, 0, 30}};
  PlanOverlay overlay;
  add_curves(overlay, camera, points, 1.5, {});
  ASSERT_EQ(overlay.size(), 2U);
  EXPECT_EQ(overlay[0].points_px.size(), 3U);
  EXPECT_EQ(overlay[1].points_px.size(), 2U);
}

}  // namespace
}  // namespace arthronaut::scene
