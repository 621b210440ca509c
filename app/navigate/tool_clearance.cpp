#include "app/navigate/tool_clearance.h"

#include <cmath>

namespace arthronaut::navigate {

namespace {

constexpr double kTipClearance_px = 45;  // of 1080 lines: what is drawn keeps this far from a tool's tip
// Instruments for the joint pass a cannula of 5 to 6 mm; the files do not say how thick each is.
constexpr double kShaftRadius_mm = 2.8, kShaftLength_mm = 70, kStep_mm = 1.4;

struct Shaft {
  Eigen::Vector3d end_mm,
      backwards;  // the working end, in the marker frame, and the way to the handle (unit)
};

std::optional<Shaft> shaft_of(const tools::Tool& tool) {
  if (tool.axis) return Shaft{tool.axis->point_mm, -tool.axis->direction.normalized()};
  if (const auto direction = tools::shaft_direction(tool)) return Shaft{*tool.tip_mm, *direction};
  return std::nullopt;
}

// Nothing for a ball that the camera stands in or does not see.
std::optional<scene::ClearDisc> disc_of(const camera::CameraModel& camera, const Eigen::Vector3d& center_mm,
                                        double radius_mm) {
  Eigen::Matrix<double, 2, 3> d_pixel_d_point;
  if (center_mm.z() < 2 * radius_mm) return std::nullopt;
  const auto pixel = camera.project(center_mm, d_pixel_d_point);
  if (!pixel) return std::nullopt;
  // The Jacobian's norm is that of two nearly equal scales.
  return scene::ClearDisc{*pixel, d_pixel_d_point.norm() / std::sqrt(2.0) * radius_mm};
}

}  // namespace

std::vector<scene::ClearDisc> clear_discs_of(const pipeline::FrameResult& result,
                                             const tools::ToolSet& tools) {
  std::vector<scene::ClearDisc> discs;
  const double tip_radius_px = kTipClearance_px * result.camera.image_size_px().y() / 1080.0;
  for (const markers::MarkerObservation& marker : result.markers) {
    if (result.is_frozen || !result.stands_for(marker)) continue;
    for (const tools::Tool& tool : tools.tools) {
      const auto shaft = tool.marker_id == marker.id ? shaft_of(tool) : std::nullopt;
      if (!shaft) continue;
      if (const auto tip = result.camera.project(marker.camera_from_marker * shaft->end_mm))
        discs.push_back({*tip, tip_radius_px});
      for (double along = 0; along <= kShaftLength_mm; along += kStep_mm)
        if (const auto disc =
                disc_of(result.camera, marker.camera_from_marker * (shaft->end_mm + along * shaft->backwards),
                        kShaftRadius_mm))
          discs.push_back(*disc);
    }
  }
  return discs;
}

}  // namespace arthronaut::navigate
