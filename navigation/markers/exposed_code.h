// The printed code as an exposure shows it: looked at along one pixel's ray at several moments of the
// exposure and smeared by the optics. Pure mathematics on the marker's plane; the camera enters by the ray
// alone.
#pragma once

#include <Eigen/Core>
#include <array>

#include "navigation/markers/marker_pattern.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::markers {

// How a marker moves while the shutter is open: at the time t from the middle, counted in exposures from -0.5
// to 0.5, it stands at camera_from_marker * exp(t velocity + t^2 / 2 change). Body twists (v mm, w rad).
struct ExposedPose {
  geometry::RigidTransform camera_from_marker;
  geometry::Vector6d velocity = geometry::Vector6d::Zero(), change = geometry::Vector6d::Zero();
};

class ExposedCode {
 public:
  ExposedCode(const MarkerCode& code, double size_mm);

  // Sets the motion for the calls that follow, looked at in so many moments (1 to kMaxMoments).
  void move(const ExposedPose& pose, int moment_count);
  static constexpr int kMaxMoments = 12;

  struct Level {
    float level = 0;  // 0 dark, 1 bright; the margin of one cell around the square is bright
    // Derivatives: by the pose's body twist; by velocity and change along x and y and about the normal; by
    // the logarithm of the smear.
    Eigen::Matrix<float, 6, 1> by_pose = Eigen::Matrix<float, 6, 1>::Zero();
    Eigen::Vector3f by_velocity = Eigen::Vector3f::Zero(), by_change = Eigen::Vector3f::Zero();
    float by_smear = 0;
  };
  // Along this ray, smeared by sigmas in cells along the marker's x and y. A cell must be at least two and a
  // half sigma wide.
  [[nodiscard]] Level at(const Eigen::Vector3f& ray, float sigma_x, float sigma_y) const;

 private:
  struct Moment {
    Eigen::Matrix3f marker_from_camera;
    Eigen::Vector3f eye;  // the camera's centre in the marker frame
    float time;
  };
  struct Blurred {
    float level = 0, by_column = 0, by_row = 0, by_smear = 0;
  };
  [[nodiscard]] Blurred blurred(float column, float row, float sigma_x, float sigma_y) const;

  int cells_, width_;
  float cells_per_mm_;
  std::array<float, (kMaxCells + 4) * (kMaxCells + 4)> bright_{};
  std::array<Moment, kMaxMoments> moments_{};
  int moment_count_ = 0;
};

}  // namespace arthronaut::markers
