#include "app/plan/lateral_view.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "app/plan/edge_words.h"
#include "app/plan/roof_line.h"
#include "app/scene/grid_lines.h"
#include "app/scene/lateral_plane.h"
#include "app/scene/radiograph.h"
#include "app/widgets/tooltip.h"
#include "planning/plan_review/landmark_check.h"

namespace arthronaut::plan {

namespace {

using bones::BoneKind;

// Of the femur's tunnels; of the whole ligament where none is planned.
std::vector<scene::NormEllipse> norms_of(const open_case::PlanModel& model,
                                         const landmarks::FemoralQuadrant& quadrant) {
  std::vector<scene::NormEllipse> norms;
  for (const tunnels::TunnelKey& key : model.knee().plan.of(BoneKind::Femur))
    norms.push_back(scene::norm_ellipse(quadrant, key.bundle));
  if (norms.empty()) norms.push_back(scene::norm_ellipse(quadrant, norms::Bundle::Whole));
  return norms;
}

std::string percent_text(const landmarks::FemoralQuadrant::Percent& percent) {
  return widgets::fixed(percent.deep_shallow, 1) + " % deep to shallow, " +
         widgets::fixed(percent.high_low, 1) + " % high to low";
}

}  // namespace

void LateralView::open(const open_case::PlanModel* model) {
  model_ = model;
  size_px_ = {0, 0};
}

void LateralView::draw(const widgets::Ui& ui, const widgets::Rect& area) {
  if (model_ == nullptr || !model_->has_bone(BoneKind::Femur)) {
    widgets::text_centered(ui, area, ui.theme.title, widgets::kQuietText,
                           "The lateral view is of a femur, which this case lacks.");
    return;
  }
  const Eigen::Vector2i size(std::max(static_cast<int>(area.width), 1),
                             std::max(static_cast<int>(area.height), 1));
  const scene::SlicePlane plane =
      scene::lateral_plane(model_->axes(BoneKind::Femur), model_->surroundings(BoneKind::Femur).quadrant,
                           model_->joint_bounds(BoneKind::Femur), size);
  if (size != size_px_ || !(plane == plane_)) {
    texture_.upload(size.x(), size.y(),
                    scene::radiograph_from(
                        scene::thickness_along(model_->knee().bones.at(BoneKind::Femur).mesh, plane, size)));
    size_px_ = size;
    plane_ = plane;
  }
  ImGui::SetCursorScreenPos(area.min());
  ImGui::InvisibleButton("lateral", {area.width, area.height});
  const bool is_hovered = ImGui::IsItemHovered();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.PushClipRect(area.min(), area.max(), true);
  draw.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture_.texture())), area.min(),
                area.max());
  draw_edge_words(ui, area, edge_words(plane_.right, -plane_.down, model_->axes(BoneKind::Femur)));
  draw_grid(ui, area);
  draw.PopClipRect();
  ui.log.note("plan.lateral_view", area.min(), area.max());
  const auto& quadrant = model_->surroundings(BoneKind::Femur).quadrant;
  if (is_hovered && quadrant) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const auto percent =
        quadrant->percent_of(plane_.point_at({mouse.x - area.x, mouse.y - area.y}, size_px_));
    // Elsewhere the percentages mean nothing.
    if (percent.deep_shallow >= 0 && percent.deep_shallow <= 100 && percent.high_low >= 0 &&
        percent.high_low <= 100) {
      std::string words =
          percent_text(percent) +
          "\nYellow: where studies found it, mean and one standard deviation; no limits of safety.";
      for (const scene::NormEllipse& norm : norms_of(*model_, *quadrant)) words += "\n" + norm.words;
      widgets::tooltip_at_mouse(ui, words);
    }
  }
}

