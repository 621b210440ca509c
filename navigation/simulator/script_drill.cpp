#include <algorithm>
#include <cmath>

#include "navigation/simulator/holding.h"
#include "navigation/simulator/script.h"

namespace arthronaut::simulator {

Script drill_script(const SimulationOptions& options, const Staging& staging, const tunnels::Tunnel& aim,
                    double length_mm) {
  constexpr int kApproach = 50, kSettle = 15, kDrill = 45;
  constexpr double kBackMm = 9, kAsideMm = 3, kAslantDeg = 11;
  const tools::ToolAxis& axis = *guide_of(options).axis;
  const Eigen::Vector3d viewer = staging.bone_from_camera_drill.translation_mm;
  const Eigen::Vector3d side = aim.direction.unitOrthogonal();
  Script script;
  for (int i = 0; i < kApproach + kSettle + kDrill; ++i) {
    const double t = std::min(1.0, i / static_cast<double>(kApproach));
    const double away = 1 - t * t * (3 - 2 * t);
    const Eigen::Vector3d direction =
        Eigen::AngleAxisd(geometry::rad_from_deg(kAslantDeg) * away, side) * aim.direction;
    const Eigen::Vector3d point = aim.entry_mm - kBackMm * away * aim.direction + kAsideMm * away * side;
    Moment moment;
    moment.mark_angle_deg = options.camera.reference_mark_angle_deg + 15 * std::sin(i / 35.0);
    moment.bone_from_camera = staging.bone_from_camera_drill * tremor(options.seed + 13, i, 0.2, 0.4);
    // The hand's unrest dies down as the guide comes to rest on the bone.
    moment.bone_from_guide =
        guide_pose(axis, point, direction, viewer) * tremor(options.seed + 14, i, 0.3 * away, 0.5 * away);
    moment.drilled_depth_mm = std::max(0, i - kApproach - kSettle) * length_mm / (kDrill - 1);
    script.push_back(moment);
  }
  return script;
}

}  // namespace arthronaut::simulator
