#include "navigation/guidance/guidance.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

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

  // The drill's tip stands so in the bone, with a marker of its own.
  void hold_drill(const Eigen::Vector3d& tip_mm) {
    drill.emplace();
    drill->kind = tools::ToolKind::Drill;
    drill->tip_mm = Eigen::Vector3d(0, -60, -4);
    drill->axis = tools::ToolAxis{{0, -60, -4}, -Eigen::Vector3d::UnitY()};
    drill->tip_covariance_mm2 = Eigen::Matrix3d(0.04 * Eigen::Matrix3d::Identity());
    RigidTransform bone_from_drill;
    bone_from_drill.rotation = Eigen::Quaterniond::FromTwoVectors(-Eigen::Vector3d::UnitY(), plan.direction);
    bone_from_drill.translation_mm = tip_mm - bone_from_drill.rotate(*drill->tip_mm);
    drill_pose = guide;
    drill_pose.target_from_source =
        world.target_from_source * registration.marker_from_bone * bone_from_drill;
    drill_pose.is_valid = true;
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
    input.axis = has_axis ? &axis : nullptr;
    input.axes = axes;
    const DrillInput seen{drill ? &*drill : nullptr, drill_pose, drill_per_camera_error};
    input.drills = {&seen, 1};
    input.known_errors = &known;
    input.axis_error = axis_error;
    input.world_marker_per_camera_error = world_per_camera_error;
    input.guide_per_camera_error = guide_per_camera_error;
    input.lens_is_stale = lens_is_stale;
    input.now_ns = now_ns;
    return compute_guidance(input);
  }

  tunnels::Tunnel plan;
  registration::RegistrationSummary registration;
  TrackedPose world, guide;
  tools::ToolAxis axis;
  bool has_axis = true;
  landmarks::AnatomicalAxes axes;
  TrackedPose drill_pose;
  std::optional<tools::Tool> drill;
  KnownErrors known;
  tools::AxisError axis_error;
  std::optional<TwistPerCameraError> world_per_camera_error = TwistPerCameraError::Zero(),
                                     guide_per_camera_error = TwistPerCameraError::Zero(),
                                     drill_per_camera_error = TwistPerCameraError::Zero();
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
  EXPECT_NEAR(numbers.offset_mm, 0, kRounding);
}

// Without an error that can be told there is no number: of the guide, and of a drill that is seen.
TEST(Guidance, Hazard6APoseWhoseErrorCannotBeSaidGivesNoNumber) {
  Scene scene;
  scene.hold_drill(scene.plan.entry_mm);
  ASSERT_TRUE(scene.compute().drill);
  scene.guide_per_camera_error.reset();
  EXPECT_EQ(scene.compute().state, GuidanceState::ErrorUnknown);
  EXPECT_TRUE(scene.compute().drill);
  scene.guide_per_camera_error = TwistPerCameraError::Zero();
  scene.drill_per_camera_error.reset();
  EXPECT_TRUE(scene.compute().is_valid());
  EXPECT_FALSE(scene.compute().drill);
  scene.drill_per_camera_error = TwistPerCameraError::Zero();
  scene.world_per_camera_error.reset();
  EXPECT_EQ(scene.compute().state, GuidanceState::ErrorUnknown);
  EXPECT_FALSE(scene.compute().drill);
}

