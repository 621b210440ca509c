// Poses by edges alone, told from the one that is tilted the other way.
#include "navigation/markers/edge_pose.h"

#include <gtest/gtest.h>

#include "tests/navigation/markers/rendered_marker.h"

namespace arthronaut::markers {
namespace {

using geometry::RigidTransform;

constexpr double kSize_mm = 4;

// Where the edges of a marker at this pose are seen, each said to be good to sigma_px.
std::vector<EdgeMeasurement> edges_of(const camera::CameraModel& camera, std::span<const EdgeSample> samples,
                                      const RigidTransform& pose, double sigma_px) {
  std::vector<EdgeMeasurement> edges;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Eigen::Vector3d place(samples[i].x * kSize_mm, samples[i].y * kSize_mm, 0);
    const Eigen::Vector3d axis = samples[i].axis == 0 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
    EdgeMeasurement edge;
    edge.state = EdgeState::Found;
    edge.sample = static_cast<int>(i);
    edge.point_px = *camera.project(pose * place);
    edge.normal = (*camera.project(pose * Eigen::Vector3d(place + 0.01 * axis)) - edge.point_px).normalized();
    edge.sigma_px = sigma_px;
    edges.push_back(edge);
  }
  return edges;
}

// Where the pose has them: as of sides that are hardly seen.
Corners corners_of(const camera::CameraModel& camera, const RigidTransform& pose) {
  Corners corners;
  const auto corners_mm = square_corners_mm(kSize_mm);
  for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = *camera.project(pose * corners_mm[i]);
  return corners;
}

// As blood over two sides of a marker left it: the fit has settled on the wrong tilt, where its edges lie
// farther off than they say and its corners farther than a pixel from the right pose's.
TEST(EdgePose, ABadFitIsAskedWhetherItIsTiltedTheOtherWayHoweverFarItsCornersAre) {
  const camera::CameraModel camera = small_scope();
  const auto samples = edge_samples(codes_4x4_50()[0]);
  const RigidTransform truth = facing_pose(0.5, 0.3, 32, 24, 14, 25);
  const auto edges = edges_of(camera, samples, truth, 0.4);
  std::vector<char> is_inlier;
  const auto is_asked = [&](const EdgePose& fit) {
    return rival_tilt(camera, kSize_mm, samples, edges, fit, corners_of(camera, fit.camera_from_marker),
                      BloomPrior(), is_inlier)
        .has_value();
  };
  const EdgePose wrong =
      fit_edge_pose(camera, kSize_mm, samples, edges, tilted_back(truth), BloomPrior(), is_inlier);
  ASSERT_TRUE(wrong.converged);
  ASSERT_GT(geometry::rotation_angle_rad(wrong.camera_from_marker.rotation.conjugate() * truth.rotation),
            0.5);
  const auto back = refine_square_pose(camera, corners_of(camera, wrong.camera_from_marker), kSize_mm,
                                       tilted_back(wrong.camera_from_marker));
  ASSERT_TRUE(back.has_value());
  ASSERT_GT(back->rms_px, 1);
  EXPECT_TRUE(is_asked(wrong));
  const EdgePose right = fit_edge_pose(camera, kSize_mm, samples, edges, truth, BloomPrior(), is_inlier);
  EXPECT_FALSE(is_asked(right));
}

}  // namespace
}  // namespace arthronaut::markers
