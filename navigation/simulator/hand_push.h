// What a push is worth and which way it turns what is held. Inner header of the simulator.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace arthronaut::simulator {

// To -1 to 1; what is no number pushes nothing.
inline double cut(double value) { return std::isfinite(value) ? std::clamp(value, -1.0, 1.0) : 0.0; }

// All axes together push no more than one.
inline Eigen::Vector3d cut_all(const Eigen::Vector3d& value) {
  const Eigen::Vector3d all = value.unaryExpr([](double v) { return cut(v); });
  return all.norm() > 1 ? Eigen::Vector3d(all.normalized()) : all;
}

// The turn by which the end of a unit direction is pushed by `way_rad`, seen from its other end.
inline Eigen::AngleAxisd turn_of_push(const Eigen::Vector3d& direction, const Eigen::Vector3d& way_rad) {
  const Eigen::Vector3d turn = direction.cross(way_rad);
  const double angle = turn.norm();
  if (angle < 1e-12) return Eigen::AngleAxisd::Identity();
  return Eigen::AngleAxisd(angle, turn / angle);
}

}  // namespace arthronaut::simulator
