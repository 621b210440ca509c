#include "navigation/contour/visible_bone.h"

#include <gtest/gtest.h>

#include "planning/geometry/error.h"
#include "tests/navigation/contour/rendered_bone.h"

namespace arthronaut::contour {
namespace {

void see(VisibleBone& bone, const geometry::RigidTransform& camera_from_bone,
         const camera::CameraModel& camera) {
  int calls = 1;
  while (!bone.advance(camera_from_bone, camera)) ++calls;
  EXPECT_EQ(calls, bone.calls_per_round());
}

// The outline of a ball is the circle in which the lines of sight touch it: r^2 / d before its middle, of
// radius r sqrt(1 - r^2 / d^2), the normals radial.
TEST(VisibleBone, FindsTheCircleInWhichABallIsTouched) {
  const camera::CameraModel camera(small_camera(), 0, 1.3345);
  const geometry::RigidTransform view = before_the_lens();
  VisibleBone bone(ball_mesh(0));
  see(bone, view, camera);
  ASSERT_GT(bone.outline().size(), 60U);
  const Eigen::Vector3d eye = view.inverse().translation_mm;
  const double distance_mm = eye.norm();
  for (const ContourPoint& point : bone.outline()) {
    // A chord of 0.7 mm lies 0.005 mm inside the ball.
    EXPECT_NEAR(point.in_bone_mm.dot(eye) / distance_mm, kBall_mm * kBall_mm / distance_mm, 0.1);
    EXPECT_NEAR(point.in_bone_mm.norm(), kBall_mm, 0.02);
    EXPECT_LT(geometry::angle_between_rad(point.normal_in_bone, point.in_bone_mm), 0.01);
  }
}

// What stands before the ball hides what is behind: no outline and no place is seen there.
TEST(VisibleBone, LeavesOutWhatIsHidden) {
  const camera::CameraModel camera(small_camera(), 0, 1.3345);
  const geometry::RigidTransform view = before_the_lens();
  geometry::TriangleMesh mesh = ball_mesh(0);
  VisibleBone alone(mesh);
  see(alone, view, camera);
  // A second, smaller ball on the way to the first.
  const auto first = static_cast<std::int32_t>(mesh.vertices_mm.size());
  const geometry::TriangleMesh ball = ball_mesh(0);
  const Eigen::Vector3d eye = view.inverse().translation_mm;
  for (const Eigen::Vector3d& vertex : ball.vertices_mm)
    mesh.vertices_mm.push_back(0.25 * vertex + 0.62 * eye);
  for (const auto& [a, b, c] : ball.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
  VisibleBone both(mesh);
  see(both, view, camera);
  const auto is_hidden = [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3d ray = (point - eye).normalized(), to_middle = 0.62 * eye - eye;
    return point.norm() < kBall_mm + 0.1 &&
           (to_middle - ray * ray.dot(to_middle)).norm() < 0.25 * kBall_mm - 0.5;
  };
  for (const std::int32_t index : both.places_seen())
    EXPECT_FALSE(is_hidden(both.places()[static_cast<std::size_t>(index)].in_bone_mm));
  // The small one's outline, with the ball clearly further off behind it, and what is left of the ball's own.
  const auto on_small =
      std::count_if(both.outline().begin(), both.outline().end(),
                    [](const ContourPoint& point) { return point.in_bone_mm.norm() > kBall_mm + 0.1; });
  EXPECT_GT(on_small, 10);
  EXPECT_FALSE(alone.places_seen().empty());
}

TEST(VisibleBone, SeesNothingOfABoneBehindTheLens) {
  const camera::CameraModel camera(small_camera(), 0, 1.3345);
  VisibleBone bone(ball_mesh());
  see(bone, {Eigen::Quaterniond::Identity(), {0, 0, -30}}, camera);
  EXPECT_TRUE(bone.outline().empty());
  EXPECT_TRUE(bone.places_seen().empty());
}

TEST(VisibleBone, RefusesAnEmptyMesh) { EXPECT_THROW(VisibleBone(geometry::TriangleMesh()), InvalidInput); }

}  // namespace
}  // namespace arthronaut::contour
