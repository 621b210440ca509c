#include "navigation/pipeline/navigation_pipeline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "planning/geometry/error.h"
#include "tests/navigation/pipeline/scripted_markers.h"

namespace arthronaut {
namespace {

using geometry::RigidTransform;
using guidance::GuidanceState;
using markers::MarkerState;

// Arithmetic of doubles alone separates the pipeline from the truth here.
constexpr double kExact = 1e-9;

RigidTransform pose(double x, double y, double z, double angle_rad, const Eigen::Vector3d& axis) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis.normalized())), {x, y, z}};
}

class NavigationPipeline : public ::testing::Test {
 protected:
  NavigationPipeline() : pipeline_(options_, std::make_unique<test::ScriptedMarkers>(&script_)) {
    registration_.has_pose = registration_.reliable = true;
    registration_.reasons.clear();
    registration_.marker_from_bone = pose(10, 20, -30, 0.4, {1, 2, 3});
    plan_.entry_mm = {3, -2, 8};
    plan_.direction = Eigen::Vector3d(0.2, -0.3, 0.9).normalized();
    script_ = {test::seen(0, camera_from_world_), test::seen(2, camera_from_world_ * world_from_probe_),
               test::seen(3, camera_from_world_ * world_from_guide())};
  }

  // A guide whose axis lies on the plan and whose end stands 5 mm before the entry.
  [[nodiscard]] RigidTransform world_from_guide() const {
    const RigidTransform& world_from_bone = registration_.marker_from_bone;
    RigidTransform result;
    result.rotation = Eigen::Quaterniond::FromTwoVectors(-Eigen::Vector3d::UnitY(),
                                                         world_from_bone.rotate(plan_.direction));
    const Eigen::Vector3d end = world_from_bone * (plan_.entry_mm - 5.0 * plan_.direction);
    result.translation_mm = end - result.rotate({0, -25, -4});
    return result;
  }

  const pipeline::FrameResult& process(std::int64_t index, std::uint8_t gray) {
    pipeline_.process(test::plain_frame(index, gray), result_);
    return result_;
  }

  // Whether poses.csv gets the poses of the newest picture.
  [[nodiscard]] bool written() const {
    std::vector<strokes::PoseRow> rows;
    pipeline::append_pose_rows(result_, rows);
    return !rows.empty();
  }

  RigidTransform camera_from_world_ = pose(1, 2, 25, 2.5, {1, 0.2, 0.1});
  RigidTransform world_from_probe_ = pose(-4, 12, 20, 1.1, {0.3, 1, 0.2});
  registration::RegistrationSummary registration_;
  tunnels::Tunnel plan_;
  pipeline::PipelineOptions options_ = test::scripted_options();
  std::vector<markers::MarkerObservation> script_;
  pipeline::NavigationPipeline pipeline_;
  pipeline::FrameResult result_;
};

// The tip in the world is the probe's pose relative to the world marker times the tip, wherever the camera
// is.
TEST_F(NavigationPipeline, PlacesTipAndToolsInTheWorldMarkersFrame) {
  const pipeline::FrameResult& result = process(0, 1);
  ASSERT_TRUE(result.tip_is_valid);
  EXPECT_LT((result.tip_in_world_mm - world_from_probe_ * Eigen::Vector3d(1, -30, -5)).norm(), kExact);
  ASSERT_EQ(result.tools.size(), 2u);
  const RigidTransform error =
      world_from_probe_.inverse() * result.tools[0].world_from_tool.target_from_source;
  EXPECT_LT(geometry::log(error).norm(), kExact);
}

