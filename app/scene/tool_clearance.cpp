#include "app/scene/tool_clearance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace arthronaut::scene {

namespace {

constexpr double kTipClearance_px = 45;  // of 1080 lines: what is drawn keeps this far from a tool's tip
// Instruments for the joint pass a cannula of 5 to 6 mm; the files do not say how thick each is.
constexpr double kShaftRadius_mm = 2.8, kShaftLength_mm = 70, kStep_mm = 1.4;
constexpr double kNearest_mm = 1;     // in front of the lens
constexpr double kMostOfView = 0.16;  // of the view's radius: the width that one disc covers at most

struct Shaft {
  Eigen::Vector3d end_mm,
      backwards;  // the working end, in the tool's frame, and the way to the handle (unit)
};

std::optional<Shaft> shaft_of(const tools::Tool& tool) {
  if (tool.axis) return Shaft{tool.axis->point_mm, -tool.axis->direction.normalized()};
  if (const auto direction = tools::shaft_direction(tool)) return Shaft{*tool.tip_mm, *direction};
  return std::nullopt;
}

// The round view and a little more: a line inside the view keeps off what lies on its rim.
bool is_near_view(const camera::CameraModel& camera, const Eigen::Vector2d& pixel) {
  constexpr double kMargin = 1.05;
  const camera::Boundary& view = camera.boundary();
  return view.radius_px <= 0 || (pixel - view.center_px).norm() < kMargin * view.radius_px;
}

// The shaft's width at one place in pixels, as far as the view shows it. The width is projected, not the
// scale at its middle: towards the critical angle, which lies close outside the view, the scale has no bound,
// and one disc would clear the whole picture.
struct Width {
  Eigen::Vector2d from_px, to_px;
  [[nodiscard]] Eigen::Vector2d middle_px() const { return 0.5 * (from_px + to_px); }
};

std::optional<Width> width_of(const camera::CameraModel& camera, const Eigen::Vector3d& middle_mm,
                              const Eigen::Vector3d& axis) {
  constexpr int kPlaces = 8;                             // on each side of the middle
  if (middle_mm.z() < kNearest_mm) return std::nullopt;  // beside the lens or behind it
  Eigen::Vector3d across = axis.cross(middle_mm);
  across = across.norm() > 1e-6 ? across.normalized() : axis.unitOrthogonal();
  std::optional<Eigen::Vector2d> first, last;
  for (int i = -kPlaces; i <= kPlaces; ++i) {
    const auto pixel = camera.project(middle_mm + kShaftRadius_mm * i / kPlaces * across);
    if (!pixel || !is_near_view(camera, *pixel)) continue;
    if (!first) first = pixel;
    last = pixel;
  }
  if (!first) return std::nullopt;
  return Width{*first, *last};
}

// Covers the width by as many discs as keep each small, and half the way to the width before: a shaft near
// the lens is wide, and one disc over it would clear as much in front of it and behind.
void add_discs(std::vector<ClearDisc>& discs, const Width& width, const std::optional<Width>& before,
               double most_px) {
  const Eigen::Vector2d along = width.to_px - width.from_px;
  const int count = std::max(static_cast<int>(std::ceil(along.norm() / most_px)), 1);
  const double way_px = before ? std::min((width.middle_px() - before->middle_px()).norm(), most_px) : 0;
  const double radius_px = std::hypot(along.norm() / (2 * count), way_px / 2);
  for (int i = 0; i < count; ++i) discs.push_back({width.from_px + (i + 0.5) / count * along, radius_px});
}

}  // namespace

std::vector<ClearDisc> clear_discs_of(const camera::CameraModel& camera, const tools::ToolSet& tools,
                                      const CameraFromTool& pose_of) {
  std::vector<ClearDisc> discs;
  const double tip_radius_px = kTipClearance_px * camera.image_size_px().y() / 1080.0;
  const double most_px = std::max(kMostOfView * camera.boundary().radius_px, tip_radius_px);
  for (const tools::Tool& tool : tools.tools) {
    const auto camera_from_tool = pose_of(tool);
    const auto shaft = camera_from_tool ? shaft_of(tool) : std::nullopt;
    if (!shaft) continue;
    const Eigen::Vector3d end = *camera_from_tool * shaft->end_mm;
    const Eigen::Vector3d backwards = camera_from_tool->rotate(shaft->backwards);
    if (const auto tip = camera.project(end); tip && is_near_view(camera, *tip))
      discs.push_back({*tip, tip_radius_px});
    std::optional<Width> before;
    double along = 0;
    while (along <= kShaftLength_mm) {
      const Eigen::Vector3d middle = end + along * backwards;
      // Near the lens a step is wide in the picture.
      along += kStep_mm * std::clamp(middle.z() / 15, 0.15, 1.0);
      const auto width = width_of(camera, middle, backwards);
      if (width) add_discs(discs, *width, before, most_px);
      before = width;
    }
  }
  return discs;
}

std::vector<ClearDisc> clear_discs_of(const pipeline::FrameResult& result, const tools::ToolSet& tools) {
  return clear_discs_of(result.camera, tools, [&result](const tools::Tool& tool) {
    return pipeline::body_in(result, tool.marker_id).camera_from_body;
  });
}

}  // namespace arthronaut::scene
