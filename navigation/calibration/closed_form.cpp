#include "navigation/calibration/closed_form.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "navigation/calibration/conformal_map.h"

namespace arthronaut::calibration {
namespace {

Eigen::Vector2d turned(const Eigen::Vector2d& point, const Eigen::Vector2d& center, double angle_rad) {
  return center + Eigen::Rotation2Dd(angle_rad) * (point - center);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The picture's corners undistorted about a given principal point and distortion, and their homography.
std::optional<ConformalCamera> camera_given(const Sighting& seen, const Eigen::Vector2d& principal_px,
                                            double lambda) {
  std::vector<Eigen::Vector2d> undistorted;
  for (const Eigen::Vector2d& pixel : seen.pixels) {
    const Eigen::Vector2d d = pixel - principal_px;
    const double scale = 1 + lambda * d.squaredNorm();
    if (scale < 0.05) return std::nullopt;
    undistorted.push_back(d / scale);
  }
  auto camera = camera_without_distortion(undistorted, seen.board_mm, Eigen::Vector2d::Zero());
  if (camera) {
    camera->principal_point_px = principal_px;
    camera->lambda_px = lambda;
  }
  return camera;
}

// A complete start from one camera per picture. focal_px 0: from the homographies.
std::optional<Estimate> start_from(std::span<const Sighting> sightings, const Estimate& shared,
                                   const std::vector<Eigen::Vector2d>& principal_px, double lambda,
                                   double focal_px) {
  Estimate start = shared;
  std::vector<Eigen::Matrix3d> homographies;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    const auto camera = camera_given(sightings[i], principal_px[i], lambda);
    if (!camera) return std::nullopt;
    homographies.push_back(camera->homography);
  }
  if (focal_px <= 0) {
    const auto focal = focal_from_homographies(homographies);
    if (!focal) return std::nullopt;
    focal_px = *focal;
  }
  start.focal_px = focal_px;
  start.xi = lambda * focal_px * focal_px;
  start.camera_from_board.clear();
  for (const Eigen::Matrix3d& h : homographies)
    start.camera_from_board.push_back(pose_from_homography(h, focal_px));
  return start;
}

}  // namespace

std::optional<Eigen::Vector2d> center_of_turning(std::span<const Eigen::Vector2d> places,
                                                 std::span<const double> angles_rad) {
  // place_i = q + R(a_i) (p0 - q): linear in q and p0, over two unknown points.
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  for (std::size_t i = 0; i < places.size(); ++i) {
    Eigen::Matrix<double, 2, 4> rows;
    const Eigen::Matrix2d r = Eigen::Rotation2Dd(angles_rad[i]).toRotationMatrix();
    rows << Eigen::Matrix2d::Identity() - r, r;
    normal += rows.transpose() * rows;
    right += rows.transpose() * places[i];
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(normal);
  if (eigen.eigenvalues()(0) < 1e-3 * eigen.eigenvalues()(3)) return std::nullopt;
  const Eigen::Vector4d solution = normal.ldlt().solve(right);
  return Eigen::Vector2d(solution.head<2>());
}

std::vector<Estimate> closed_form_starts(std::span<const Sighting> sightings,
                                         const Eigen::Vector2i& size_px) {
  Estimate shared;
  const bool turns =
      std::all_of(sightings.begin(), sightings.end(), [](const Sighting& s) { return s.has_angle; });
  shared.reference_mark_angle_deg = turns ? sightings.front().mark_angle_deg : 0;
  std::vector<Eigen::Vector2d> circles;
  for (const Sighting& seen : sightings) {
    shared.lens_angle_rad.push_back(turns ? geometry::rad_from_deg(std::remainder(
                                                seen.mark_angle_deg - shared.reference_mark_angle_deg, 360.0))
                                          : 0.0);
    circles.push_back(seen.has_circle ? seen.circle_center_px
                                      : Eigen::Vector2d(0.5 * (size_px.cast<double>().array() - 1)));
  }
  const auto center = turns ? center_of_turning(circles, shared.lens_angle_rad) : std::nullopt;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const auto& c : circles) mean += c / static_cast<double>(circles.size());
  shared.rotation_center_px = center.value_or(mean);
  shared.circle_center_px =
      turned(circles.front(), shared.rotation_center_px, -shared.lens_angle_rad.front());
  shared.principal_point_px = shared.circle_center_px;

  std::vector<Estimate> starts;
  const auto add = [&](const std::vector<Eigen::Vector2d>& principal, double lambda, double focal_px) {
    auto start = start_from(sightings, shared, principal, lambda, focal_px);
    if (!start) return;
    start->principal_point_px =
        turned(principal.front(), shared.rotation_center_px, -shared.lens_angle_rad.front());
    starts.push_back(*start);
  };

  const double half_size = 0.5 * size_px.cast<double>().norm();
  std::vector<double> lambdas;
  std::vector<Eigen::Vector2d> principal = circles;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    const auto map = fit_conformal_map(sightings[i].pixels, sightings[i].board_mm);
    const auto camera = map ? camera_of(*map) : std::nullopt;
    if (!camera) continue;
    lambdas.push_back(camera->lambda_px);
    if ((camera->principal_point_px - circles[i]).norm() < 0.15 * half_size)
      principal[i] = camera->principal_point_px;
  }
  if (!lambdas.empty()) {
    add(principal, median(lambdas), 0);
    add(circles, median(lambdas), 0);
  }
  for (const double share : {0.0, -0.1, -0.25}) add(circles, share / (0.25 * half_size * half_size), 0);
  // Boards that all face the lens leave the focal length open: assume fields of view, the verdict says the
  // rest.
  for (const double focal_share : {0.55, 1.0, 2.0})
    add(circles, lambdas.empty() ? 0.0 : std::min(0.0, median(lambdas)), focal_share * half_size);
  return starts;
}

}  // namespace arthronaut::calibration