// Plan, registration and guide by construction: on the axis, 5 mm before the entry, and no angle.
TEST_F(NavigationPipeline, GuidesAlongThePlan) {
  EXPECT_EQ(process(0, 1).guidance.state, GuidanceState::NoPlan);
  pipeline_.set_plan(plan_, 30);
  EXPECT_EQ(process(1, 2).guidance.state, GuidanceState::NoRegistration);
  pipeline_.set_registration(registration_);
  const guidance::GuidanceNumbers& g = process(2, 3).guidance;
  ASSERT_EQ(g.state, GuidanceState::Valid);
  EXPECT_NEAR(g.axis_to_entry_mm, 0, 1e-6);
  EXPECT_NEAR(g.angle_deg, 0, 1e-6);
  EXPECT_NEAR(g.tip_to_entry_mm, 5, 1e-6);
  EXPECT_EQ(g.timestamp_ns, result_.timestamp_ns);
}

// What tools and camera are known to stands in the numbers of the frame, the tip's and the guide's.
TEST_F(NavigationPipeline, Hazard6PredictsFromToolsAndCamera) {
  pipeline_.set_plan(plan_, 30);
  pipeline_.set_registration(registration_);
  ASSERT_NEAR(process(0, 1).guidance.sigma_offset_mm, 0, 1e-9);
  ASSERT_NEAR(result_.tip_covariance_mm2.trace(), 0, 1e-12);
  options_.calibration.covariance.reset();
  options_.tools.tools[0].tip_covariance_mm2.reset();
  options_.tools.tools[1].axis_point_sigma_mm.reset();
  options_.tools.tools[1].axis_direction_sigma_deg.reset();
  pipeline::NavigationPipeline nominal(options_, std::make_unique<test::ScriptedMarkers>(&script_));
  nominal.set_plan(plan_, 30);
  nominal.set_registration(registration_);
  nominal.process(test::plain_frame(0, 1), result_);
  const guidance::PredictedError offset = result_.guidance.offset_error_mm;
  // Axis point and direction over 5 mm, and the tip that drew the registration: 0.3 mm in two directions
  // each.
  const double turned_mm = 5 * geometry::rad_from_deg(0.5);
  EXPECT_NEAR(offset.tools, std::sqrt(2 * (0.09 + 0.09 + turned_mm * turned_mm)), 1e-6);
  EXPECT_GT(offset.camera, 0);
  EXPECT_GT(result_.tip_covariance_mm2.trace(), 3 * 0.09);
  // A registration drawn where the guide stands now followed the camera's error as the guide does, and leaves
  // less of it.
  script_[1] = test::seen(2, camera_from_world_ * world_from_guide());
  nominal.process(test::plain_frame(1, 2), result_);
  ASSERT_TRUE(result_.tip_is_valid);
  guidance::BiasSums sums;
  for (const Eigen::Vector3d& beside : {Eigen::Vector3d(3, 0, 0), Eigen::Vector3d(0, 3, 0),
                                        Eigen::Vector3d(0, 0, 3), Eigen::Vector3d(0, 0, 0)}) {
    guidance::TipSensitivity point = result_.tip_sensitivity;
    point.tip_mm += beside;
    sums.add(point);
  }
  nominal.set_registration(registration_, sums.bias());
  nominal.process(test::plain_frame(2, 3), result_);
  EXPECT_LT(result_.guidance.offset_error_mm.camera, 0.5 * offset.camera);
  EXPECT_NEAR(result_.guidance.offset_error_mm.registration, 0, 1e-9);
}

