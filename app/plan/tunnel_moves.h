// The moves by which a surgeon places a tunnel, as plain functions: new tunnel out, nothing changed.
#pragma once

#include "app/plan/visible_bones.h"
#include "app/scene/scene_camera.h"
#include "planning/geometry/surface.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::plan {

// The entry there; the direction is kept.
[[nodiscard]] tunnels::Tunnel with_entry_at(const tunnels::Tunnel& tunnel, const Eigen::Vector3d& entry_mm);
// Slides the entry over the bone by so many mm to the right and up as the camera sees it.
[[nodiscard]] tunnels::Tunnel with_entry_slid(const tunnels::Tunnel& tunnel, const scene::SceneCamera& camera,
                                              const Eigen::Vector2d& right_up_mm,
                                              const geometry::Surface& bone);
// Aims so that the far end moves to the right and up as the camera sees it; the same tunnel where it points
// that way.
[[nodiscard]] tunnels::Tunnel turned(const tunnels::Tunnel& tunnel, const scene::SceneCamera& camera,
                                     const Eigen::Vector2d& right_up_deg);
// Aims at the point; the same tunnel where that is no further than 1 mm from its entry.
[[nodiscard]] tunnels::Tunnel aimed_at(const tunnels::Tunnel& tunnel, const Eigen::Vector3d& point_mm);
// Clamped to the range of tunnels/diameter_range.h.
[[nodiscard]] tunnels::Tunnel with_diameter(const tunnels::Tunnel& tunnel, double diameter_mm);
// The same tunnel for another graft: as wide as is usual of that one where it was as wide as is usual of its
// own; a width that somebody chose stays.
[[nodiscard]] tunnels::Tunnel for_graft(const tunnels::Tunnel& tunnel, norms::Bundle graft);

// Where the ray meets the plane through the point that faces the eye; nullopt where it does not. A point that
// goes on from there stays in that plane: dragged out and back it is where it was.
[[nodiscard]] std::optional<Eigen::Vector3d> moved_in_view(const scene::SceneCamera& camera,
                                                           const scene::SceneRay& ray,
                                                           const Eigen::Vector3d& point_mm);

}  // namespace arthronaut::plan
