// Counts what operator new is asked for while frames are processed. In a program of its own, since it
// replaces it.
#include <gtest/gtest.h>

#include "navigation/markers/planar_pose.h"
#include "navigation/pipeline/medium_check.h"
#include "navigation/tracker/pose_book.h"
#include "tests/counted_allocations.h"
#include "tests/navigation/pipeline/scripted_markers.h"
#include "tests/planning/geometry/shapes.h"

namespace arthronaut {
namespace {

// Grey conversion, lens, frozen picture, poses, tip and guidance allocate nothing once buffers have their
// size. (How markers are found is not the pipeline's: a scripted tracker stands in.)
TEST(NavigationPipelineAllocation, NothingPerFrameAfterTheFirstFrames) {
  auto script =
      std::vector<markers::MarkerObservation>{test::seen(0, {Eigen::Quaterniond(0, 1, 0, 0), {0, 0, 20}}),
                                              test::seen(2, {Eigen::Quaterniond(0, 1, 0, 0), {5, 0, 20}}),
                                              test::seen(3, {Eigen::Quaterniond(0, 1, 0, 0), {0, 5, 20}}),
                                              test::seen(6, {Eigen::Quaterniond(0, 1, 0, 0), {5, 5, 20}})};
  pipeline::PipelineOptions options = test::scripted_options();
  options.follow_lens = true;
  options.calibration.covariance.reset();  // what nobody said is taken as nominal
  options.tools.tools.push_back(test::scripted_drill());
  options.calibration.rotation_center_px = options.calibration.principal_point_px;
  pipeline::NavigationPipeline pipeline(options, std::make_unique<test::ScriptedMarkers>(&script));
  pipeline.set_plan(tunnels::Tunnel{}, 30);
  pipeline.set_bone(std::make_shared<const geometry::Surface>(test::box({60, 60, 60})));
  registration::RegistrationSummary registration;
  registration.has_pose = registration.reliable = true;
  registration.reasons.clear();
  pipeline.set_registration(registration);

  std::vector<camera::Frame> frames;
  for (int i = 0; i < 40; ++i) frames.push_back(test::round_frame(i, static_cast<std::uint8_t>(90 + i % 7)));
  pipeline::FrameResult result;
  for (int i = 0; i < 5; ++i) pipeline.process(frames[static_cast<std::size_t>(i)], result);
  ASSERT_TRUE(result.guidance.is_valid());
  ASSERT_TRUE(result.guidance.drill);
  ASSERT_GT(result.guidance.offset_error_mm.camera, 0);
  test::start_counting_allocations();
  for (int i = 5; i < 40; ++i) pipeline.process(frames[static_cast<std::size_t>(i)], result);
  EXPECT_EQ(test::stop_counting_allocations(), 0);
}

// By an outside tracker's poses, from its book to guidance.
TEST(NavigationPipelineAllocation, NothingPerFrameWithAnOutsideTracker) {
  pipeline::PipelineOptions options = test::scripted_options();
  options.tools.tracker = tools::OutsideTracker{"", 0.2, 0.1};
  pipeline::NavigationPipeline pipeline(options);
  pipeline.set_plan(tunnels::Tunnel{}, 30);
  registration::RegistrationSummary registration;
  registration.has_pose = registration.reliable = true;
  registration.reasons.clear();
  pipeline.set_registration(registration);
  tracker::PoseBook book({options.tools, options.bone, options.probe_name, options.guide_name});
  book.begin(0);
  std::vector<camera::Frame> frames;
  for (int i = 0; i < 80; ++i) frames.push_back(test::round_frame(i, static_cast<std::uint8_t>(90 + i % 7)));
  pipeline::FrameResult result;
  tracker::TrackerPoses poses;
  const auto step = [&](int i) {
    const std::int64_t now_ns = 1'000'000'000'000 + i * 16'000'000LL;
    const geometry::RigidTransform pose{Eigen::Quaterniond::Identity(), {0.01 * i, 0, 500}};
    for (const char* device : {"WorldFemur", "Probe", "Guide"})
      book.take({device, pose, 1.8e9 + 0.016 * i, now_ns});
    book.poses_at(now_ns, poses);
    pipeline.process(frames[static_cast<std::size_t>(i)], result, &poses);
  };
  for (int i = 0; i < 40; ++i) step(i);
  ASSERT_TRUE(result.guidance.is_valid());
  test::start_counting_allocations();
  for (int i = 40; i < 80; ++i) step(i);
  EXPECT_EQ(test::stop_counting_allocations(), 0);
  EXPECT_TRUE(result.guidance.is_valid());
  EXPECT_TRUE(result.tip_is_valid);
  EXPECT_FALSE(result.camera_from_world.is_valid);
}

// Votes on the medium, for and against, cost no memory either.
TEST(MediumCheckAllocation, NothingPerFrame) {
  const std::vector<markers::DeclaredMarker> declared{{0, 4}};
  // As many pixels as a scope has: in small pictures every medium looks alike.
  camera::Calibration scope = test::small_calibration();
  constexpr double kTimes = 8;
  scope.image_size_px *= static_cast<int>(kTimes);
  scope.focal_px *= kTimes;
  scope.principal_point_px *= kTimes;
  scope.rotation_center_px *= kTimes;
  scope.boundary.center_px *= kTimes;
  scope.boundary.radius_px *= kTimes;
  const camera::CameraModel saline(scope, 0, 1.3345);
  pipeline::PictureObservation view;
  view.intrinsics_are_known = true;
  view.camera = camera::CameraModel(scope, 0, 1.0);  // as is said; the picture is of saline
  view.markers = {test::seen(0, {Eigen::Quaterniond(0, 1, 0, 0), {0, 0, 7}})};
  view.markers[0].camera_from_marker.rotation =
      Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitX())) * Eigen::Quaterniond(0, 1, 0, 0);
  const auto corners_mm = markers::square_corners_mm(4);
  for (std::size_t k = 0; k < 4; ++k)
    view.markers[0].corners_px[k] =
        saline.project(view.markers[0].camera_from_marker * corners_mm[k]).value();
  pipeline::MediumCheck check(declared, 1.0, 1.0);
  test::start_counting_allocations();
  for (int i = 0; i < 60; ++i) {
    view.timestamp_ns = i * 100'000'000LL;
    check.look(view);
    if (check.wants_second_look()) check.look_again(view, view.markers);
  }
  EXPECT_EQ(test::stop_counting_allocations(), 0);
  EXPECT_GT(check.verdict().votes_for + check.verdict().votes_against, 0);
}

}  // namespace
}  // namespace arthronaut