void LateralView::draw_grid(const widgets::Ui& ui, const widgets::Rect& area) const {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const auto at = [&](const Eigen::Vector3d& point) {
    const Eigen::Vector2d pixel = plane_.pixel_of(point, size_px_);
    return ImVec2(area.x + static_cast<float>(pixel.x()), area.y + static_cast<float>(pixel.y()));
  };
  const auto& quadrant = model_->surroundings(BoneKind::Femur).quadrant;
  std::string text = scene::lateral_plane_in_words(model_->axes(BoneKind::Femur), quadrant,
                                                   model_->landmarks(BoneKind::Femur));
  if (quadrant) {
    const scene::GridLines lines = scene::grid_lines(*quadrant);
    const ImU32 grid = widgets::color_of(scene::kGridColor), norm = widgets::color_of(scene::kNormColor);
    for (const auto& line : lines.rims) draw.AddLine(at(line.front()), at(line.back()), grid, ui.theme.px(3));
    for (const auto& line : lines.divisions)
      draw.AddLine(at(line.front()), at(line.back()), grid, ui.theme.px(1.2F));
    for (const scene::NormEllipse& of : norms_of(*model_, *quadrant)) {
      std::vector<ImVec2> ellipse;
      for (const Eigen::Vector3d& point : of.outline_mm) ellipse.push_back(at(point));
      draw.AddPolyline(ellipse.data(), static_cast<int>(ellipse.size()), norm, ImDrawFlags_Closed,
                       ui.theme.px(2.5F));
      if (of.bundle == norms::Bundle::Whole) continue;
      const char* const name = of.bundle == norms::Bundle::Anteromedial ? "AM" : "PL";
      const ImVec2 center = at(of.center_mm);
      draw.AddText(ui.theme.body, ui.theme.body->FontSize,
                   {center.x + ui.theme.px(6), center.y - ui.theme.body->FontSize}, norm, name);
    }
    // Beside the line's shallow end, away from the grid: which side that is, is the knee's.
    constexpr const char* kLine = "Blumensaat's line";
    const ImVec2 shallow = at(quadrant->point_at({100, 0})), deep = at(quadrant->point_at({0, 0}));
    const float gap = ui.theme.px(8), font = ui.theme.body->FontSize;
    const float wide = ui.theme.body->CalcTextSizeA(font, 1e9F, 0, kLine).x;
    draw.AddText(ui.theme.body, font,
                 {deep.x < shallow.x ? shallow.x + gap : shallow.x - gap - wide, shallow.y}, grid, kLine);
  }
  std::string percents;
  for (const tunnels::TunnelKey& key : model_->knee().plan.of(BoneKind::Femur)) {
    const auto tunnel = model_->tunnel(key);
    const ImU32 color = widgets::color_of(scene::kPlanColor);
    const Eigen::Vector3d entry_mm = tunnels::entry_on_bone(*tunnel, model_->measured(key));
    const ImVec2 entry = at(entry_mm);
    const double length = model_->drawn_length_mm(key);
    draw.AddLine(entry, at(entry_mm + length * tunnel->direction), color, ui.theme.px(2));
    const auto radius = static_cast<float>(tunnel->diameter_mm / 2 / plane_.mm_per_px);
    draw.AddCircle(entry, radius, color, 40, ui.theme.px(2.5F));
    draw.AddCircleFilled(entry, ui.theme.px(4), color);
    if (quadrant) {
      const std::string percent = percent_text(quadrant->percent_of(entry_mm));
      const bool is_single = key.bundle == norms::Bundle::Whole;
      text += (is_single ? ". Entry: " : "\nEntry of the " + tunnels::name_of(key) + ": ") + percent;
      percents += (percents.empty() ? "" : "; ") + percent;
      ui.log.note_state("lateral_percent", percents);
    }
  }
  if (quadrant) text += "\n" + roof_line_in_words(*model_);
  if (const auto doubt = plan_review::landmark_doubt(model_->landmark_check(BoneKind::Femur)))
    text += "\nLook: " + *doubt;
  widgets::caption(ui, area, widgets::kText, text);
}

}  // namespace arthronaut::plan
