// The planes in which images are looked at along a tunnel: two that hold its axis, square to each other, and
// one across it.
#pragma once

#include <Eigen/Core>
#include <string>

namespace arthronaut::plan {

// How a plane lies in its picture: unit, at right angles.
struct PictureAxes {
  Eigen::Vector3d right = Eigen::Vector3d::UnitX(), down = Eigen::Vector3d::UnitY();
  [[nodiscard]] Eigen::Vector3d normal() const { return right.cross(down); }  // away from the eye
};

struct TunnelPlanes {
  PictureAxes across, along, square;  // square: along it, too, turned by 90 degrees
};

// What is looked along.
struct TunnelAxis {
  std::string name;                                      // "femur AM"
  Eigen::Vector3d entry_mm = Eigen::Vector3d::Zero();    // LPS
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  // as drilled, unit
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  // in the bone: up in the pictures, as far as it can be
  bool operator==(const TunnelAxis&) const = default;
};

// At 0 the first holds as much of `up` as one along the axis can; it turns about the axis.
[[nodiscard]] TunnelPlanes tunnel_planes(const TunnelAxis& axis, double turned_rad);
// How far they are turned where the first along the axis holds the point: in (-pi/2, pi/2]. Of a point of
// the axis, which each of them holds: 0.
[[nodiscard]] double turned_to_hold_rad(const TunnelAxis& axis, const Eigen::Vector3d& point_mm);
// The nearest point of the axis.
[[nodiscard]] Eigen::Vector3d on_axis(const TunnelAxis& axis, const Eigen::Vector3d& point_mm);

}  // namespace arthronaut::plan
