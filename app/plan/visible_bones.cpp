#include "app/plan/visible_bones.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace arthronaut::plan {

namespace {

// Where along the ray the cut lets it in; 0 without one. Negative: never.
double start_of(const std::optional<scene::CutPlane>& cut, const scene::SceneRay& ray) {
  if (!cut || !cut->cuts_away(ray.origin_mm)) return 0;
  const double towards = -cut->normal.dot(ray.direction);
  if (towards < 1e-9) return -1;
  return cut->normal.dot(ray.origin_mm - cut->point_mm) / towards;
}

}  // namespace

std::optional<VisiblePoint> first_visible(const VisibleBones& bones, const scene::SceneRay& ray) {
  const double start = start_of(bones.cut, ray);
  if (start < 0) return std::nullopt;
  const Eigen::Vector3d from = ray.origin_mm + start * ray.direction;
  std::optional<VisiblePoint> first;
  double nearest = std::numeric_limits<double>::infinity();
  for (const VisibleBone& bone : bones.bones) {
    const auto hit = bone.surface->first_hit(from, ray.direction);
    if (!hit) continue;
    // Out of the bone before into it: the ray began inside, at the section.
    const bool is_section = start > 0 && hit->normal.dot(ray.direction) > 0;
    const double at = is_section ? 0 : hit->distance_mm;
    if (at >= nearest) continue;
    if (!is_section && bones.cut && bones.cut->cuts_away(hit->point_mm)) continue;
    nearest = at;
    first = VisiblePoint{bone.kind, is_section ? from : hit->point_mm,
                         is_section ? bones.cut->normal : hit->normal, is_section};
  }
  return first;
}

bool is_hidden(const VisibleBones& bones, const Eigen::Vector3d& eye_mm, const Eigen::Vector3d& point_mm) {
  constexpr double kBehind_mm = 1.0;
  const Eigen::Vector3d along = point_mm - eye_mm;
  const double distance = along.norm();
  if (distance < 1e-9) return false;
  if (bones.cut && bones.cut->cuts_away(point_mm)) return true;
  const auto first = first_visible(bones, {eye_mm, along / distance});
  return first && (first->point_mm - eye_mm).norm() < distance - kBehind_mm;
}

Eigen::Vector3d middle_behind(const geometry::Surface& bone, const VisiblePoint& seen,
                              const scene::SceneRay& ray) {
  constexpr double kOff_mm = 0.01;  // the surface that is seen is not met again
  const auto out = bone.first_hit(seen.point_mm + kOff_mm * ray.direction, ray.direction);
  return out ? Eigen::Vector3d((seen.point_mm + out->point_mm) / 2) : seen.point_mm;
}

std::optional<Eigen::Vector3d> dragged_over(const VisibleBones& bones, bones::BoneKind kind,
                                            const Eigen::Vector3d& point_mm, const scene::SceneRay& ray,
                                            bool through) {
  constexpr double kSteepest = 3, kSlack_mm = 3;
  std::optional<Eigen::Vector3d> to;
  if (through) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const VisibleBone& bone : bones.bones) {
      if (bone.kind != kind) continue;
      for (const geometry::RayHit& hit : bone.surface->all_hits(ray.origin_mm, ray.direction)) {
        const double away = (hit.point_mm - point_mm).norm();
        if (away >= nearest || (bones.cut && bones.cut->cuts_away(hit.point_mm))) continue;
        nearest = away;
        to = hit.point_mm;
      }
    }
  } else if (const auto first = first_visible(bones, ray);
             first && first->bone == kind && !first->is_section) {
    to = first->point_mm;
  }
  if (!to) return std::nullopt;
  const double across = (point_mm - ray.origin_mm).cross(ray.direction).norm();
  if ((*to - point_mm).norm() > kSteepest * across + kSlack_mm) return std::nullopt;
  return to;
}

}  // namespace arthronaut::plan
