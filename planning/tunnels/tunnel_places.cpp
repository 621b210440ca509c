#include "planning/tunnels/tunnel_places.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::tunnels {

namespace {

using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double sine(double deg) { return std::sin(geometry::rad_from_deg(deg)); }
double cosine(double deg) { return std::cos(geometry::rad_from_deg(deg)); }

// How far off bone begins that way; nullopt where none does within so much.
std::optional<double> to_bone_mm(const geometry::Surface& bone, const Vector3d& from,
                                 const Vector3d& direction, double within_mm) {
  const auto hit = bone.first_hit(from, direction, within_mm);
  if (!hit || hit->distance_mm >= within_mm || hit->normal.dot(direction) >= 0) return std::nullopt;
  return hit->distance_mm;
}

// Of a place over the surface that faces either way: bone on both sides of it, and none behind the middle of
// the gap between them, as there is behind the groove.
bool is_in_notch(const geometry::Surface& femur, const Vector3d& above, bool faces_medially,
                 const landmarks::AnatomicalAxes& axes, const BoneExtents& extents) {
  const double within_mm = 0.5 * extents.width_mm();
  // The side that it faces first: on the outer face of a condyle nothing is there.
  const Vector3d faced = faces_medially ? Vector3d(-axes.lateral) : axes.lateral;
  const auto across_mm = to_bone_mm(femur, above, faced, within_mm);
  if (!across_mm) return false;
  const auto beneath_mm = to_bone_mm(femur, above, -faced, within_mm);
  if (!beneath_mm) return false;
  const Vector3d middle = above + 0.5 * (*across_mm - *beneath_mm) * faced;
  return !to_bone_mm(femur, middle, -axes.anterior, extents.anterior_mm - extents.posterior_mm);
}

using Polygon = std::vector<Vector3d>;

// What of a convex polygon lies on the side of sign * coordinate <= sign * limit.
Polygon cut_off(const Polygon& polygon, int axis, double limit, int sign) {
  Polygon left;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double beyond_a = sign * (a[axis] - limit), beyond_b = sign * (b[axis] - limit);
    if (beyond_a <= 0) left.push_back(a);
    if ((beyond_a < 0 && beyond_b > 0) || (beyond_a > 0 && beyond_b < 0))
      left.push_back(a + beyond_a / (beyond_a - beyond_b) * (b - a));
  }
  return left;
}

// Where a place is looked at from, over the surface.
constexpr double kAbove_mm = 0.5;

// How much bone a line goes through.
double bone_along(const geometry::Surface& bone, const Vector3d& from, const Vector3d& direction) {
  double inside_mm = 0, entered_mm = -1;
  for (const geometry::RayHit& hit : bone.all_hits(from, direction)) {
    if (hit.normal.dot(direction) < 0)
      entered_mm = hit.distance_mm;
    else if (entered_mm >= 0)
      inside_mm += hit.distance_mm - std::exchange(entered_mm, -1);
  }
  return inside_mm;
}

}  // namespace

BoneExtents bone_extents(const geometry::TriangleMesh& mesh, bones::BoneKind bone,
                         const landmarks::AnatomicalAxes& axes) {
  constexpr double kJointEnd_mm = 40;
  BoneExtents extents;
  if (mesh.vertices_mm.empty()) return extents;
  extents.lowest_mm = extents.medial_mm = extents.posterior_mm = kInfinity;
  extents.highest_mm = extents.lateral_mm = extents.anterior_mm = -kInfinity;
  for (const Vector3d& v : mesh.vertices_mm) {
    extents.lowest_mm = std::min(extents.lowest_mm, v.dot(axes.proximal));
    extents.highest_mm = std::max(extents.highest_mm, v.dot(axes.proximal));
  }
  for (const Vector3d& v : mesh.vertices_mm) {
    const double height = v.dot(axes.proximal);
    const double from_end =
        bone == bones::BoneKind::Femur ? height - extents.lowest_mm : extents.highest_mm - height;
    if (from_end > kJointEnd_mm) continue;
    extents.medial_mm = std::min(extents.medial_mm, v.dot(axes.lateral));
    extents.lateral_mm = std::max(extents.lateral_mm, v.dot(axes.lateral));
    extents.posterior_mm = std::min(extents.posterior_mm, v.dot(axes.anterior));
    extents.anterior_mm = std::max(extents.anterior_mm, v.dot(axes.anterior));
  }
  return extents;
}

FemoralEntry femoral_entry(const geometry::Surface& femur, const TunnelMouth& entry,
                           const landmarks::AnatomicalAxes& axes, const BoneExtents& extents) {
  const double faces_laterally = entry.normal.dot(axes.lateral);
  if (std::abs(entry.normal.dot(axes.anterior)) > cosine(35) ||
      !is_in_notch(femur, entry.at_mm + kAbove_mm * entry.normal, faces_laterally < 0, axes, extents))
    return FemoralEntry::OutsideNotch;
  if (faces_laterally < -sine(kNotchWall_deg)) return FemoralEntry::LateralWall;
  return faces_laterally > sine(kNotchWall_deg) ? FemoralEntry::MedialWall : FemoralEntry::Roof;
}

