#include "navigation/simulator/instruments.h"

namespace arthronaut::simulator {
namespace {

constexpr double kPlateMargin = 0.25;  // white around the marker, share of its size
constexpr double kHandleMm = 90;       // behind the marker, out of every picture
constexpr double kYieldsMm = 12;       // see Solid::yields_mm

void add_plate(int marker_id, double size_mm, const geometry::RigidTransform& camera_from_marker,
               Solids& solids) {
  PlateShape shape;
  shape.half_size_mm.setConstant((0.5 + kPlateMargin) * size_mm);
  shape.markers = {{Eigen::Vector2d::Zero(), size_mm, marker_cells(marker_id)}};
  solids.push_back(make_plate(camera_from_marker, shape));
  solids.back()->yields_mm = kYieldsMm;
}

void add_rod(const geometry::RigidTransform& camera_from_marker, const Eigen::Vector3d& from_mm,
             const Eigen::Vector3d& to_mm, double radius_mm, double yields_mm, Solids& solids) {
  solids.push_back(make_rod(camera_from_marker * from_mm, camera_from_marker * to_mm, radius_mm, steel()));
  solids.back()->yields_mm = yields_mm;
}

void add_probe(const Eigen::Vector3d& tip_mm, const geometry::RigidTransform& camera_from_marker,
               Solids& solids) {
  constexpr double kShaftRadius = 1.5, kHookRadius = 0.6, kShaftBehindPlate = 2.4;
  // The shaft runs behind the plate along the marker's y; the hook bends from its end to the tip.
  const Eigen::Vector3d bend(tip_mm.x(), tip_mm.y() + 2.5, -kShaftBehindPlate);
  const Eigen::Vector3d hook_end = tip_mm + kHookRadius * (bend - tip_mm).normalized();
  add_rod(camera_from_marker, bend, Eigen::Vector3d(tip_mm.x(), kHandleMm, -kShaftBehindPlate), kShaftRadius,
          kYieldsMm, solids);
  add_rod(camera_from_marker, bend, hook_end, kHookRadius, 0, solids);
}

void add_guide(const tools::ToolAxis& axis, const geometry::RigidTransform& camera_from_marker,
               Solids& solids) {
  constexpr double kSleeveRadius = 2.2, kDrillMm = 14;
  // The front part can vanish into the bone that it drills.
  const Eigen::Vector3d tip = axis.point_mm - kSleeveRadius * axis.direction;
  const Eigen::Vector3d middle = axis.point_mm - kDrillMm * axis.direction;
  add_rod(camera_from_marker, tip, middle, kSleeveRadius, 0, solids);
  add_rod(camera_from_marker, middle, axis.point_mm - kHandleMm * axis.direction, kSleeveRadius, kYieldsMm,
          solids);
}

}  // namespace

void add_world_marker(const tools::WorldMarker& marker, const geometry::RigidTransform& camera_from_marker,
                      Solids& solids) {
  PlateShape head;
  head.is_round = true;
  head.half_size_mm.setConstant(0.86 * marker.size_mm);
  head.thickness_mm = 3;
  head.markers = {{Eigen::Vector2d::Zero(), marker.size_mm, marker_cells(marker.marker_id)}};
  solids.push_back(make_plate(camera_from_marker, head));
  // The head's lower edge may stand in the bone; its face never does.
  solids.back()->yields_mm = 0;
  for (std::size_t i = 1; i < marker.markers.size(); ++i)
    add_plate(marker.markers[i].marker_id, marker.markers[i].size_mm,
              camera_from_marker * marker.markers[i].body_from_marker, solids);
}

void add_tool(const tools::Tool& tool, const geometry::RigidTransform& camera_from_marker, Solids& solids) {
  for (const tools::BodyMarker& marker : tools::markers_of(tool))
    add_plate(marker.marker_id, marker.size_mm, camera_from_marker * marker.body_from_marker, solids);
  if (tool.tip_mm) add_probe(*tool.tip_mm, camera_from_marker, solids);
  if (tool.axis) add_guide(*tool.axis, camera_from_marker, solids);
}

}  // namespace arthronaut::simulator
