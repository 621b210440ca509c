#include "planning/landmarks/insertion_grids.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "planning/geometry/rigid_transform.h"
#include "planning/landmarks/anatomical_axes.h"

namespace arthronaut::landmarks {

namespace {

using Eigen::Vector3d;

constexpr double kLeastSpan_mm = 5.0;
// A choice, between needles and the outermost vertices of clean bones: triangles at 62 degrees to the
// outline.
constexpr double kLeastSeen = 0.1;
constexpr double kRounding_mm = 1e-6;  // a vertex on the edge counts alike however the bone lies

std::optional<Vector3d> find(const Landmarks& landmarks, const char* name) {
  const auto found = landmarks.find(name);
  if (found == landmarks.end()) return std::nullopt;
  return found->second;
}

// Unit, from the medial to the lateral side: the direction of the true lateral view, in which the condyles
// are superposed.
std::optional<Vector3d> condylar_line(const Landmarks& landmarks) {
  for (const char* part : {"center", "posterior"}) {
    const auto lateral = find(landmarks, (std::string("lateral_condyle_") + part).c_str()),
               medial = find(landmarks, (std::string("medial_condyle_") + part).c_str());
    if (lateral && medial && (*lateral - *medial).norm() > kLeastSpan_mm)
      return Vector3d((*lateral - *medial).normalized());
  }
  return std::nullopt;
}

// How far along the unit `direction` from `origin` the vertices that count reach, needles left out: a vertex
// whose triangles all stand steeply to that direction, however far it is drawn out. On clean bones the
// outermost vertices have shares of 0.55 and more, also where Blumensaat's line cuts the outline off; a
// vertex drawn out by 6 mm has 0.03 at the most. -infinity where none counts.
template <typename Counts>
double reach_of(const geometry::TriangleMesh& mesh, const Counts& counts, const Vector3d& origin,
                const Vector3d& direction) {
  std::vector<double> seen(mesh.vertices_mm.size(), 0), whole(mesh.vertices_mm.size(), 0);
  for (const auto& t : mesh.triangles) {
    const auto corner = [&](std::size_t k) -> const Vector3d& {
      return mesh.vertices_mm[static_cast<std::size_t>(t[k])];
    };
    const Vector3d across = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    const double area = across.norm();
    if (!(area > 0)) continue;
    const double facing = std::abs(across.dot(direction)) / area;
    for (const std::int32_t k : t) {
      seen[static_cast<std::size_t>(k)] += facing * facing * facing * area;
      whole[static_cast<std::size_t>(k)] += area;
    }
  }
  double reach_mm = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < mesh.vertices_mm.size(); ++i)
    if (seen[i] > kLeastSeen * whole[i] && counts(mesh.vertices_mm[i]))
      reach_mm = std::max(reach_mm, (mesh.vertices_mm[i] - origin).dot(direction));
  return reach_mm;
}

struct Extents {
  double deep = std::numeric_limits<double>::infinity(), shallow = -deep, low = 0;
};

// From the three landmarks where all are there, else the outline of the lateral condyle below the line; the
// medial one and the shaft are other bones here.
Extents extents_of(const geometry::TriangleMesh& femur, const Landmarks& landmarks,
                   const FemoralQuadrant& quadrant, const Vector3d& front) {
  Extents extents;
  const auto deep = find(landmarks, "lateral_condyle_deep"),
             shallow = find(landmarks, "lateral_condyle_shallow"),
             low = find(landmarks, "lateral_condyle_low");
  if (deep && shallow && low) {
    return {(*deep - front).dot(quadrant.shallow), (*shallow - front).dot(quadrant.shallow),
            (*low - front).dot(quadrant.low)};
  }
  const auto is_condyle = [&](const Vector3d& vertex) {
    const Vector3d from_roof = vertex - front;
    return from_roof.dot(quadrant.lateral) >= kRounding_mm && from_roof.dot(quadrant.low) >= -kRounding_mm;
  };
  const auto reach = [&](const Vector3d& direction) { return reach_of(femur, is_condyle, front, direction); };
  extents.deep = -reach(-quadrant.shallow);
  extents.shallow = reach(quadrant.shallow);
  extents.low = reach(quadrant.low);
  return extents;
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
  const Vector3d scanner = side == bones::Side::Right ? Vector3d(-Vector3d::UnitX()) : Vector3d::UnitX();
  const Vector3d roof = *front - *back;
  const Vector3d along = roof.normalized();
  quadrant.lateral = condylar_line(landmarks).value_or((scanner - scanner.dot(along) * along).normalized());
  // The grid lies in the view's plane: Blumensaat's line as the view shows it.
  const Vector3d in_view = roof - roof.dot(quadrant.lateral) * quadrant.lateral;
  if (in_view.norm() < kLeastSpan_mm) return std::nullopt;
  quadrant.shallow = in_view.normalized();
  // Lateral, anterior, proximal are right-handed in a right knee; low is behind and below.
  quadrant.low = side == bones::Side::Right ? Vector3d(quadrant.shallow.cross(quadrant.lateral))
                                            : Vector3d(quadrant.lateral.cross(quadrant.shallow));
  const Extents extents = extents_of(femur, landmarks, quadrant, *front);
  if (!(extents.shallow - extents.deep > kLeastSpan_mm) || !(extents.low > kLeastSpan_mm))
    return std::nullopt;
  quadrant.corner_mm = *front + extents.deep * quadrant.shallow;
  quadrant.depth_mm = extents.shallow - extents.deep;
  quadrant.height_mm = extents.low;
  return quadrant;
}

TibialGrid::Percent TibialGrid::percent_of(const Vector3d& point_mm) const {
  return {.anterior_posterior = 100 * (point_mm - anterior_mm).dot(posterior) / depth_mm,
          .medial_lateral = 100 * (point_mm - medial_mm).dot(lateral) / width_mm};
}

Vector3d TibialGrid::point_at(const Percent& percent) const {
  const Vector3d corner = anterior_mm + (medial_mm - anterior_mm).dot(lateral) * lateral;
  return corner + 0.01 * percent.anterior_posterior * depth_mm * posterior +
         0.01 * percent.medial_lateral * width_mm * lateral;
}

std::optional<TibialGrid> tibial_grid(const Landmarks& landmarks) {
  const auto front = find(landmarks, "plateau_anterior"), back = find(landmarks, "plateau_posterior");
  const auto medial = find(landmarks, "plateau_medial"), lateral = find(landmarks, "plateau_lateral");
  if (!front || !back || !medial || !lateral) return std::nullopt;
  const Vector3d across = *lateral - *medial, along = *back - *front;
  if (across.norm() < kLeastSpan_mm) return std::nullopt;
  TibialGrid grid{
      .anterior_mm = *front, .medial_mm = *medial, .posterior = {}, .lateral = across.normalized()};
  const Vector3d straight = along - along.dot(grid.lateral) * grid.lateral;
  if (straight.norm() < kLeastSpan_mm) return std::nullopt;
  grid.posterior = straight.normalized();
  grid.up = grid.lateral.cross(grid.posterior);
  const Vector3d middle = (*front + *back + *medial + *lateral) / 4;
  double upwards = grid.up.z();
  if (const auto tuberosity = find(landmarks, "tuberosity")) upwards = -(*tuberosity - middle).dot(grid.up);
  for (const char* name : {"medial_eminence", "lateral_eminence"}) {
    if (const auto eminence = find(landmarks, name)) upwards = (*eminence - middle).dot(grid.up);
  }
  if (upwards < 0) grid.up = -grid.up;
  // The plateau falls backwards; shares are read along the long axis, else a tall eminence leans forward.
  const double slope = geometry::rad_from_deg(kPlateauSlope_deg);
  const Vector3d in_plane = grid.posterior;
  grid.posterior = std::cos(slope) * in_plane + std::sin(slope) * grid.up;
  grid.up = std::cos(slope) * grid.up - std::sin(slope) * in_plane;
  grid.depth_mm = along.dot(grid.posterior);
  grid.width_mm = across.norm();
  return grid;
}

bool has_grid(const geometry::TriangleMesh& mesh, bones::BoneKind bone, bones::Side side,
              const Landmarks& landmarks) {
  return bone == bones::BoneKind::Femur ? femoral_quadrant(mesh, landmarks, side).has_value()
                                        : tibial_grid(landmarks).has_value();
}

}  // namespace arthronaut::landmarks
