// The eye of a 3D view as plain data, with the moves that mouse and keys make. Perspective; mm; LPS.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "app/scene/plan_picture.h"
#include "planning/bones/bone.h"
#include "planning/geometry/triangle_mesh.h"
#include "planning/landmarks/anatomical_axes.h"

namespace arthronaut::scene {

struct SceneCamera {
  Eigen::Vector3d position_mm{0, -300, 0};
  Eigen::Vector3d focus_mm{0, 0, 0};
  Eigen::Vector3d up{0, 0, 1};
  double view_angle_deg = 26;  // of the height
  bool operator==(const SceneCamera&) const = default;
};

struct SceneRay {
  Eigen::Vector3d origin_mm, direction;  // direction is unit
};

// Of the picture, in the world: unit, square to each other.
struct CameraAxes {
  Eigen::Vector3d right, up, ahead;
};
[[nodiscard]] CameraAxes axes_of(const SceneCamera& camera);

// Sees all of `bounds` from a named side of a knee that lies along the scanner's axes.
[[nodiscard]] SceneCamera look_from(ViewDirection view, bones::Side side, const geometry::Bounds& bounds,
                                    double aspect);
// The same along the bone's own axes. Notch looks straight laterally, onto the wall that is left when the
// medial condyle is cut away (notch_cut.h); the shaft stands up.
[[nodiscard]] SceneCamera look_from(ViewDirection view, const landmarks::AnatomicalAxes& axes,
                                    const geometry::Bounds& bounds, double aspect);
// Along `direction` (unit) at `focus`, `distance_mm` away; `up_hint` is made perpendicular.
[[nodiscard]] SceneCamera look_along(const Eigen::Vector3d& direction, const Eigen::Vector3d& focus_mm,
                                     double distance_mm, const Eigen::Vector3d& up_hint);

// About the focus, as a trackball: pixels of the mouse over the height of the view.
[[nodiscard]] SceneCamera orbited(const SceneCamera& camera, const Eigen::Vector2d& drag_px,
                                  double height_px);
[[nodiscard]] SceneCamera panned(const SceneCamera& camera, const Eigen::Vector2d& drag_px, double height_px);
[[nodiscard]] SceneCamera zoomed(const SceneCamera& camera, double steps);  // positive: nearer

// Pixel (0, 0) is the top-left corner of the view.
[[nodiscard]] SceneRay ray_through(const SceneCamera& camera, const Eigen::Vector2d& pixel,
                                   const Eigen::Vector2d& size_px);
// nullopt behind the eye.
[[nodiscard]] std::optional<Eigen::Vector2d> project(const SceneCamera& camera,
                                                     const Eigen::Vector3d& point_mm,
                                                     const Eigen::Vector2d& size_px);

}  // namespace arthronaut::scene
