#include "app/scene/scene_camera.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace arthronaut::scene {
namespace {

const geometry::Bounds kKnee{{-40, -30, -60}, {40, 30, 60}};
const Eigen::Vector2d kSize(800, 600);
constexpr double kExact_px = 1e-6;  // closed forms: rounding alone

// Seen from the front, the patient's left (+x in LPS) is on the right of the picture and the head is up.
TEST(SceneCamera, AnteriorViewShowsThePatientFaceToFace) {
  const SceneCamera camera = look_from(ViewDirection::Anterior, bones::Side::Right, kKnee, 4.0 / 3);
  const auto middle = project(camera, {0, 0, 0}, kSize);
  const auto left_of_patient = project(camera, {30, 0, 0}, kSize);
  const auto head = project(camera, {0, 0, 30}, kSize);
  ASSERT_TRUE(middle && left_of_patient && head);
  EXPECT_NEAR((*middle - 0.5 * kSize).norm(), 0, kExact_px);
  EXPECT_GT(left_of_patient->x(), middle->x() + 50);
  EXPECT_LT(head->y(), middle->y() - 50);
}

// The lateral side is -x on a right knee and +x on a left one: what is nearer the eye looks larger.
TEST(SceneCamera, LateralViewFollowsTheSide) {
  for (const auto side : {bones::Side::Right, bones::Side::Left}) {
    const double lateral_x = side == bones::Side::Right ? -1 : 1;
    const SceneCamera camera = look_from(ViewDirection::Lateral, side, kKnee, 4.0 / 3);
    EXPECT_GT(camera.position_mm.x() * lateral_x, 100);
  }
}

// Every named view holds the whole bone.
TEST(SceneCamera, NamedViewsHoldAllCorners) {
  for (const ViewDirection view :
       {ViewDirection::Anterior, ViewDirection::Posterior, ViewDirection::Medial, ViewDirection::Lateral,
        ViewDirection::Distal, ViewDirection::Notch, ViewDirection::Plateau}) {
    const SceneCamera camera = look_from(view, bones::Side::Left, kKnee, 4.0 / 3);
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d point((corner & 1) != 0 ? 40 : -40, (corner & 2) != 0 ? 30 : -30,
                                  (corner & 4) != 0 ? 60 : -60);
      const auto pixel = project(camera, point, kSize);
      ASSERT_TRUE(pixel);
      EXPECT_TRUE(pixel->x() >= 0 && pixel->y() >= 0 && pixel->x() <= 800 && pixel->y() <= 600)
          << to_text(view);
    }
  }
}

// A ray through a point's pixel meets the point.
TEST(SceneCamera, RayAndProjectionAreInverse) {
  const SceneCamera camera =
      orbited(look_from(ViewDirection::Notch, bones::Side::Right, kKnee, 1.5), {123, -77}, 600);
  const Eigen::Vector3d point(12, -7, 31);
  const auto pixel = project(camera, point, kSize);
  ASSERT_TRUE(pixel);
  const SceneRay ray = ray_through(camera, *pixel, kSize);
  EXPECT_NEAR((point - ray.origin_mm).cross(ray.direction).norm(), 0, 1e-9);
}

// Turning keeps the distance, a drag to the right turns the object to the right, zooming in comes nearer.
TEST(SceneCamera, MovesAsAHandExpects) {
  const SceneCamera camera = look_from(ViewDirection::Anterior, bones::Side::Right, kKnee, 4.0 / 3);
  const SceneCamera turned = orbited(camera, {100, 0}, 600);
  EXPECT_NEAR((turned.position_mm - turned.focus_mm).norm(), (camera.position_mm - camera.focus_mm).norm(),
              1e-9);
  const auto front_before = project(camera, {0, -30, 0}, kSize),
             front_after = project(turned, {0, -30, 0}, kSize);
  ASSERT_TRUE(front_before && front_after);
  EXPECT_GT(front_after->x(), front_before->x());
  const SceneCamera moved = panned(camera, {50, 20}, 600);
  const auto dragged = project(moved, camera.focus_mm, kSize);
  ASSERT_TRUE(dragged);
  EXPECT_NEAR((*dragged - 0.5 * kSize - Eigen::Vector2d(50, 20)).norm(), 0, 1e-6);
  const SceneCamera nearer = zoomed(camera, 3);
  EXPECT_LT((nearer.position_mm - nearer.focus_mm).norm(), (camera.position_mm - camera.focus_mm).norm());
}

// What is behind the eye has no pixel.
TEST(SceneCamera, NothingBehindTheEye) {
  const SceneCamera camera = look_from(ViewDirection::Anterior, bones::Side::Right, kKnee, 1);
  EXPECT_FALSE(project(camera, camera.position_mm + Eigen::Vector3d(0, -10, 0), kSize));
}

}  // namespace
}  // namespace arthronaut::scene
