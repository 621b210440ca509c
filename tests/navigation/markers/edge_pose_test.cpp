// Poses by edges alone, told from the one that is tilted the other way, and from one between two.
#include "navigation/markers/edge_pose.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

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

std::optional<geometry::Matrix6d> doubt_of(const camera::CameraModel& camera,
                                           std::span<const EdgeSample> samples,
                                           std::span<const EdgeMeasurement> edges,
                                           const RigidTransform& start) {
  std::vector<char> is_inlier;
  std::vector<EdgeMeasurement> half;
  const EdgePose fit = fit_edge_pose(camera, kSize_mm, samples, edges, start, BloomPrior(), is_inlier);
  EXPECT_TRUE(fit.converged);
  return doubt_by_halves(camera, kSize_mm, samples, edges, fit, BloomPrior(), half, is_inlier);
}

// Edges of which the upper half is of a marker that is tilted by so much more.
std::vector<EdgeMeasurement> bent_edges(const camera::CameraModel& camera,
                                        std::span<const EdgeSample> samples, const RigidTransform& truth,
                                        double bent_rad) {
  const RigidTransform bent =
      truth * RigidTransform{Eigen::Quaterniond(Eigen::AngleAxisd(bent_rad, Eigen::Vector3d::UnitX())),
                             Eigen::Vector3d::Zero()};
  auto edges = edges_of(camera, samples, truth, 0.3);
  const auto others = edges_of(camera, samples, bent, 0.3);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (samples[i].y > 0) edges[i] = others[i];
  }
  return edges;
}

// As a wire across a marker passes for its upper side: what is beside the truth is as much as what is of it.
TEST(EdgePose, AFitBetweenWhatTwoHalvesSayIsHeldByNeither) {
  const camera::CameraModel camera = small_scope();
  const auto samples = edge_samples(codes_4x4_50()[0]);
  const RigidTransform truth = facing_pose(0.5, 0.3, 24, 24, 14, 25);
  EXPECT_EQ(doubt_of(camera, samples, edges_of(camera, samples, truth, 0.3), truth),
            geometry::Matrix6d(geometry::Matrix6d::Zero()));
  EXPECT_EQ(doubt_of(camera, samples, bent_edges(camera, samples, truth, 0.2), truth), std::nullopt);
}

// Bent more, most of what is not of it falls out, and the fit is a degree off: near enough to stand, if it
// says so. Of one direction a square of 6 would be six sigma.
TEST(EdgePose, AFitThatIsNearWhatAHalfSaysIsDoubtedByTheRest) {
  const camera::CameraModel camera = small_scope();
  const auto samples = edge_samples(codes_4x4_50()[0]);
  const RigidTransform truth = facing_pose(0.5, 0.3, 24, 24, 14, 25);
  const auto edges = bent_edges(camera, samples, truth, 0.35);
  std::vector<char> is_inlier;
  const EdgePose fit = fit_edge_pose(camera, kSize_mm, samples, edges, truth, BloomPrior(), is_inlier);
  const geometry::Vector6d error = geometry::log(fit.camera_from_marker.inverse() * truth);
  const auto square_by = [&error](const geometry::Matrix6d& covariance) {
    return error.dot(covariance.inverse() * error) / 6;
  };
  const auto doubt = doubt_of(camera, samples, edges, truth);
  ASSERT_TRUE(doubt.has_value());
  EXPECT_GT(square_by(fit.covariance), 6);
  EXPECT_LT(square_by(fit.covariance + *doubt), 2);
}

// What hides or moves a quarter of it leaves two halves as they are.
TEST(EdgePose, AFitIsHeldByTheHalvesThatACoverLeaves) {
  const camera::CameraModel camera = small_scope();
  const auto samples = edge_samples(codes_4x4_50()[0]);
  const RigidTransform truth = facing_pose(0.5, 0.3, 24, 24, 14, 25);
  auto edges = edges_of(camera, samples, truth, 0.3);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (samples[i].x > 0 && samples[i].y > 0) edges[i].offset_px = 3;
  }
  EXPECT_EQ(doubt_of(camera, samples, edges, truth), geometry::Matrix6d(geometry::Matrix6d::Zero()));
  for (EdgeMeasurement& edge : edges) {
    if (samples[edge.sample].y > 0) edge.state = EdgeState::Different;
  }
  EXPECT_EQ(doubt_of(camera, samples, edges, truth), geometry::Matrix6d(geometry::Matrix6d::Zero()));
}

}  // namespace
}  // namespace arthronaut::markers
