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
// Aims at where the ray meets the plane through `handle_mm` that faces the camera.
[[nodiscard]] tunnels::Tunnel aimed(const tunnels::Tunnel& tunnel, const scene::SceneCamera& camera,
                                    const scene::SceneRay& ray, const Eigen::Vector3d& handle_mm);
// Clamped to the range of tunnels/diameter_range.h.
[[nodiscard]] tunnels::Tunnel with_diameter(const tunnels::Tunnel& tunnel, double diameter_mm);

}  // namespace arthronaut::plan