// Along the plan only the depth changes; across it only the offset, in the axis that it was moved along.
TEST(Guidance, OffsetsAndDepthAreThoseOfTheMotion) {
  Scene scene;
  scene.hold_guide(scene.plan.entry_mm + 12 * scene.plan.direction, scene.plan.direction);
  GuidanceNumbers numbers = scene.compute();
  EXPECT_NEAR(numbers.depth_mm, 12, kRounding);
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
// The offset has two coordinates, across the plan.
TEST(Guidance, SigmaAddsUpItsSources) {
  Scene scene;
  scene.guide.covariance.topLeftCorner<3, 3>() = 0.01 * Eigen::Matrix3d::Identity();
  EXPECT_NEAR(scene.compute().sigma_offset_mm, std::sqrt(2 * 0.01), 1e-6);
  scene.registration.covariance.topLeftCorner<3, 3>() = 0.04 * Eigen::Matrix3d::Identity();
  EXPECT_NEAR(scene.compute().sigma_offset_mm, std::sqrt(2 * 0.01 + 2 * 0.04), 1e-6);
  scene.registration.covariance.bottomRightCorner<3, 3>() = 1e-4 * Eigen::Matrix3d::Identity();
  // Of an axis, two directions of turning count.
  EXPECT_NEAR(scene.compute().sigma_angle_deg, geometry::deg_from_rad(std::sqrt(2e-4)), 1e-6);
}

// What the tools are known to counts, and each source has its share: the squares add up.
TEST(Guidance, Hazard6SigmaHoldsToolsAndSaysTheShares) {
  Scene scene;
  scene.axis_error = {0.3, geometry::rad_from_deg(0.5)};
  GuidanceNumbers numbers = scene.compute();
  EXPECT_NEAR(numbers.sigma_offset_mm, 0.3 * std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(numbers.sigma_angle_deg, 0.5 * std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(numbers.offset_error_mm.tools, numbers.sigma_offset_mm, 1e-9);
  // The probe's tip, by way of the registration that it drew.
  scene.known.registration = BiasSums().bias();
  scene.known.probe_tip_mm2 = 0.16 * Eigen::Matrix3d::Identity();
  scene.guide.covariance = 0.01 * geometry::Matrix6d::Identity();
  scene.registration.covariance = 0.001 * geometry::Matrix6d::Identity();
  numbers = scene.compute();
  const PredictedError& e = numbers.offset_error_mm;
  EXPECT_NEAR(e.tools, std::sqrt(2 * (0.09 + 0.16)), 1e-6);
  EXPECT_GT(e.marker, 0);
  EXPECT_GT(e.registration, 0);
  EXPECT_NEAR(e.total * e.total,
              e.camera * e.camera + e.tools * e.tools + e.marker * e.marker + e.registration * e.registration,
              1e-9);
}

// Of 300 guides held anyhow over plans that run anyhow: the two parts that stand on the screen are the
// offset, to rounding, and along the plan there is none; whatever the bone's axes are.
TEST(Guidance, Hazard31OffsetAndItsPartsAreOneGeometry) {
  std::mt19937 random(31);
  std::normal_distribution<double> normal;
  const auto any = [&] { return Eigen::Vector3d(normal(random), normal(random), normal(random)); };
  for (int i = 0; i < 300; ++i) {
    Scene scene;
    scene.plan.direction = any().normalized();
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.5 * normal(random), any().normalized()));
    scene.axes.anterior = turn * scene.axes.anterior;
    scene.axes.proximal = turn * scene.axes.proximal;
    scene.axes.lateral = turn * scene.axes.lateral;
    scene.hold_guide(scene.plan.entry_mm + 8 * any(), any().normalized());
    const GuidanceNumbers n = scene.compute();
    ASSERT_TRUE(n.is_valid());
    const double up = n.offset_in_mm(n.across_plan.up_is), side = n.offset_in_mm(n.across_plan.side_is);
    EXPECT_NE(n.across_plan.up_is, n.across_plan.side_is);
    EXPECT_NEAR(std::hypot(up, side), n.offset_mm, 1e-9 * (1 + n.offset_mm));
    EXPECT_NEAR(Eigen::Vector3d(n.offset_anterior_mm, n.offset_proximal_mm, n.offset_lateral_mm).norm(),
                n.offset_mm, 1e-9 * (1 + n.offset_mm));
    // The parts are those of the crossing itself.
    const Eigen::Vector3d crossing = scene.plan.entry_mm + up * n.across_plan.up + side * n.across_plan.side;
    if (std::abs(n.guide_direction.dot(scene.plan.direction)) > 0.1) {
      EXPECT_LT((crossing - n.guide_point_mm).cross(n.guide_direction).norm(), 1e-6 * (1 + n.offset_mm));
      // Never shorter than the entry's distance from the guide's axis.
      EXPECT_GE(n.offset_mm, n.axis_to_entry_mm - 1e-9);
    }
  }
}

// With a guide alone nobody knows how deep the drill is; a drill that is seen says it, and how far the far
// side is, whether the guide is seen or not.
TEST(Guidance, Hazard7DepthIsSaidOnlyOfADrillThatIsSeen) {
  Scene scene;
  EXPECT_FALSE(scene.compute().drill);
  scene.hold_drill(scene.plan.entry_mm + 27 * scene.plan.direction);
  GuidanceNumbers numbers = scene.compute();
  ASSERT_TRUE(numbers.drill);
  EXPECT_NEAR(numbers.drill->depth_mm, 27, kRounding);
  EXPECT_NEAR(numbers.drill->remaining_mm, 3, kRounding);
  EXPECT_NEAR(numbers.drill->lateral_mm, 0, 1e-6);
  EXPECT_NEAR(numbers.drill->sigma_mm, 0.2, 1e-6);
  EXPECT_EQ(numbers.drill->breakout, Breakout::Near);
  scene.guide.is_valid = false;
  EXPECT_TRUE(scene.compute().drill);
  scene.drill_pose.is_valid = false;
  EXPECT_FALSE(scene.compute().drill);
  scene.hold_drill(scene.plan.entry_mm);
  scene.registration.reliable = false;
  EXPECT_FALSE(scene.compute().drill);
}

// A drill by itself is as uncertain as a guide with its tip and its axis would be, whether a guide is seen or
// not: what the guide is known to is not what the drill is.
TEST(Guidance, Hazard29TheDrillsErrorIsItsOwn) {
  Scene scene;
  scene.registration.covariance.bottomRightCorner<3, 3>() = 1e-4 * Eigen::Matrix3d::Identity();
  scene.hold_drill(scene.plan.entry_mm + 20 * scene.plan.direction);
  scene.drill->axis_direction_sigma_deg = 0.4;
  scene.axis_error = {0.7, geometry::rad_from_deg(2)};
  const GuidanceNumbers seen = scene.compute();
  scene.guide.is_valid = false;
  const GuidanceNumbers alone = scene.compute();
  for (const GuidanceNumbers& numbers : {seen, alone}) {
    ASSERT_TRUE(numbers.drill);
    // Two directions across the drill: the registration's turn of 0.01 rad each, and the axis's own.
    EXPECT_NEAR(numbers.drill->sigma_angle_deg,
                std::sqrt(2.0) * std::hypot(geometry::deg_from_rad(0.01), 0.4), 1e-6);
    // At the entry: the tip's 0.2 mm in two coordinates, the axis's turn over 20 mm, and the registration's
    // about the bone's origin.
    const Eigen::Vector3d& entry = scene.plan.entry_mm;
    const double along = entry.dot(scene.plan.direction);
    const double arm_squares = entry.squaredNorm() + along * along;  // of [p]x across the plan
    const double own = 2 * 0.04 + 2 * std::pow(20 * geometry::rad_from_deg(0.4), 2);
    EXPECT_NEAR(numbers.drill->sigma_offset_mm, std::sqrt(own + 1e-4 * arm_squares), 1e-6);
  }
}

// A tool set without the guide, or a guide without axis, is not "no plan".
TEST(Guidance, Hazard11AMissingGuideHasItsOwnState) {
  Scene scene;
  scene.has_axis = false;
  EXPECT_EQ(scene.compute().state, GuidanceState::NoGuide);
  EXPECT_EQ(to_text(GuidanceState::NoGuide), "no drill guide with an axis");
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
