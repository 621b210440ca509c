#include "navigation/guidance/guidance.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace arthronaut::guidance {

namespace {

using geometry::RigidTransform;
using geometry::TrackedPose;

// A plan, a registration, a camera anyhow, and a guide whose axis is known in the bone.
struct Scene {
  Scene() {
    plan.entry_mm = {-75, 10, 5};
    plan.direction = Eigen::Vector3d(-0.8, 0.0, 0.6);
    registration.has_pose = registration.reliable = true;
    registration.reasons.clear();
    registration.marker_from_bone.rotation = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized());
    registration.marker_from_bone.translation_mm = {5, -8, 60};
    world.target_from_source.rotation = Eigen::AngleAxisd(2.0, Eigen::Vector3d(0, 1, 1).normalized());
    world.target_from_source.translation_mm = {1, 2, 25};
    world.is_valid = guide.is_valid = true;
    world.timestamp_ns = guide.timestamp_ns = 1'000'000'000;
    axis.point_mm = {0, -40, -6};
    axis.direction = -Eigen::Vector3d::UnitY();
    hold_guide(plan.entry_mm, plan.direction);
  }

  // Holds the guide so that its point and axis lie so in the bone.
  void hold_guide(const Eigen::Vector3d& point_mm, const Eigen::Vector3d& direction) {
    RigidTransform bone_from_guide;
    bone_from_guide.rotation = Eigen::Quaterniond::FromTwoVectors(axis.direction, direction);
    bone_from_guide.translation_mm = point_mm - bone_from_guide.rotate(axis.point_mm);
    guide.target_from_source = world.target_from_source * registration.marker_from_bone * bone_from_guide;
  }

  [[nodiscard]] GuidanceNumbers compute() const {
    GuidanceInput input;
    input.plan = &plan;
    input.planned_length_mm = 30;
    input.registration = &registration;
    input.camera_from_world_marker = world;
    input.camera_from_guide = guide;
    input.axis = &axis;
    input.lens_is_stale = lens_is_stale;
    input.now_ns = now_ns;
    return compute_guidance(input);
  }

  tunnels::Tunnel plan;
  registration::RegistrationSummary registration;
  TrackedPose world, guide;
  tools::ToolAxis axis;
  bool lens_is_stale = false;
  std::int64_t now_ns = 1'010'000'000;
};

constexpr double kRounding = 1e-9;

}  // namespace

// A guide on the plan reads zero everywhere, and all of the tunnel remains.
TEST(Guidance, OnThePlanAllIsZero) {
  const GuidanceNumbers numbers = Scene().compute();
  ASSERT_TRUE(numbers.is_valid());
  EXPECT_NEAR(numbers.tip_to_entry_mm, 0, kRounding);
  EXPECT_NEAR(numbers.axis_to_entry_mm, 0, kRounding);
  EXPECT_NEAR(numbers.angle_deg, 0, 1e-6);
  EXPECT_NEAR(numbers.depth_mm, 0, kRounding);
  EXPECT_NEAR(numbers.remaining_mm, 30, kRounding);
}

// Along the plan only the depth changes; across it only the offset, in the axis that it was moved along.
TEST(Guidance, OffsetsAndDepthAreThoseOfTheMotion) {
  Scene scene;
  scene.hold_guide(scene.plan.entry_mm + 12 * scene.plan.direction, scene.plan.direction);
  GuidanceNumbers numbers = scene.compute();
  EXPECT_NEAR(numbers.depth_mm, 12, kRounding);
  EXPECT_NEAR(numbers.remaining_mm, 18, kRounding);
  EXPECT_NEAR(numbers.axis_to_entry_mm, 0, kRounding);

  scene.hold_guide(scene.plan.entry_mm - 1.5 * Eigen::Vector3d::UnitY(), scene.plan.direction);  // anterior
  numbers = scene.compute();
  EXPECT_NEAR(numbers.offset_anterior_mm, 1.5, kRounding);
  EXPECT_NEAR(numbers.offset_proximal_mm, 0, kRounding);
  EXPECT_NEAR(numbers.axis_to_entry_mm, 1.5, kRounding);

  const Eigen::Vector3d proximal_in_plane(0.6, 0, 0.8);
  scene.hold_guide(scene.plan.entry_mm + 2 * proximal_in_plane - 5 * scene.plan.direction,
                   scene.plan.direction);
  numbers = scene.compute();
  EXPECT_NEAR(numbers.offset_proximal_mm, 2, kRounding);
  EXPECT_NEAR(numbers.offset_anterior_mm, 0, kRounding);
  EXPECT_NEAR(numbers.depth_mm, -5, kRounding);
}

