#include "app/setup/capture_panels.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::setup {

namespace {

void draw_live_picture(const widgets::Ui& ui, const widgets::Rect& area, widgets::VideoTexture& texture,
                       const CalibrateStatus& job, const CalibrateDisplay& display) {
  const camera::Boundary view = job.advice != nullptr && job.advice->picture.lens.circle_found
                                    ? job.advice->picture.lens.circle
                                    : camera::Boundary{};
  const widgets::PicturePlacement place = draw_picture(ui, area, texture, job.picture, view, display.is_live);
  if (!display.has_picture) return;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.PushClipRect(place.area().min(), place.area().max(), true);
  // Corners by shape too: rings where the picture may be taken, crosses where not.
  const bool is_good = job.advice->is_good() || job.took_this;
  const float radius = ui.theme.px(4), line = ui.theme.px(1.5F);
  const ImU32 color = is_good ? widgets::kGood : widgets::kCaution;
  for (const calibration::BoardCorner& corner : job.advice->picture.board.corners) {
    const auto at = place.on_screen(corner.pixel);
    if (!at) continue;
    if (is_good) {
      draw.AddCircle(*at, radius, color, 12, line);
    } else {
      draw.AddLine({at->x - radius, at->y}, {at->x + radius, at->y}, color, line);
      draw.AddLine({at->x, at->y - radius}, {at->x, at->y + radius}, color, line);
    }
  }
  const lens::LensObservation& lens = job.advice->picture.lens;
  if (lens.circle_found && lens.mark == lens::MarkState::Found) {
    const double angle = geometry::rad_from_deg(lens.mark_angle_deg);
    const Eigen::Vector2d mark =
        lens.circle.center_px + lens.circle.radius_px * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    if (const auto at = place.on_screen(mark))
      draw.AddCircle(*at, ui.theme.px(24), widgets::kAccent, 32, ui.theme.px(3));
  }
  draw.PopClipRect();
}

void draw_taken(const widgets::Ui& ui, const widgets::Rect& area, const CalibrateStatus& job,
                const CalibrateDisplay& display) {
  const std::size_t fewest = static_cast<std::size_t>(calibration::CaptureLimits{}.fewest_pictures);
  const std::string title =
      std::to_string(job.taken.size()) + " taken, " + std::to_string(fewest) + " or more wanted";
  widgets::begin_panel(ui, "setup.taken", area, title);
  const ImVec2 at = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
  const float line = ui.theme.body->FontSize;
  const bool has_mark =
      job.advice != nullptr && job.advice->picture.lens.mark == lens::MarkState::Found && display.is_live;
  draw_lens_dial(
      ui, {at.x, at.y, room.x, room.y - 2 * line - ui.theme.px(8)}, job.taken_angles_deg,
      has_mark ? job.advice->picture.lens.mark_angle_deg : std::numeric_limits<double>::quiet_NaN(),
      calibration::CaptureLimits{}.least_turn_deg);
  ImGui::SetCursorScreenPos({at.x, at.y + room.y - 2 * line - ui.theme.px(4)});
  widgets::text_in(ui.theme.body, widgets::kQuietText,
                   "Arrow: the lens now. Numbers: taken. Turn it out of the grey.");
  widgets::end_panel();
}

}  // namespace

widgets::Rect draw_capture(const widgets::Ui& ui, const widgets::Rect& area, widgets::VideoTexture& texture,
                           const CalibrateStatus& job, const CalibrateDisplay& display, float free_px) {
  const float gap = ui.theme.px(12);
  widgets::Rect rest = area;
  widgets::Rect left = rest.cut_left(std::min(rest.height, rest.width * 0.48F), gap);
  const widgets::Rect band = left.cut_bottom(ui.theme.px(120), gap);
  draw_live_picture(ui, left, texture, job, display);
  draw_band(ui, band, display.band);
  widgets::Rect right = rest.cut_right(rest.width * 0.46F, gap);
  draw_rows(ui, "setup.quality", rest, "This picture", display.quality);
  const widgets::Rect free = right.cut_bottom(free_px, gap);
  draw_taken(ui, right, job, display);
  return free;
}

widgets::Rect draw_exercise(const widgets::Ui& ui, const widgets::Rect& area, widgets::VideoTexture& texture,
                            const CalibrateStatus& job, float free_px) {
  CalibrateRunStatus status;
  status.phase = FeedPhase::Running;
  status.job = job;
  status.looked_s = steady_now_s();
  return draw_capture(ui, area, texture, job, calibrate_display(status, {}, status.looked_s), free_px);
}

}  // namespace arthronaut::setup