FemoralExit femoral_exit(const geometry::Surface& femur, const TunnelGeometry& tunnel,
                         const landmarks::AnatomicalAxes& axes, const BoneExtents& extents) {
  const Vector3d& faces = tunnel.exit.normal;
  if ((tunnel.exit_mm - tunnel.entry_on_surface_mm).dot(axes.lateral) <= 0 ||
      faces.dot(axes.lateral) < -sine(45))
    return FemoralExit::MedialSide;
  const double height = tunnel.exit_mm.dot(axes.proximal) - extents.lowest_mm;
  if (faces.dot(axes.proximal) > sine(60) && height > 0.5 * (extents.highest_mm - extents.lowest_mm))
    return FemoralExit::Above;
  if (bone_along(femur, tunnel.exit_mm + kAbove_mm * faces, axes.lateral) > 0.1 * extents.width_mm())
    return FemoralExit::IntoNotch;
  const bool is_low = height < 0.5 * extents.width_mm();
  if (is_low && (faces.dot(axes.proximal) < -sine(30) || std::abs(faces.dot(axes.lateral)) < sine(45)))
    return FemoralExit::JointSurface;
  const double forwards = faces.dot(axes.anterior);
  if (std::abs(forwards) > faces.dot(axes.lateral))
    return forwards > 0 ? FemoralExit::Front : FemoralExit::Back;
  return FemoralExit::LateralCortex;
}

TibialEntry tibial_entry(const TunnelMouth& entry, const landmarks::AnatomicalAxes& axes,
                         const BoneExtents& extents) {
  const double below_mm = extents.highest_mm - entry.at_mm.dot(axes.proximal), width = extents.width_mm();
  if (below_mm > 0.2 * width || entry.normal.dot(axes.proximal) < sine(30)) return TibialEntry::BesidePlateau;
  const double share = (entry.at_mm.dot(axes.lateral) - extents.medial_mm) / std::max(width, 1e-9);
  constexpr double kFrom = 1.0 / 3 - 0.1, kTo = 2.0 / 3 + 0.1;
  if (share < kFrom) return TibialEntry::MedialPlateau;
  return share > kTo ? TibialEntry::LateralPlateau : TibialEntry::BetweenCondyles;
}

TibialExit tibial_exit(const TunnelGeometry& tunnel, const landmarks::AnatomicalAxes& axes) {
  constexpr double kOfJoint_mm = 10;
  const Vector3d& faces = tunnel.exit.normal;
  if ((tunnel.entry_on_surface_mm - tunnel.exit_mm).dot(axes.proximal) < kOfJoint_mm)
    return TibialExit::JointSurface;
  if (faces.dot(axes.proximal) < -sine(60)) return TibialExit::Below;
  if (faces.dot(axes.anterior) < -sine(30)) return TibialExit::PosteriorFace;
  return faces.dot(axes.lateral) > sine(30) ? TibialExit::LateralFace : TibialExit::AnteromedialFace;
}

std::optional<double> to_posterior_cortex_mm(const geometry::TriangleMesh& femur, const Vector3d& exit_mm,
                                             const landmarks::AnatomicalAxes& axes) {
  constexpr double kBand_mm = 1.5, kLateral_mm = 5, kMedial_mm = 15;
  Eigen::Matrix3d rows;
  rows << axes.lateral.transpose(), axes.proximal.transpose(), axes.anterior.transpose();
  const Eigen::Array2d least(-kMedial_mm, -kBand_mm), greatest(kLateral_mm, kBand_mm);
  double hindmost = kInfinity;
  for (const auto& triangle : femur.triangles) {
    Eigen::Matrix3d away;  // a corner a column: lateral, proximal, anterior of the exit
    for (int i = 0; i < 3; ++i)
      away.col(i) =
          rows *
          (femur.vertices_mm[static_cast<std::size_t>(triangle[static_cast<std::size_t>(i)])] - exit_mm);
    if (away.row(2).minCoeff() > hindmost) continue;
    const Eigen::Array2d from = away.topRows<2>().rowwise().minCoeff(),
                         to = away.topRows<2>().rowwise().maxCoeff();
    if ((from > greatest).any() || (to < least).any()) continue;
    Polygon part;
    for (int i = 0; i < 3; ++i) part.push_back(away.col(i));
    for (int axis = 0; axis < 2; ++axis) {
      part = cut_off(part, axis, greatest[axis], 1);
      part = cut_off(part, axis, least[axis], -1);
    }
    for (const Vector3d& corner : part) hindmost = std::min(hindmost, corner.z());
  }
  if (!std::isfinite(hindmost)) return std::nullopt;
  return -hindmost;
}

}  // namespace arthronaut::tunnels