// A drill of the tool set is followed by its own marker; while it is not seen nothing is said about depth.
TEST_F(NavigationPipeline, Hazard7TheDrillIsFollowedByItsOwnMarker) {
  options_.tools.tools.push_back(test::scripted_drill());
  const RigidTransform& world_from_bone = registration_.marker_from_bone;
  RigidTransform world_from_drill;
  world_from_drill.rotation =
      Eigen::Quaterniond::FromTwoVectors(-Eigen::Vector3d::UnitY(), world_from_bone.rotate(plan_.direction));
  const Eigen::Vector3d tip = world_from_bone * (plan_.entry_mm + 12.0 * plan_.direction);
  world_from_drill.translation_mm = tip - world_from_drill.rotate({0, -40, -4});
  script_.push_back(test::seen(6, camera_from_world_ * world_from_drill));
  pipeline::NavigationPipeline drilling(options_, std::make_unique<test::ScriptedMarkers>(&script_));
  drilling.set_plan(plan_, 30);
  drilling.set_registration(registration_);
  drilling.process(test::plain_frame(0, 1), result_);
  ASSERT_TRUE(result_.guidance.drill);
  EXPECT_NEAR(result_.guidance.drill->depth_mm, 12, 1e-6);
  EXPECT_NEAR(result_.guidance.drill->remaining_mm, 18, 1e-6);
  script_.back() = test::lost(6, MarkerState::Covered);
  drilling.process(test::plain_frame(1, 2), result_);
  EXPECT_TRUE(result_.guidance.is_valid());
  EXPECT_FALSE(result_.guidance.drill);
}

// A tool set without the guide that is asked for is not "no plan".
TEST_F(NavigationPipeline, Hazard11SaysThatTheGuideIsMissing) {
  options_.guide_name = "another guide";
  pipeline::NavigationPipeline without(options_, std::make_unique<test::ScriptedMarkers>(&script_));
  without.set_plan(plan_, 30);
  without.set_registration(registration_);
  without.process(test::plain_frame(0, 1), result_);
  EXPECT_EQ(result_.guidance.state, GuidanceState::NoGuide);
}

// A marker that is lost takes everything that rests on it away in that very frame.
TEST_F(NavigationPipeline, DropsWhatRestsOnALostMarkerInTheSameFrame) {
  pipeline_.set_plan(plan_, 30);
  pipeline_.set_registration(registration_);
  ASSERT_TRUE(process(0, 1).guidance.is_valid());
  script_[2] = test::lost(3, MarkerState::Covered);
  EXPECT_EQ(process(1, 2).guidance.state, GuidanceState::GuideLost);
  EXPECT_TRUE(result_.tip_is_valid);
  script_[0] = test::lost(0, MarkerState::Glare);
  EXPECT_EQ(process(2, 3).guidance.state, GuidanceState::WorldMarkerLost);
  EXPECT_FALSE(result_.tip_is_valid);
  EXPECT_FALSE(result_.camera_from_world.is_valid);
  EXPECT_FALSE(result_.tools[0].world_from_tool.is_valid);
}

// The same picture for 0.3 s is no live picture: nothing of it may guide a hand, and no pose of it is
// written. The next new picture may.
TEST_F(NavigationPipeline, SaysThatAPictureIsFrozen) {
  pipeline_.set_plan(plan_, 30);
  pipeline_.set_registration(registration_);
  ASSERT_TRUE(process(0, 7).guidance.is_valid());
  for (int i = 1; i < 18; ++i) {
    EXPECT_FALSE(process(i, 7).is_frozen) << i;
    EXPECT_EQ(written(), !result_.is_repeating) << i;
  }
  EXPECT_TRUE(result_.is_repeating) << "long before it is called frozen";
  EXPECT_TRUE(process(18, 7).is_frozen);
  EXPECT_FALSE(written());
  EXPECT_EQ(result_.guidance.state, GuidanceState::Stale);
  EXPECT_FALSE(result_.tip_is_valid);
  EXPECT_FALSE(result_.camera_from_world.is_valid);
  EXPECT_TRUE(process(19, 60).guidance.is_valid());
  EXPECT_TRUE(written());
}

