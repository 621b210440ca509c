// What a registration has in common with all that is measured later: it was drawn with the same probe,
// through the same camera. A tip that is off by 0.4 mm moves every touched point, and the bone with them; no
// residual shows it, and no covariance made of residuals holds it. So the points' own share in these errors
// is summed up while they are drawn, and with it how far the registration followed them.
#pragma once

#include <Eigen/Core>

#include "planning/geometry/tracked_pose.h"

namespace arthronaut::guidance {

// One place of the tip, and how it moves with the errors that it shares with all others; in the world
// marker's frame, mm.
struct TipSensitivity {
  Eigen::Vector3d tip_mm = Eigen::Vector3d::Zero();
  Eigen::Matrix<double, 3, 6> per_camera_error = Eigen::Matrix<double, 3, 6>::Zero();
  Eigen::Matrix3d per_tip_error = Eigen::Matrix3d::Identity();  // the probe's rotation
};

// How the registration follows: twists about the world marker's frame, on the left of marker_from_bone.
struct RegistrationBias {
  Eigen::Matrix<double, 6, 6> per_camera_error = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 3> per_tip_error = Eigen::Matrix<double, 6, 3>::Zero();
};

// Sums over the points of a registration, of fixed size whatever was drawn; those of several strokes add up.
class BiasSums {
 public:
  // weight: as the point counts in the registration, the millimetre of stroke that it stands for.
  void add(const TipSensitivity& point, double weight = 1);
  BiasSums& operator+=(const BiasSums& other);
  [[nodiscard]] bool empty() const { return weight_ <= 0; }
  // The rigid motion that follows the points' common displacement, by least squares over the points: their
  // normals are left out, which is exact for what moves them alike. Without points, a tip that moves the bone
  // by as much and a camera that does not: what is taken where nobody knows how a registration was drawn.
  [[nodiscard]] RegistrationBias bias() const;

 private:
  geometry::Matrix6d normal_ = geometry::Matrix6d::Zero();
  Eigen::Matrix<double, 6, 6> camera_ = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 3> tip_ = Eigen::Matrix<double, 6, 3>::Zero();
  double weight_ = 0;
};

}  // namespace arthronaut::guidance
