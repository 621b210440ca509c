// What of the bones is seen in a 3D view, for the mouse: it takes hold of nothing that the eye does not see.
#pragma once

#include <optional>
#include <vector>

#include "app/scene/scene_camera.h"
#include "app/scene/scene_content.h"
#include "planning/geometry/surface.h"

namespace arthronaut::plan {

struct VisibleBone {
  bones::BoneKind kind = bones::BoneKind::Femur;
  const geometry::Surface* surface = nullptr;  // not null; closed, outward
};

struct VisibleBones {
  std::vector<VisibleBone> bones;
  std::optional<scene::CutPlane> cut = {};  // of all of them
};

struct VisiblePoint {
  bones::BoneKind bone = bones::BoneKind::Femur;
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::UnitZ();
  bool is_section = false;  // inside the bone, where it is cut open: no place for an entry
};

// What the ray meets first of what is seen; nullopt beside the bones. A section counts: it hides what is
// behind it.
[[nodiscard]] std::optional<VisiblePoint> first_visible(const VisibleBones& bones,
                                                        const scene::SceneRay& ray);

// Whether bone stands between the eye and a point by more than 1 mm.
[[nodiscard]] bool is_hidden(const VisibleBones& bones, const Eigen::Vector3d& eye_mm,
                             const Eigen::Vector3d& point_mm);

// Half way from a point that is seen to where the ray leaves that bone again: in the middle of a shaft or a
// condyle that is clicked on.
[[nodiscard]] Eigen::Vector3d middle_behind(const geometry::Surface& bone, const VisiblePoint& seen,
                                            const scene::SceneRay& ray);

// Where a point of a bone's surface goes that is dragged along a ray: to the bone under the mouse, as far as
// that is the same piece of surface. Behind an edge the surface goes on somewhere else: a step that goes more
// than three times as deep as it goes across (and 3 mm) is none that a hand meant, and the point stays.
// nullopt then, and beside the bone. through: the bone is drawn translucent; the surface nearest to the point
// is then taken, not the first.
[[nodiscard]] std::optional<Eigen::Vector3d> dragged_over(const VisibleBones& bones, bones::BoneKind kind,
                                                          const Eigen::Vector3d& point_mm,
                                                          const scene::SceneRay& ray, bool through);

}  // namespace arthronaut::plan