// The lower half of the picture stands, the upper half goes on: what shows the guide there is not of this
// moment, whatever the codec or the card did to it. Nothing guides from the third picture on; where the whole
// picture is renewed again, it does.
TEST_F(NavigationPipeline, Hazard3AMarkerInAPartThatStandsStillGuidesNobody) {
  pipeline_.set_plan(plan_, 30);
  pipeline_.set_registration(registration_);
  script_[2].corners_px = {Eigen::Vector2d(60, 80), {90, 80}, {90, 110}, {60, 110}};
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0, 2);
  camera::Frame frame = test::plain_frame(0, 100);
  for (int i = 0; i < 200; ++i) {
    const bool is_lost = i >= 60 && i < 120;
    frame.index = i;
    frame.timestamp_ns = test::plain_frame(i, 0).timestamp_ns;
    const std::size_t renewed = is_lost ? frame.bgr.size() / 2 : frame.bgr.size();
    for (std::size_t k = 0; k < renewed; k += 3)
      std::fill_n(frame.bgr.begin() + static_cast<std::ptrdiff_t>(k), 3,
                  static_cast<std::uint8_t>(std::lround(100 + noise(random))));
    pipeline_.process(frame, result_);
    if (i < 60 || i > 122) {
      EXPECT_TRUE(result_.guidance.is_valid()) << i;
    } else if (i > 61 && i < 120) {
      EXPECT_FALSE(result_.guidance.is_valid()) << i;
      EXPECT_TRUE(result_.is_torn) << i;
      EXPECT_EQ(result_.guidance.state, GuidanceState::PictureTorn) << i;
    }
  }
}

// The covariance of the tip against 20 000 draws of both poses' errors; 5 % is three standard errors of that
// many draws.
TEST_F(NavigationPipeline, PredictsTheTipsErrorFromBothPoses) {
  geometry::Matrix6d covariance = geometry::Matrix6d::Zero();
  covariance.diagonal() << 0.01, 0.02, 0.09, 4e-5, 3e-5, 1e-5;
  script_[0].covariance = script_[1].covariance = covariance;
  const Eigen::Matrix3d predicted = process(0, 1).tip_covariance_mm2;
  const Eigen::Vector3d tip = result_.tip_in_world_mm;

  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  const auto draw = [&] {
    geometry::Vector6d twist;
    for (int i = 0; i < 6; ++i) twist[i] = std::sqrt(covariance(i, i)) * normal(random);
    return geometry::exp(twist);
  };
  Eigen::Matrix3d sampled = Eigen::Matrix3d::Zero();
  constexpr int kDraws = 20000;
  for (int i = 0; i < kDraws; ++i) {
    const RigidTransform world_from_camera = (script_[0].camera_from_marker * draw()).inverse();
    const Eigen::Vector3d error =
        world_from_camera * (script_[1].camera_from_marker * draw() * Eigen::Vector3d(1, -30, -5)) - tip;
    sampled += error * error.transpose() / kDraws;
  }
  EXPECT_LT((sampled - predicted).norm(), 0.05 * predicted.norm());
}

// A picture without rim and mark says nothing about the lens: poses of such a frame stand only for a lens
// whose principal point lies on the axis that it turns about.
TEST_F(NavigationPipeline, StandsForNoPoseWhileTheLensIsUnknown) {
  options_.follow_lens = true;
  pipeline::NavigationPipeline turning(options_, std::make_unique<test::ScriptedMarkers>(&script_));
  turning.set_plan(plan_, 30);
  turning.set_registration(registration_);
  turning.process(test::plain_frame(0, 40), result_);
  EXPECT_FALSE(result_.intrinsics_are_known);
  EXPECT_EQ(result_.guidance.state, GuidanceState::LensStale);
  EXPECT_FALSE(result_.camera_from_world.is_valid);
  std::vector<strokes::PoseRow> rows;
  pipeline::append_pose_rows(result_, rows);
  EXPECT_TRUE(rows.empty());

  options_.calibration.rotation_center_px = options_.calibration.principal_point_px;
  pipeline::NavigationPipeline centred(options_, std::make_unique<test::ScriptedMarkers>(&script_));
  centred.process(test::round_frame(0, 40), result_);
  EXPECT_TRUE(result_.intrinsics_are_known);
  pipeline::append_pose_rows(result_, rows);
  EXPECT_EQ(rows.size(), 3u);
  EXPECT_FALSE(rows.front().mark_angle_deg.has_value());
}

