#include "planning/tunnels/isometry_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "planning/geometry/error.h"
#include "planning/geometry/rigid_transform.h"
#include "planning/graft/graft_course.h"
#include "planning/tunnels/place_checks.h"

namespace arthronaut::tunnels {

namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;  // a place and the change there

constexpr int kChange = 3;
using Polygon = std::vector<Vector4d>;

// What of a convex polygon has a change on that side of the limit: sign 1 above it, -1 below.
Polygon beyond(const Polygon& polygon, double limit_mm, int sign) {
  Polygon left;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector4d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double in_a = sign * (a[kChange] - limit_mm), in_b = sign * (b[kChange] - limit_mm);
    if (in_a >= 0) left.push_back(a);
    // From the corner within to the one beyond, so that two triangles cut their edge in the same place.
    if (in_a > 0 && in_b < 0) left.push_back(a + in_a / (in_a - in_b) * (b - a));
    if (in_a < 0 && in_b > 0) left.push_back(b + in_b / (in_b - in_a) * (a - b));
  }
  return left;
}

void append_fan(geometry::TriangleMesh& mesh, const Polygon& polygon) {
  const auto first = static_cast<std::int32_t>(mesh.vertices_mm.size());
  for (const Vector4d& corner : polygon) mesh.vertices_mm.push_back(corner.head<3>());
  for (std::int32_t i = 1; i + 1 < static_cast<std::int32_t>(polygon.size()); ++i)
    mesh.triangles.push_back({first, first + i, first + i + 1});
}

// Splits edges at their middles until none is longer than kEdge_mm; one that two triangles share in the same
// place for both.
class Refined {
 public:
  explicit Refined(geometry::TriangleMesh& mesh) : mesh_(mesh) {
    for (const auto& triangle : std::exchange(mesh_.triangles, {})) split(triangle);
  }

 private:
  // On a wall the change has a valley with a sharp floor, where what is longest goes from extension to
  // flexion: with edges of 3 mm it is 0.8 mm off as linear between.
  static constexpr double kEdge_mm = 0.5;

  [[nodiscard]] double length_mm(std::int32_t a, std::int32_t b) const {
    return (mesh_.vertices_mm[static_cast<std::size_t>(a)] - mesh_.vertices_mm[static_cast<std::size_t>(b)])
        .norm();
  }
  std::int32_t middle(std::int32_t a, std::int32_t b) {
    const auto next = static_cast<std::int32_t>(mesh_.vertices_mm.size());
    const auto [known, is_new] = middles_.try_emplace(std::minmax(a, b), next);
    if (is_new)
      mesh_.vertices_mm.push_back(0.5 * (mesh_.vertices_mm[static_cast<std::size_t>(a)] +
                                         mesh_.vertices_mm[static_cast<std::size_t>(b)]));
    return known->second;
  }
  void split(const std::array<std::int32_t, 3>& triangle) {
    std::size_t longest = 0;
    for (std::size_t i = 1; i < 3; ++i)
      if (length_mm(triangle[i], triangle[(i + 1) % 3]) >
          length_mm(triangle[longest], triangle[(longest + 1) % 3]))
        longest = i;
    const std::int32_t a = triangle[longest], b = triangle[(longest + 1) % 3],
                       c = triangle[(longest + 2) % 3];
    if (length_mm(a, b) <= kEdge_mm) {
      mesh_.triangles.push_back(triangle);
      return;
    }
    const std::int32_t m = middle(a, b);
    split({a, m, c});
    split({m, b, c});
  }

  geometry::TriangleMesh& mesh_;
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles_;
};

// Of a mesh the largest piece whose triangles share corners, with its own corners alone.
geometry::TriangleMesh largest_piece(const geometry::TriangleMesh& mesh) {
  std::vector<std::int32_t> towards(mesh.vertices_mm.size());  // the corner that stands for its piece
  std::iota(towards.begin(), towards.end(), 0);
  const auto piece_of = [&](std::int32_t corner) {
    while (towards[static_cast<std::size_t>(corner)] != corner) {
      std::int32_t& next = towards[static_cast<std::size_t>(corner)];
      next = towards[static_cast<std::size_t>(next)];
      corner = next;
    }
    return corner;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    towards[static_cast<std::size_t>(piece_of(a))] = piece_of(b);
    towards[static_cast<std::size_t>(piece_of(b))] = piece_of(c);
  }
  struct Piece {
    geometry::TriangleMesh mesh;
    std::map<std::int32_t, std::int32_t> corner_of;
  };
  std::map<std::int32_t, Piece> pieces;
  for (const auto& triangle : mesh.triangles) {
    Piece& piece = pieces[piece_of(triangle.front())];
    auto& corners = piece.mesh.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [known, is_new] =
          piece.corner_of.try_emplace(triangle[k], static_cast<std::int32_t>(piece.mesh.vertices_mm.size()));
      if (is_new) piece.mesh.vertices_mm.push_back(mesh.vertices_mm[static_cast<std::size_t>(triangle[k])]);
      corners[k] = known->second;
    }
  }
  geometry::TriangleMesh largest;
  double largest_mm2 = -1;
  for (auto& [corner, piece] : pieces) {
    const double area_mm2 = geometry::surface_area_mm2(piece.mesh);
    if (area_mm2 > largest_mm2) largest_mm2 = area_mm2, largest = std::move(piece.mesh);
  }
  return largest;
}

