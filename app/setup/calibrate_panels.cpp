#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/setup/calibrate_station.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::setup {

using widgets::Severity;

void CalibrateStation::draw_pictures(const widgets::Ui& ui, const widgets::Rect& area) {
  const float gap = ui.theme.px(12);
  widgets::Rect rest = area;
  widgets::Rect left = rest.cut_left(std::min(rest.height, rest.width * 0.48F), gap);
  const widgets::Rect band = left.cut_bottom(ui.theme.px(120), gap);
  draw_live_picture(ui, left);
  const Band idle{Severity::Quiet, "Space starts the source",
                  "Show the board to the lens and turn the lens between the pictures; the camera head stays"};
  draw_band(ui, band, run_ != nullptr ? display_.band : idle);
  widgets::Rect right = rest.cut_right(rest.width * 0.46F, gap);
  draw_rows(ui, "setup.quality", rest, "This picture", display_.quality);
  const widgets::Rect form = right.cut_bottom(ui.theme.px(250), gap);
  draw_taken(ui, right);
  draw_form(ui, form);
}

void CalibrateStation::draw_live_picture(const widgets::Ui& ui, const widgets::Rect& area) {
  const CalibrateStatus& job = status_.job;
  const camera::Boundary view = job.advice != nullptr && job.advice->picture.lens.circle_found
                                    ? job.advice->picture.lens.circle
                                    : camera::Boundary{};
  const widgets::PicturePlacement place =
      draw_picture(ui, area, picture_, job.picture, view, display_.is_live);
  if (!display_.has_picture) return;
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

void CalibrateStation::draw_taken(const widgets::Ui& ui, const widgets::Rect& area) {
  const CalibrateStatus& job = status_.job;
  const std::size_t fewest = static_cast<std::size_t>(calibration::CaptureLimits{}.fewest_pictures);
  const std::string title =
      std::to_string(job.taken.size()) + " taken, " + std::to_string(fewest) + " or more wanted";
  widgets::begin_panel(ui, "setup.taken", area, title);
  const ImVec2 at = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
  const float line = ui.theme.body->FontSize;
  const bool has_mark =
      job.advice != nullptr && job.advice->picture.lens.mark == lens::MarkState::Found && display_.is_live;
  draw_lens_dial(
      ui, {at.x, at.y, room.x, room.y - 2 * line - ui.theme.px(8)}, job.taken_angles_deg,
      has_mark ? job.advice->picture.lens.mark_angle_deg : std::numeric_limits<double>::quiet_NaN(),
      calibration::CaptureLimits{}.least_turn_deg);
  ImGui::SetCursorScreenPos({at.x, at.y + room.y - 2 * line - ui.theme.px(4)});
  widgets::text_in(ui.theme.body, widgets::kQuietText,
                   "Arrow: the lens now. Numbers: taken. Turn it out of the grey.");
  widgets::end_panel();
}

void CalibrateStation::draw_form(const widgets::Ui& ui, const widgets::Rect& area) {
  widgets::begin_panel(ui, "setup.form", area, "Board and names");
  const float label = ui.theme.px(150);
  const auto field = [&](const char* name, const char* widget, const auto& edit) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::SetCursorScreenPos({at.x, at.y + ui.theme.px(6)});
    widgets::text_in(ui.theme.body, widgets::kText, name);
    ImGui::SetCursorScreenPos({at.x + label, at.y});
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
    edit();
    ui.log.note(widget, ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
    ImGui::SetCursorScreenPos({at.x, at.y + ui.theme.px(52)});
  };
  field("Square side", "setup.square", [&] {
    if (form_.wants_focus) ImGui::SetKeyboardFocusHere();
    form_.wants_focus = false;
    double side = form_.square_mm;
    if (ImGui::InputDouble("##square", &side, 0, 0, "%.2f mm") && side > 0 && side < 100)
      form_.square_mm = side;
  });
  field("Scope", "setup.scope", [&] { ImGui::InputText("##scope", &form_.scope_name); });
  field("Head", "setup.head", [&] { ImGui::InputText("##head", &form_.head_name); });
  widgets::end_panel();
}

void CalibrateStation::draw_result(const widgets::Ui& ui, const widgets::Rect& area) {
  const float gap = ui.theme.px(12);
  widgets::Rect rest = area;
  const widgets::Rect numbers = rest.cut_right(std::max(rest.width * 0.37F, ui.theme.px(420)), gap);
  const widgets::Rect verdict = rest.cut_bottom(ui.theme.px(130), gap);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.AddRectFilled(rest.min(), rest.max(), IM_COL32(0, 0, 0, 255), ui.theme.px(6));
  ui.log.note("setup.residuals", rest.min(), rest.max());
  const CalibrateStatus& job = status_.job;
  if (job.residuals != nullptr) {
    residuals_.upload(job.residuals);
    const widgets::Rect plot = widgets::fitted(
        rest, static_cast<float>(residuals_.width()) / static_cast<float>(residuals_.height()));
    draw.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(residuals_.texture())),
                  plot.min(), plot.max());
  } else {
    widgets::text_centered(ui, rest, ui.theme.title, widgets::kBad, "There is no result to show");
  }
  draw_band(ui, verdict, display_.verdict);
  std::vector<Row> against;
  for (const std::string& reason : display_.reasons) against.push_back({Severity::Bad, "Reason", reason});
  for (const std::string& note : display_.notes) against.push_back({Severity::Caution, "Note", note});
  widgets::Rect right = numbers;
  const widgets::Rect form = right.cut_bottom(ui.theme.px(230), gap);
  if (!against.empty())
    draw_rows(ui, "setup.reasons", right.cut_bottom(right.height * 0.38F, gap),
              display_.reasons.empty() ? "Worth knowing" : "Why refused", against);
  draw_rows(ui, "setup.result", right, "Result, \u00B1 one sigma", display_.result);
  draw_form(ui, form);
}

}  // namespace arthronaut::setup
