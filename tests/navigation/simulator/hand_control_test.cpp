#include "navigation/simulator/hand_control.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "navigation/simulator/holding.h"
#include "planning/geometry/error.h"

namespace arthronaut::simulator {
namespace {

using Eigen::Vector3d;

constexpr double kFrame_s = 1.0 / 30;

// A box of 20 mm with its upper face at z = 0, seen from above.
geometry::TriangleMesh box() {
  geometry::TriangleMesh mesh;
  for (const double z : {-20.0, 0.0})
    for (const double y : {-10.0, 10.0})
      for (const double x : {-10.0, 10.0}) mesh.vertices_mm.emplace_back(x, y, z);
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

class HandControlTest : public ::testing::Test {
 protected:
  // Looks straight down from 30 mm; the picture's right is +x.
  static HandStart start_above() {
    HandStart start;
    start.bone_from_camera_probe = bone_from_camera({0, 0, 30}, {0, 0, -1}, {0, 1, 0});
    start.bone_from_camera_guide = bone_from_camera({5, 0, 30}, {0, 0, -1}, {0, 1, 0});
    start.probe_tip_mm = {0, 0, 5};
    start.probe_handle = Vector3d(0.5, 0, 1).normalized();
    start.guide_point_mm = {0, 0, 3};
    start.guide_direction = {0, 0, -1};
    return start;
  }
  static HandInput pushed(const Vector3d& move, Held held = Held::Probe) {
    HandInput input;
    input.held = held;
    input.move = move;
    return input;
  }
  static void push(HandControl& hand, const HandInput& input, double seconds) {
    for (double t = 0; t < seconds; t += kFrame_s) (void)hand.step(input, kFrame_s);
  }
  geometry::Surface bone_{box()};
};

// A full push comes to the greatest speed and never beyond it, whatever is asked for.
TEST_F(HandControlTest, SpeedIsLimited) {
  HandControl hand(start_above(), bone_);
  const double most_mm = hand.limits().tool_mm_s * kFrame_s;
  Vector3d before = hand.state().probe_tip_mm;
  double last_mm = 0;
  for (int i = 0; i < 30; ++i) {
    const Vector3d now = hand.step(pushed({-40, 30, 0}), kFrame_s).probe_tip_mm;
    last_mm = (now - before).norm();
    EXPECT_LE(last_mm, most_mm * (1 + 1e-9));
    before = now;
  }
  EXPECT_NEAR(last_mm, most_mm, 0.01 * most_mm);  // a second is eight time constants
}

// Right and down are the picture's, whatever the scope looks at.
TEST_F(HandControlTest, MovesAsThePictureShows) {
  for (const Vector3d& eye : {Vector3d(0, 0, 30), Vector3d(25, 0, 25), Vector3d(-10, 20, 30)}) {
    HandStart start = start_above();
    start.bone_from_camera_probe = bone_from_camera(eye, -eye, {0, 1, 0.1});
    HandControl hand(start, bone_);
    const Vector3d from = hand.state().probe_tip_mm;
    push(hand, pushed({1, 0, 0}), 0.2);
    const Vector3d in_picture =
        start.bone_from_camera_probe.inverse().rotate(hand.state().probe_tip_mm - from);
    EXPECT_GT(in_picture.x(), 1);
    EXPECT_NEAR(in_picture.y(), 0, 1e-9);
    EXPECT_NEAR(in_picture.z(), 0, 1e-9);
  }
}

// The tip stops at the bone and slides along it; it never goes in, however long and fast it is pushed.
TEST_F(HandControlTest, TipNeverGoesThroughBone) {
  HandControl hand(start_above(), bone_);
  for (int i = 0; i < 40; ++i) {
    const HandState& now = hand.step(pushed({0.3, 0, 1}), kFrame_s);
    EXPECT_GE(bone_.signed_distance_mm(now.probe_tip_mm), -1e-6);
  }
  EXPECT_TRUE(hand.state().touches_bone);
  EXPECT_NEAR(hand.state().probe_tip_mm.z(), 0, 1e-6);
  EXPECT_GT(hand.state().probe_tip_mm.x(), 5);  // it slid
  push(hand, pushed({0, 0, -1}), 0.5);
  EXPECT_FALSE(hand.state().touches_bone);
}

// A tilt turns the handle about the tip, which stays where it is: what a pivot needs.
TEST_F(HandControlTest, TiltLeavesTheTip) {
  HandControl hand(start_above(), bone_);
  const Vector3d tip = hand.state().probe_tip_mm, handle = hand.state().probe_handle;
  HandInput input;
  input.tilt = {1, 0, 0};
  push(hand, input, 0.5);
  EXPECT_EQ(hand.state().probe_tip_mm, tip);
  EXPECT_GT(hand.state().probe_handle.x(), handle.x() + 0.1);  // right in the picture
  EXPECT_NEAR(hand.state().probe_handle.norm(), 1, 1e-12);
}

// The drill bites only where the guide stands on bone; the guide stands still from then on.
TEST_F(HandControlTest, DrillNeedsBoneAndHoldsTheGuide) {
  HandControl hand(start_above(), bone_);
  HandInput drilling = pushed(Vector3d::Zero(), Held::Guide);
  drilling.drill = 1;
  push(hand, drilling, 0.5);
  EXPECT_EQ(hand.state().drilled_depth_mm, 0);  // 3 mm off the bone
  push(hand, pushed({0, 0, 1}, Held::Guide), 1);
  ASSERT_TRUE(hand.state().touches_bone);
  const Vector3d point = hand.state().guide_point_mm, direction = hand.state().guide_direction;
  drilling.move = {1, 0, 0};
  drilling.tilt = {1, 1, 0};
  push(hand, drilling, 1);
  EXPECT_NEAR(hand.state().drilled_depth_mm, hand.limits().drill_mm_s,
              hand.limits().drill_mm_s * kFrame_s * 1.5);
  EXPECT_LT((hand.state().guide_point_mm - point).norm(), 0.7);  // what it still slid as it bit
  EXPECT_LT(geometry::angle_between_rad(hand.state().guide_direction, direction), 0.1);
  const Vector3d fixed = hand.state().guide_point_mm;
  push(hand, drilling, 1);
  EXPECT_EQ(hand.state().guide_point_mm, fixed);
}

// The scope comes no nearer to the bone than it may, and the lens turns at its own speed.
TEST_F(HandControlTest, ScopeStaysClear) {
  HandControl hand(start_above(), bone_);
  HandInput input = pushed({0, 0, 1});
  input.moves_scope = true;
  input.turn_lens = 1;
  const Vector3d tip = hand.state().probe_tip_mm;
  push(hand, input, 6);
  EXPECT_GE(bone_.signed_distance_mm(hand.state().bone_from_camera.translation_mm),
            hand.limits().scope_clear_mm - 1e-9);
  EXPECT_LT(hand.state().bone_from_camera.translation_mm.z(), 8);  // it did come near
  EXPECT_EQ(hand.state().probe_tip_mm, tip);                       // the other hand stays
  EXPECT_GT(std::fmod(hand.state().mark_angle_deg + 360, 360.0), 1);
}

// Another tool in the hand brings the scope to the view that was found for it, without a jump.
TEST_F(HandControlTest, ScopeFollowsTheTool) {
  HandControl hand(start_above(), bone_);
  const Vector3d wanted = start_above().bone_from_camera_guide.translation_mm;
  Vector3d before = hand.state().bone_from_camera.translation_mm;
  for (int i = 0; i < 60; ++i) {
    const Vector3d now =
        hand.step(pushed(Vector3d::Zero(), Held::Guide), kFrame_s).bone_from_camera.translation_mm;
    EXPECT_LT((now - before).norm(), 0.5);
    before = now;
  }
  EXPECT_LT((before - wanted).norm(), 1e-9);
}

// What is no number pushes nothing, a gap in time moves nothing further than a tenth of a second, and the
// same pushes give the same poses.
TEST_F(HandControlTest, BadInputDoesNothing) {
  HandControl hand(start_above(), bone_), again(start_above(), bone_);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  HandInput bad = pushed({nan, nan, nan});
  bad.tilt = {nan, nan, nan};
  bad.drill = bad.turn_lens = nan;
  push(hand, bad, 0.5);
  EXPECT_EQ(hand.state().probe_tip_mm, start_above().probe_tip_mm);
  (void)hand.step(pushed({1, 0, 0}), nan);
  (void)hand.step(pushed({1, 0, 0}), -3);
  EXPECT_EQ(hand.state().probe_tip_mm, start_above().probe_tip_mm);
  (void)again.step(pushed({1, 0, 0}), 3600);
  EXPECT_LE((again.state().probe_tip_mm - start_above().probe_tip_mm).norm(),
            again.limits().tool_mm_s * again.limits().longest_step_s);
  HandLimits none;
  none.tool_mm_s = 0;
  EXPECT_THROW(HandControl(start_above(), bone_, none), InvalidInput);
}

}  // namespace
}  // namespace arthronaut::simulator