// A corner on the line between two bands that lies nearer to the middle than the place known.
void take_line_place(IsometryBand& band, const Polygon& polygon, const Vector3d& middle_mm) {
  for (const Vector4d& corner : polygon) {
    const Vector3d at = corner.head<3>();
    if (std::abs(corner[kChange] - band.from_mm) > 1e-9) continue;
    if (!band.line_at_mm || (at - middle_mm).norm() < (*band.line_at_mm - middle_mm).norm())
      band.line_at_mm = at;
  }
}

}  // namespace

std::string to_text(const LengthChange& change) {
  return number_text(change.change_mm, "mm") + " from 0 to 120 deg, longest at " +
         number_text(change.longest_at_deg, "deg");
}

LengthChange length_change(const Vector3d& femoral_opening_mm, const Vector3d& tibial_opening_mm,
                           const graft::FlexionAxis& axis) {
  const graft::GraftCourse course = graft::graft_course({femoral_opening_mm}, {tibial_opening_mm}, axis);
  return {course.change_mm(), course.longest_at_deg};
}

bool is_lateral_wall(const geometry::Surface& femur, const Vector3d& at_mm, const Vector3d& normal,
                     const landmarks::AnatomicalAxes& axes, const BoneExtents& extents) {
  if (normal.dot(axes.lateral) >= -std::sin(geometry::rad_from_deg(kNotchWall_deg))) return false;  // no ray
  TunnelMouth place;
  place.at_mm = at_mm;
  place.normal = normal;
  return femoral_entry(femur, place, axes, extents) == FemoralEntry::LateralWall;
}

geometry::TriangleMesh lateral_wall(const geometry::Surface& femur, const landmarks::AnatomicalAxes& axes,
                                    const BoneExtents& extents, const std::function<bool()>& is_cancelled) {
  const geometry::TriangleMesh& mesh = femur.mesh();
  const std::vector<Vector3d> normals = geometry::vertex_normals(mesh);
  geometry::TriangleMesh wall;
  std::vector<std::int32_t> in_wall(mesh.vertices_mm.size(), -1);
  for (std::size_t i = 0; i < mesh.vertices_mm.size(); ++i) {
    if (is_cancelled && is_cancelled()) return {};
    if (!is_lateral_wall(femur, mesh.vertices_mm[i], normals[i], axes, extents)) continue;
    in_wall[i] = static_cast<std::int32_t>(wall.vertices_mm.size());
    wall.vertices_mm.push_back(mesh.vertices_mm[i]);
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::array<std::int32_t, 3> corners{in_wall[static_cast<std::size_t>(a)],
                                              in_wall[static_cast<std::size_t>(b)],
                                              in_wall[static_cast<std::size_t>(c)]};
    if (std::ranges::min(corners) >= 0) wall.triangles.push_back(corners);
  }
  wall = largest_piece(wall);
  const Refined refined(wall);
  return wall;
}

IsometryMap isometry_map(const geometry::TriangleMesh& wall, const Vector3d& tibial_opening_mm,
                         const graft::FlexionAxis& axis, const IsometrySteps& steps) {
  const double step_mm = steps.step_mm;
  if (!(step_mm > 0 && steps.one_from_mm > 0))
    throw InvalidInput("isometry map: step_mm and one_from_mm must be positive");
  IsometryMap map;
  if (wall.empty()) return map;
  std::vector<Vector4d> corners(wall.vertices_mm.size());
  Vector3d middle_mm = Vector3d::Zero();
  map.least_mm = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector3d& at = wall.vertices_mm[i];
    const double change_mm = length_change(at, tibial_opening_mm, axis).change_mm;
    corners[i] << at, change_mm;
    middle_mm += at / static_cast<double>(corners.size());
    map.least_mm = std::min(map.least_mm, change_mm);
    map.greatest_mm = std::max(map.greatest_mm, change_mm);
  }
  const double last = std::round(steps.one_from_mm / step_mm);
  const double first = std::min(std::floor(map.least_mm / step_mm), last);
  const auto count =
      static_cast<std::size_t>(std::min(std::floor(map.greatest_mm / step_mm), last) - first) + 1;
  map.bands.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    map.bands[i].from_mm = step_mm * (first + static_cast<double>(i));
    map.bands[i].to_mm = step_mm * (first + static_cast<double>(i + 1));
  }
  if (first + static_cast<double>(count - 1) == last)
    map.bands.back().to_mm = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : wall.triangles) {
    const Polygon triangle{corners[static_cast<std::size_t>(a)], corners[static_cast<std::size_t>(b)],
                           corners[static_cast<std::size_t>(c)]};
    for (IsometryBand& band : map.bands) {
      const Polygon above = beyond(triangle, band.from_mm, 1);
      if (above.size() < 3) break;  // the bands above have nothing of it, either
      const Polygon within = beyond(above, band.to_mm, -1);
      if (within.size() < 3) continue;
      append_fan(band.mesh, within);
      if (&band != &map.bands.front()) take_line_place(band, within, middle_mm);
    }
  }
  constexpr double kNothing_mm2 = 1e-6;  // a corner that lies on a line
  std::erase_if(map.bands, [](const IsometryBand& band) {
    return geometry::surface_area_mm2(band.mesh) < kNothing_mm2;
  });
  return map;
}

}  // namespace arthronaut::tunnels
