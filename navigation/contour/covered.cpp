#include "navigation/contour/covered.h"

#include <algorithm>

namespace arthronaut::contour {

namespace {

constexpr double kHeadShare = 0.95;   // a round head's radius over the black square's side
constexpr double kPlateShare = 0.55;  // a plate, as nine discs: their distance and radius over that side
constexpr double kRod_mm = 3.4, kHook_mm = 1.6;
constexpr double kHandle_mm = 60, kPiece_mm = 6;
constexpr double kNearest_mm = 4;

}  // namespace

void CoveredPlaces::add_disc(const camera::CameraModel& camera, const Eigen::Vector3d& in_camera_mm,
                             double radius_mm) {
  add_rod(camera, {}, in_camera_mm, in_camera_mm, radius_mm);
}

// In pieces, each as wide as its nearer end: what comes towards the lens grows wide.
void CoveredPlaces::add_rod(const camera::CameraModel& camera,
                            const geometry::RigidTransform& camera_from_tool, const Eigen::Vector3d& from_mm,
                            const Eigen::Vector3d& to_mm, double radius_mm) {
  const double length_mm = (to_mm - from_mm).norm();
  const int pieces = std::max(1, static_cast<int>(length_mm / kPiece_mm));
  for (int i = 0; i < pieces && count_ < places_.size(); ++i) {
    const Eigen::Vector3d a = camera_from_tool * (from_mm + (to_mm - from_mm) * (1.0 * i / pieces)),
                          b = camera_from_tool * (from_mm + (to_mm - from_mm) * (1.0 * (i + 1) / pieces));
    if (a.z() < kNearest_mm || b.z() < kNearest_mm) return;
    const auto a_px = camera.project(a), b_px = camera.project(b);
    if (!a_px || !b_px) return;
    const double radius_px =
        radius_mm * camera.central_focal_px() / std::max(std::min(a.norm(), b.norm()), 1.0);
    places_[count_++] = {*a_px, *b_px, radius_px};
  }
}

void CoveredPlaces::add_world_marker(const camera::CameraModel& camera,
                                     const geometry::RigidTransform& camera_from_world,
                                     const tools::WorldMarker& marker) {
  if (marker.markers.empty()) add_disc(camera, camera_from_world.translation_mm, kHeadShare * marker.size_mm);
  for (const tools::BodyMarker& part : marker.markers)
    add_disc(camera, camera_from_world * part.body_from_marker.translation_mm, kHeadShare * part.size_mm);
}

void CoveredPlaces::add_tool(const camera::CameraModel& camera,
                             const geometry::RigidTransform& camera_from_tool, const tools::Tool& tool) {
  const auto add_plate = [&](const geometry::RigidTransform& tool_from_marker, double size_mm) {
    const double apart_mm = kPlateShare * size_mm;
    for (const double x : {-apart_mm, 0.0, apart_mm})
      for (const double y : {-apart_mm, 0.0, apart_mm})
        add_disc(camera, camera_from_tool * (tool_from_marker * Eigen::Vector3d(x, y, 0)), 0.75 * apart_mm);
  };
  if (tool.markers.empty()) add_plate({}, tool.size_mm);
  for (const tools::BodyMarker& part : tool.markers) add_plate(part.body_from_marker, part.size_mm);
  if (tool.axis) {
    add_rod(camera, camera_from_tool, tool.axis->point_mm,
            tool.axis->point_mm - kHandle_mm * tool.axis->direction, kRod_mm);
  } else if (tool.tip_mm) {
    const double behind_mm = -2.4;
    const Eigen::Vector3d end(tool.tip_mm->x(), tool.tip_mm->y() + 2.5, behind_mm);
    add_rod(camera, camera_from_tool, end, end + Eigen::Vector3d(0, kHandle_mm, 0), kRod_mm - 1);
    add_rod(camera, camera_from_tool, end, *tool.tip_mm, kHook_mm);
  }
}

}  // namespace arthronaut::contour
