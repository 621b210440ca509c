// The bone around a tunnel as the axis sees it: the triangles near it in the tunnel's own frame, x and y
// across the axis, z the station along it, 0 at the entry. What tunnel_wall.h and tunnel_mouth.h are computed
// from.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "planning/geometry/surface.h"

namespace arthronaut::tunnels {

struct AxisTriangle {
  std::array<Eigen::Vector3d, 3> corners_mm;      // x, y, station
  Eigen::Vector3d normal;                         // unit, out of the bone, in the same frame
  std::array<Eigen::Vector3d, 3> smooth_normals;  // at the corners
  double nearest_mm = 0;                          // to the axis, less or equal to the true distance
};

class AxisView {
 public:
  // The triangles within reach_mm of the axis between two stations. direction: unit.
  AxisView(const geometry::Surface& bone, const Eigen::Vector3d& entry_mm, const Eigen::Vector3d& direction,
           double from_station_mm, double to_station_mm, double reach_mm);

  [[nodiscard]] const std::vector<AxisTriangle>& triangles() const { return triangles_; }
  [[nodiscard]] Eigen::Vector3d to_bone(const Eigen::Vector3d& in_view_mm) const {
    return entry_mm_ + in_view_mm.x() * across_ + in_view_mm.y() * further_across_ +
           in_view_mm.z() * direction_;
  }
  [[nodiscard]] Eigen::Vector3d direction_to_bone(const Eigen::Vector3d& in_view) const {
    return in_view.x() * across_ + in_view.y() * further_across_ + in_view.z() * direction_;
  }

 private:
  Eigen::Vector3d entry_mm_, direction_, across_, further_across_;
  std::vector<AxisTriangle> triangles_;
};

}  // namespace arthronaut::tunnels
