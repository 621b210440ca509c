#include "navigation/calibration/closed_form.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "navigation/calibration/conformal_map.h"
#include "planning/geometry/quantile.h"

namespace arthronaut::calibration {

Eigen::Vector2d turned_about(const Eigen::Vector2d& center, const Eigen::Vector2d& point, double angle_rad) {
  return center + Eigen::Rotation2Dd(angle_rad) * (point - center);
}

namespace {

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

namespace {

// Where the view's centre stands in each picture; the image's middle stands in for it.
std::vector<Eigen::Vector2d> circle_centers(std::span<const Sighting> sightings,
                                            const Eigen::Vector2i& size_px) {
  std::vector<Eigen::Vector2d> centers;
  for (const Sighting& seen : sightings)
    centers.push_back(seen.has_circle ? seen.circle_center_px
                                      : Eigen::Vector2d(0.5 * (size_px.cast<double>().array() - 1)));
  return centers;
}

// Lens angles, centre of rotation and the circle at lens angle 0, from marks and circles alone.
Estimate turning_of(std::span<const Sighting> sightings, const std::vector<Eigen::Vector2d>& circles,
                    bool turns) {
  Estimate shared;
  shared.lens_angle_rad.assign(sightings.size(), 0.0);
  shared.rotation_center_px.setZero();
  for (const auto& c : circles) shared.rotation_center_px += c / static_cast<double>(circles.size());
  shared.circle_center_px = shared.rotation_center_px;
  if (!turns) return shared;
  const auto first =
      std::find_if(sightings.begin(), sightings.end(), [](const Sighting& s) { return s.has_angle; });
  shared.reference_mark_angle_deg = first->mark_angle_deg;
  std::vector<Eigen::Vector2d> places;
  std::vector<double> angles;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    if (!sightings[i].has_angle) continue;
    shared.lens_angle_rad[i] = geometry::rad_from_deg(
        std::remainder(sightings[i].mark_angle_deg - shared.reference_mark_angle_deg, 360.0));
    places.push_back(circles[i]);
    angles.push_back(shared.lens_angle_rad[i]);
  }
  shared.rotation_center_px = center_of_turning(places, angles).value_or(shared.rotation_center_px);
  shared.circle_center_px = places.front();
  const Eigen::Vector2d from = shared.circle_center_px - shared.rotation_center_px;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    if (sightings[i].has_angle) continue;
    const Eigen::Vector2d to = circles[i] - shared.rotation_center_px;
    shared.lens_angle_rad[i] = std::atan2(from.x() * to.y() - from.y() * to.x(), from.dot(to));
  }
  return shared;
}

}  // namespace

std::vector<Estimate> closed_form_starts(std::span<const Sighting> sightings, const Eigen::Vector2i& size_px,
                                         bool turns) {
  const std::vector<Eigen::Vector2d> circles = circle_centers(sightings, size_px);
  Estimate shared = turning_of(sightings, circles, turns);
  shared.principal_point_px = shared.circle_center_px;

  std::vector<Estimate> starts;
  const auto add = [&](const std::vector<Eigen::Vector2d>& principal, double lambda, double focal_px) {
    auto start = start_from(sightings, shared, principal, lambda, focal_px);
    if (!start) return;
    start->principal_point_px =
        turned_about(shared.rotation_center_px, principal.front(), -shared.lens_angle_rad.front());
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
    add(principal, geometry::median(lambdas), 0);
    add(circles, geometry::median(lambdas), 0);
  }
  for (const double share : {0.0, -0.1, -0.25}) add(circles, share / (0.25 * half_size * half_size), 0);
  // Boards that all face the lens leave the focal length open: assume fields of view, the verdict says the
  // rest.
  for (const double focal_share : {0.55, 1.0, 2.0})
    add(circles, lambdas.empty() ? 0.0 : std::min(0.0, geometry::median(lambdas)), focal_share * half_size);
  return starts;
}

}  // namespace arthronaut::calibration
