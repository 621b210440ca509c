// The map from a picture under division-model distortion to a plane: with m(u) = (|u|^2, u_x, u_y, 1), a
// point of the plane is P ~ B m(u), where B is 3 x 4. It is linear in B and needs no start. Why: an
// undistorted, centred pixel is (u_x - c_x, u_y - c_y, 1 + lambda |u - c|^2), linear in m(u) too. Its kernel
// is B's null vector, scaled to end in 1:
//   nu = (|c|^2 - 1 / lambda, c_x, c_y, 1),   which gives the principal point c and the distortion lambda =
//   xi / f^2.
// Degenerate without distortion (lambda = 0) and, for the focal length, without tilt. Inside the module.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::calibration {

struct ConformalMap {
  // Acts on normalised pixels v = (u - mean_px) * scale.
  Eigen::Matrix<double, 3, 4> b = Eigen::Matrix<double, 3, 4>::Zero();
  Eigen::Vector2d mean_px = Eigen::Vector2d::Zero();
  double scale = 1;

  // Newton from a nearby pixel; nullopt when it does not arrive.
  [[nodiscard]] std::optional<Eigen::Vector2d> pixel_from_plane(const Eigen::Vector2d& point,
                                                                const Eigen::Vector2d& start_px) const;
};

// Least squares over all pairs (at least 8), the algebraic error weighted so that it counts pixels.
[[nodiscard]] std::optional<ConformalMap> fit_conformal_map(std::span<const Eigen::Vector2d> pixels,
                                                            std::span<const Eigen::Vector2d> plane_points);

// What the map says about the camera of one picture.
struct ConformalCamera {
  Eigen::Vector2d principal_point_px = Eigen::Vector2d::Zero();
  double lambda_px = 0;  // xi / f^2
  // Undistorted, centred pixels from the plane: (x, y, 1)_undistorted ~ H (X, Y, 1).
  Eigen::Matrix3d homography = Eigen::Matrix3d::Identity();
};
[[nodiscard]] std::optional<ConformalCamera> camera_of(const ConformalMap& map);

// The same with the principal point given and no distortion: a start where the closed form has no answer.
[[nodiscard]] std::optional<ConformalCamera> camera_without_distortion(
    std::span<const Eigen::Vector2d> pixels, std::span<const Eigen::Vector2d> plane_points,
    const Eigen::Vector2d& principal_point_px);

// One focal length for several homographies; nullopt when no plane is tilted enough to tell.
[[nodiscard]] std::optional<double> focal_from_homographies(std::span<const Eigen::Matrix3d> homographies);

// Pose of the plane (units of its points) seen with this focal length.
[[nodiscard]] geometry::RigidTransform pose_from_homography(const Eigen::Matrix3d& homography,
                                                            double focal_px);

}  // namespace arthronaut::calibration
