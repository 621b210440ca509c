#include "planning/landmarks/insertion_grids.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace arthronaut::landmarks {

namespace {

using Eigen::Vector3d;

constexpr double kLeastSpan_mm = 5.0;

std::optional<Vector3d> find(const Landmarks& landmarks, const char* name) {
  const auto found = landmarks.find(name);
  if (found == landmarks.end()) return std::nullopt;
  return found->second;
}

// Unit, from the medial to the lateral side, at right angles to `across`.
Vector3d lateral_of_femur(const Landmarks& landmarks, bones::Side side, const Vector3d& across) {
  const auto lateral = find(landmarks, "lateral_condyle_posterior"),
             medial = find(landmarks, "medial_condyle_posterior");
  Vector3d axis = side == bones::Side::Right ? Vector3d(-1, 0, 0) : Vector3d(1, 0, 0);
  if (lateral && medial && (*lateral - *medial).norm() > kLeastSpan_mm) axis = *lateral - *medial;
  return (axis - axis.dot(across) * across).normalized();
}

}  // namespace

FemoralQuadrant::Percent FemoralQuadrant::percent_of(const Vector3d& point_mm) const {
  const Vector3d from_corner = point_mm - corner_mm;
  return {.deep_shallow = 100 * from_corner.dot(shallow) / depth_mm,
          .high_low = 100 * from_corner.dot(low) / height_mm};
}

Vector3d FemoralQuadrant::point_at(const Percent& percent) const {
  return corner_mm + 0.01 * percent.deep_shallow * depth_mm * shallow +
         0.01 * percent.high_low * height_mm * low;
}

std::optional<FemoralQuadrant> femoral_quadrant(const geometry::TriangleMesh& femur,
                                                const Landmarks& landmarks, bones::Side side) {
  const auto front = find(landmarks, "blumensaat_anterior"), back = find(landmarks, "blumensaat_posterior");
  if (!front || !back || (*front - *back).norm() < kLeastSpan_mm) return std::nullopt;
  FemoralQuadrant quadrant;
  quadrant.shallow = (*front - *back).normalized();
  const Vector3d lateral = lateral_of_femur(landmarks, side, quadrant.shallow);
  // Lateral, shallow, low: of the two normals of Blumensaat's line in the view, the one that points to the
  // joint.
  quadrant.low = lateral.cross(quadrant.shallow).normalized();
  if (quadrant.low.z() > 0) quadrant.low = -quadrant.low;

  double deep = std::numeric_limits<double>::infinity(), shallow = -deep, low = 0;
  for (const Vector3d& vertex : femur.vertices_mm) {
    const Vector3d from_roof = vertex - *front;
    // The outline of the lateral condyle below the line; the medial one and the shaft are other bones here.
    if (from_roof.dot(lateral) <= 0 || from_roof.dot(quadrant.low) < 0) continue;
    deep = std::min(deep, from_roof.dot(quadrant.shallow));
    shallow = std::max(shallow, from_roof.dot(quadrant.shallow));
    low = std::max(low, from_roof.dot(quadrant.low));
  }
  if (shallow - deep < kLeastSpan_mm || low < kLeastSpan_mm) return std::nullopt;
  quadrant.corner_mm = *front + deep * quadrant.shallow;
  quadrant.depth_mm = shallow - deep;
  quadrant.height_mm = low;
  return quadrant;
}

TibialGrid::Percent TibialGrid::percent_of(const Vector3d& point_mm) const {
  return {.anterior_posterior = 100 * (point_mm - anterior_mm).dot(posterior) / depth_mm,
          .medial_lateral = 100 * (point_mm - medial_mm).dot(lateral) / width_mm};
}

std::optional<TibialGrid> tibial_grid(const Landmarks& landmarks) {
  const auto front = find(landmarks, "plateau_anterior"), back = find(landmarks, "plateau_posterior");
  const auto medial = find(landmarks, "plateau_medial"), lateral = find(landmarks, "plateau_lateral");
  if (!front || !back || !medial || !lateral) return std::nullopt;
  // Both shares are read on a view from above: heights do not enter.
  Vector3d across = *lateral - *medial, along = *back - *front;
  across.z() = along.z() = 0;
  if (across.norm() < kLeastSpan_mm || along.norm() < kLeastSpan_mm) return std::nullopt;
  TibialGrid grid{
      .anterior_mm = *front, .medial_mm = *medial, .posterior = {}, .lateral = across.normalized()};
  grid.posterior = (along - along.dot(grid.lateral) * grid.lateral).normalized();
  grid.depth_mm = along.dot(grid.posterior);
  grid.width_mm = across.norm();
  if (grid.depth_mm < kLeastSpan_mm) return std::nullopt;
  return grid;
}

}  // namespace arthronaut::landmarks