// A guide that points at the entry from elsewhere reads its angle, and no offset.
TEST(Guidance, AngleIsThatBetweenTheAxes) {
  Scene scene;
  const Eigen::Vector3d direction =
      Eigen::AngleAxisd(geometry::rad_from_deg(7.5), Eigen::Vector3d::UnitY()) * scene.plan.direction;
  scene.hold_guide(scene.plan.entry_mm - 10 * direction, direction);
  const GuidanceNumbers numbers = scene.compute();
  EXPECT_NEAR(numbers.angle_deg, 7.5, 1e-6);
  EXPECT_NEAR(numbers.axis_to_entry_mm, 0, kRounding);
  EXPECT_NEAR(numbers.offset_anterior_mm, 0, kRounding);
  EXPECT_NEAR(numbers.tip_to_entry_mm, 10, kRounding);
}

// The predicted offset holds the registration's error at the entry and the tracked pose's at the arm's end.
TEST(Guidance, SigmaAddsUpItsSources) {
  Scene scene;
  scene.guide.covariance.topLeftCorner<3, 3>() = 0.01 * Eigen::Matrix3d::Identity();
  const double tracked_mm = std::sqrt(3 * 0.01);
  EXPECT_NEAR(scene.compute().sigma_offset_mm, tracked_mm, 1e-6);
  scene.registration.covariance.topLeftCorner<3, 3>() = 0.04 * Eigen::Matrix3d::Identity();
  EXPECT_NEAR(scene.compute().sigma_offset_mm, std::sqrt(3 * 0.01 + 3 * 0.04), 1e-6);
  scene.registration.covariance.bottomRightCorner<3, 3>() = 1e-4 * Eigen::Matrix3d::Identity();
  // Of an axis, two directions of turning count.
  EXPECT_NEAR(scene.compute().sigma_angle_deg, geometry::deg_from_rad(std::sqrt(2e-4)), 1e-6);
}

// Whatever is missing takes the guidance away, with its reason.
TEST(Guidance, NothingIsShownWithoutEverything) {
  Scene scene;
  scene.world.is_valid = false;
  EXPECT_EQ(scene.compute().state, GuidanceState::WorldMarkerLost);
  scene = Scene();
  scene.guide.is_valid = false;
  EXPECT_EQ(scene.compute().state, GuidanceState::GuideLost);
  scene = Scene();
  scene.now_ns = 2'000'000'000;
  EXPECT_EQ(scene.compute().state, GuidanceState::Stale);
  scene = Scene();
  scene.guide.timestamp_ns += 5;  // of another frame than the world marker
  EXPECT_EQ(scene.compute().state, GuidanceState::Stale);
  scene = Scene();
  scene.lens_is_stale = true;
  EXPECT_EQ(scene.compute().state, GuidanceState::LensStale);
  scene = Scene();
  scene.registration.reliable = false;
  EXPECT_EQ(scene.compute().state, GuidanceState::RegistrationUnreliable);
  scene = Scene();
  scene.registration.has_pose = false;
  EXPECT_EQ(scene.compute().state, GuidanceState::NoRegistration);
  EXPECT_EQ(compute_guidance({}).state, GuidanceState::NoPlan);
}

}  // namespace arthronaut::guidance