// A rim that has gone out of the view, or has another radius, takes the focal length with it: no pose of that
// very frame stands, with or without a mark; and all do in the first frame in which the rim is as calibrated.
TEST_F(NavigationPipeline, ZoomUnknownMakesEveryPoseInvalidInThatFrame) {
  options_.follow_lens = true;
  options_.calibration.rotation_center_px = options_.calibration.principal_point_px;
  pipeline::NavigationPipeline zooming(options_, std::make_unique<test::ScriptedMarkers>(&script_));
  zooming.set_plan(plan_, 30);
  zooming.set_registration(registration_);
  const auto expect = [&](const camera::Frame& frame, lens::ZoomState zoom, bool stands) {
    zooming.process(frame, result_);
    EXPECT_EQ(result_.lens.zoom, zoom) << frame.index << ": " << lens::to_text(result_.lens.zoom);
    EXPECT_EQ(result_.intrinsics_are_known, stands) << frame.index;
    EXPECT_EQ(result_.camera_from_world.is_valid, stands) << frame.index;
    EXPECT_EQ(result_.tip_is_valid, stands) << frame.index;
    EXPECT_EQ(result_.guidance.is_valid(), stands) << frame.index;
    std::vector<strokes::PoseRow> rows;
    pipeline::append_pose_rows(result_, rows);
    EXPECT_EQ(rows.empty(), !stands) << frame.index;
  };
  using lens::ZoomState;
  expect(test::plain_frame(0, 90), ZoomState::Unknown, false);  // never seen
  for (int i = 1; i < 6; ++i) expect(test::round_frame(i, 90 + 2 * i), ZoomState::AsCalibrated, true);
  for (int i = 6; i < 9; ++i) expect(test::plain_frame(i, 90), ZoomState::Unknown, false);
  for (int i = 9; i < 12; ++i) expect(test::round_frame(i, 90), ZoomState::AsCalibrated, true);
  camera::Frame smaller = test::plain_frame(12, 0);  // the same picture, zoomed out by a tenth
  const camera::Frame whole = test::round_frame(12, 90);
  for (int y = 0; y < smaller.height; ++y) {
    for (int x = 0; x < smaller.width; ++x) {
      const long from_x = std::lround(80 + (x - 80) / 0.9), from_y = std::lround(60 + (y - 60) / 0.9);
      if (from_x < 0 || from_x >= 160 || from_y < 0 || from_y >= 120) continue;
      std::copy_n(whole.bgr.begin() + 3 * (from_y * 160 + from_x), 3,
                  smaller.bgr.begin() + 3 * (y * 160 + x));
    }
  }
  zooming.process(smaller, result_);
  EXPECT_NE(result_.lens.zoom, ZoomState::AsCalibrated);
  EXPECT_FALSE(result_.intrinsics_are_known || result_.camera_from_world.is_valid || result_.tip_is_valid);
}

// Another size than the calibration's is another camera.
TEST_F(NavigationPipeline, RefusesFramesOfAnotherSize) {
  camera::Frame frame = test::plain_frame(0, 1);
  frame.height = 119;
  EXPECT_THROW(pipeline_.process(frame, result_), InvalidInput);
}

TEST_F(NavigationPipeline, NeedsTheBonesWorldMarker) {
  options_.bone = bones::BoneKind::Tibia;
  EXPECT_THROW(pipeline::NavigationPipeline{options_}, InvalidInput);
}

