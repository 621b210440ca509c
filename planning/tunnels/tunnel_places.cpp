#include "planning/tunnels/tunnel_places.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::tunnels {

namespace {

using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double sine(double deg) { return std::sin(geometry::rad_from_deg(deg)); }
double cosine(double deg) { return std::cos(geometry::rad_from_deg(deg)); }

bool has_bone(const geometry::Surface& bone, const Vector3d& from, const Vector3d& direction,
              double within_mm) {
  const auto hit = bone.first_hit(from, direction);
  return hit && hit->distance_mm < within_mm && hit->normal.dot(direction) < 0;
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
  const Vector3d above = entry.at_mm + kAbove_mm * entry.normal;
  const double within_mm = 0.5 * extents.width_mm();
  if (std::abs(entry.normal.dot(axes.anterior)) > cosine(35) ||
      !has_bone(femur, above, axes.lateral, within_mm) || !has_bone(femur, above, -axes.lateral, within_mm))
    return FemoralEntry::OutsideNotch;
  const double faces_laterally = entry.normal.dot(axes.lateral);
  if (faces_laterally < -sine(25)) return FemoralEntry::LateralWall;
  return faces_laterally > sine(25) ? FemoralEntry::MedialWall : FemoralEntry::Roof;
}

FemoralExit femoral_exit(const geometry::Surface& femur, const TunnelGeometry& tunnel,
                         const landmarks::AnatomicalAxes& axes, const BoneExtents& extents) {
  const Vector3d& faces = tunnel.exit.normal;
  if ((tunnel.exit_mm - tunnel.entry_on_surface_mm).dot(axes.lateral) <= 0 ||
      faces.dot(axes.lateral) < -sine(45))
    return FemoralExit::MedialSide;
  if (bone_along(femur, tunnel.exit_mm + kAbove_mm * faces, axes.lateral) > 0.1 * extents.width_mm())
    return FemoralExit::IntoNotch;
  const double height = tunnel.exit_mm.dot(axes.proximal) - extents.lowest_mm;
  const bool is_low = height < 0.5 * extents.width_mm();
  if (is_low && (faces.dot(axes.proximal) < -sine(30) || std::abs(faces.dot(axes.lateral)) < sine(45)))
    return FemoralExit::JointSurface;
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
  double hindmost = kInfinity;
  for (const Vector3d& v : femur.vertices_mm) {
    const Vector3d away = v - exit_mm;
    if (std::abs(away.dot(axes.proximal)) > kBand_mm) continue;
    const double lateral = away.dot(axes.lateral);
    if (lateral > kLateral_mm || lateral < -kMedial_mm) continue;
    hindmost = std::min(hindmost, away.dot(axes.anterior));
  }
  if (!std::isfinite(hindmost)) return std::nullopt;
  return -hindmost;
}

}  // namespace arthronaut::tunnels