// A world of two markers and a probe of two, seen by either, by both, or by two that contradict each other:
// tip and guidance follow the bodies, and of what disagrees there is neither.
TEST_F(NavigationPipeline, FollowsBodiesOfSeveralMarkers) {
  const RigidTransform second_of_world = pose(0, 8, 0.5, 0.2, {1, 0, 0});
  const RigidTransform second_of_probe = pose(6, 1, -1, 0.4, {0, 1, 0});
  options_.tools.world_markers[0].markers = {{0, 4.0, {}}, {10, 4.0, second_of_world}};
  options_.tools.tools[0].markers = {{2, 4.0, {}}, {12, 4.0, second_of_probe}};
  geometry::Matrix6d known = geometry::Matrix6d::Zero();
  known.diagonal() << 1e-4, 1e-4, 1e-3, 1e-4, 1e-4, 1e-4;
  const RigidTransform camera_from_probe = camera_from_world_ * world_from_probe_;
  const std::vector<markers::MarkerObservation> all{
      test::seen(0, camera_from_world_, known), test::seen(10, camera_from_world_ * second_of_world, known),
      test::seen(2, camera_from_probe, known), test::seen(12, camera_from_probe * second_of_probe, known),
      test::seen(3, camera_from_world_ * world_from_guide(), known)};
  pipeline::NavigationPipeline several(options_, std::make_unique<test::ScriptedMarkers>(&script_));
  several.set_plan(plan_, 30);
  several.set_registration(registration_);
  const Eigen::Vector3d tip = world_from_probe_ * Eigen::Vector3d(1, -30, -5);
  double error_of_both = 0;
  for (std::int64_t frame = 0; frame < 3; ++frame) {
    script_ = all;
    if (frame == 1) script_[0] = test::lost(0, MarkerState::Glare);
    if (frame == 2) script_[2] = test::lost(2, MarkerState::Covered);
    several.process(test::plain_frame(frame, static_cast<std::uint8_t>(frame + 1)), result_);
    ASSERT_EQ(result_.bodies.size(), 3u);
    ASSERT_TRUE(result_.tip_is_valid) << frame;
    EXPECT_LT((result_.tip_in_world_mm - tip).norm(), 1e-5) << frame;
    EXPECT_EQ(result_.guidance.state, GuidanceState::Valid) << frame;
    EXPECT_EQ(result_.tools[0].marker_id, 2);
    if (frame == 0) error_of_both = result_.tip_covariance_mm2.trace();
    EXPECT_TRUE(frame == 0 || result_.tip_covariance_mm2.trace() > error_of_both) << frame;
  }
  script_ = all;
  script_[1].camera_from_marker = script_[1].camera_from_marker * pose(1.5, 0, 0, 0.1, {0, 1, 0});
  several.process(test::plain_frame(3, 4), result_);
  EXPECT_EQ(result_.bodies[0].state, MarkerState::Disagreeing);
  EXPECT_FALSE(result_.camera_from_world.is_valid);
  EXPECT_FALSE(result_.tip_is_valid);
  EXPECT_EQ(result_.guidance.state, GuidanceState::WorldMarkerLost);
  EXPECT_EQ(pipeline::body_in(result_, 0).state, MarkerState::Disagreeing);

  // Whichever of the two is wrong: neither is believed alone, until they agree again.
  for (const std::size_t covered : {0u, 1u}) {
    script_ = all;
    script_[covered] = test::lost(covered == 0 ? 0 : 10, MarkerState::Covered);
    const auto frame = static_cast<std::int64_t>(4 + covered);
    several.process(test::plain_frame(frame, static_cast<std::uint8_t>(frame + 1)), result_);
    EXPECT_FALSE(result_.camera_from_world.is_valid) << covered;
    EXPECT_NE(result_.guidance.state, GuidanceState::Valid) << covered;
    EXPECT_EQ(result_.bodies[0].state, MarkerState::Disagreeing) << covered;
  }
  for (std::int64_t frame = 6; frame < 8; ++frame) {
    script_ = all;
    if (frame == 7) script_[1] = test::lost(10, MarkerState::Covered);
    several.process(test::plain_frame(frame, static_cast<std::uint8_t>(frame + 1)), result_);
    EXPECT_TRUE(result_.camera_from_world.is_valid) << frame;
  }
}

}  // namespace
}  // namespace arthronaut
