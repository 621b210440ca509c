#include "app/plan/lateral_view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <iterator>

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

// Of the bone's tunnels; of the whole ligament where none is planned.
template <typename Grid>
std::vector<scene::NormEllipse> norms_of(const open_case::PlanModel& model, BoneKind bone, const Grid& grid) {
  std::vector<scene::NormEllipse> norms;
  for (const tunnels::TunnelKey& key : model.knee().plan.of(bone))
    norms.push_back(scene::norm_ellipse(grid, key.bundle));
  if (norms.empty()) norms.push_back(scene::norm_ellipse(grid, norms::Bundle::Whole));
  return norms;
}

std::string percent_text(const landmarks::FemoralQuadrant::Percent& percent) {
  return widgets::fixed(percent.deep_shallow, 1) + " % deep to shallow, " +
         widgets::fixed(percent.high_low, 1) + " % high to low";
}
// What a lateral view tells of the plateau: not what lies along the beam.
std::string percent_text(const landmarks::TibialGrid::Percent& percent) {
  return widgets::fixed(percent.anterior_posterior, 1) + " % from front to back";
}

std::string caption_of(const open_case::PlanModel& model, BoneKind bone) {
  if (bone == BoneKind::Tibia)
    return "Tibia, lateral view by " + std::string(to_text(model.axes(bone).origin));
  std::string words = scene::lateral_plane_in_words(model.axes(bone), model.surroundings(bone).quadrant,
                                                    model.landmarks(bone));
  words[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(words[0])));
  return "Femur, " + words;
}

}  // namespace

void LateralView::open(const open_case::PlanModel* model) {
  model_ = model;
  size_px_ = {0, 0};
}

ImVec2 LateralView::at(const widgets::Rect& area, const Eigen::Vector3d& point_mm) const {
  const Eigen::Vector2d pixel = plane_.pixel_of(point_mm, size_px_);
  return {area.x + static_cast<float>(pixel.x()), area.y + static_cast<float>(pixel.y())};
}

void LateralView::draw(const widgets::Ui& ui, const widgets::Rect& area, const Shown& shown) {
  const BoneKind bone = shown.bone;
  if (model_ == nullptr || !model_->has_bone(bone)) {
    widgets::text_centered(ui, area, ui.theme.title, widgets::kQuietText,
                           "This case has no " + std::string(bones::to_text(bone)) + ".");
    return;
  }
  const Eigen::Vector2i size(std::max(static_cast<int>(area.width), 1),
                             std::max(static_cast<int>(area.height), 1));
  const scene::SlicePlane plane = scene::lateral_plane(
      model_->axes(bone), model_->surroundings(bone).quadrant, model_->joint_bounds(bone), size);
  if (bone != bone_ || size != size_px_ || !(plane == plane_)) {
    texture_.upload(
        size.x(), size.y(),
        scene::radiograph_from(scene::thickness_along(model_->knee().bones.at(bone).mesh, plane, size)));
    bone_ = bone;
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
  if (bone == BoneKind::Femur) draw_femoral_grid(ui, area);
  std::string text = caption_of(*model_, bone) + draw_tunnels(ui, area, bone);
  std::vector<ImVec4> marks;
  if (bone == BoneKind::Tibia) marks = draw_tibial_line(ui, area);  // its numbers over the tunnels
  if (model_->surroundings(bone).quadrant) text += "\n" + roof_line_in_words(*model_);
  if (const auto doubt = plan_review::landmark_doubt(model_->landmark_check(bone)))
    text += "\nLook: " + *doubt;
  if (shown.landmarks) draw_landmarks(ui, area, shown);
  // The upper edge's word stands below the caption, which would hide it.
  widgets::Rect below = area;
  const float beside = ui.theme.px(28), size_pt = ui.theme.strong->FontSize;
  below.cut_top(ui.theme.strong->CalcTextSizeA(size_pt, 1e9F, area.width - beside, text.c_str()).y +
                ui.theme.px(18));
  std::vector<ImVec4> taken = entries_on_screen(area, bone);
  std::ranges::copy(marks, std::back_inserter(taken));
  draw_edge_words(ui, below, edge_words(plane_.right, -plane_.down, model_->axes(bone)), taken);
  widgets::caption(ui, area, widgets::kText, text);
  draw.PopClipRect();
  ui.log.note("plan.lateral_view", area.min(), area.max());
  ui.log.note_state("lateral_view", text);
  if (is_hovered) show_percents(ui, area, bone);
}

// Of the place under the mouse. Outside of the grid the percentages mean nothing.
void LateralView::show_percents(const widgets::Ui& ui, const widgets::Rect& area, BoneKind bone) const {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const Eigen::Vector3d point_mm = plane_.point_at({mouse.x - area.x, mouse.y - area.y}, size_px_);
  const auto is_inside = [](double percent) { return percent >= 0 && percent <= 100; };
  const auto show = [&](const auto& grid, const auto& percent) {
    std::string words =
        percent_text(percent) +
        "\nYellow: where studies found it, mean and one standard deviation; no limits of safety.";
    for (const scene::NormEllipse& norm : norms_of(*model_, bone, grid)) words += "\n" + norm.words;
    widgets::tooltip_at_mouse(ui, words);
  };
  if (const auto& quadrant = model_->surroundings(bone).quadrant) {
    const auto percent = quadrant->percent_of(point_mm);
    if (is_inside(percent.deep_shallow) && is_inside(percent.high_low)) show(*quadrant, percent);
  }
  if (const auto& plateau = model_->surroundings(bone).plateau) {
    const auto percent = plateau->percent_of(point_mm);
    if (is_inside(percent.anterior_posterior)) show(*plateau, percent);
  }
}

void LateralView::draw_femoral_grid(const widgets::Ui& ui, const widgets::Rect& area) const {
  const auto& quadrant = model_->surroundings(BoneKind::Femur).quadrant;
  if (!quadrant) return;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const scene::GridLines lines = scene::grid_lines(*quadrant);
  const ImU32 grid = widgets::color_of(scene::kGridColor), norm = widgets::color_of(scene::kNormColor);
  for (const auto& line : lines.rims)
    draw.AddLine(at(area, line.front()), at(area, line.back()), grid, ui.theme.px(3));
  for (const auto& line : lines.divisions)
    draw.AddLine(at(area, line.front()), at(area, line.back()), grid, ui.theme.px(1.2F));
  for (const scene::NormEllipse& of : norms_of(*model_, BoneKind::Femur, *quadrant)) {
    std::vector<ImVec2> ellipse;
    for (const Eigen::Vector3d& point : of.outline_mm) ellipse.push_back(at(area, point));
    draw.AddPolyline(ellipse.data(), static_cast<int>(ellipse.size()), norm, ImDrawFlags_Closed,
                     ui.theme.px(2.5F));
    if (of.bundle == norms::Bundle::Whole) continue;
    const char* const name = of.bundle == norms::Bundle::Anteromedial ? "AM" : "PL";
    const ImVec2 center = at(area, of.center_mm);
    draw.AddText(ui.theme.body, ui.theme.body->FontSize,
                 {center.x + ui.theme.px(6), center.y - ui.theme.body->FontSize}, norm, name);
  }
  // Beside the line's shallow end, away from the grid: which side that is, is the knee's.
  constexpr const char* kLine = "Blumensaat's line";
  const ImVec2 shallow = at(area, quadrant->point_at({100, 0})), deep = at(area, quadrant->point_at({0, 0}));
  const float gap = ui.theme.px(8), font = ui.theme.body->FontSize;
  const float wide = ui.theme.body->CalcTextSizeA(font, 1e9F, 0, kLine).x;
  draw.AddText(ui.theme.body, font,
               {deep.x < shallow.x ? shallow.x + gap : shallow.x - gap - wide, shallow.y}, grid, kLine);
}

std::vector<ImVec4> LateralView::draw_tibial_line(const widgets::Ui& ui, const widgets::Rect& area) const {
  std::vector<ImVec4> marks;
  const auto& plateau = model_->surroundings(BoneKind::Tibia).plateau;
  if (!plateau) return marks;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImU32 grid = widgets::color_of(scene::kGridColor), norm = widgets::color_of(scene::kNormColor);
  const auto along = [&](double percent) { return at(area, plateau->point_at({percent, 50})); };
  const ImVec2 front = along(0), back = along(100);
  draw.AddLine(front, back, grid, ui.theme.px(3));
  const float tick = ui.theme.px(10), font = ui.theme.body->FontSize;
  for (const double percent : {0.0, 25.0, 50.0, 75.0, 100.0}) {
    const ImVec2 on = along(percent);
    draw.AddLine({on.x, on.y - tick}, {on.x, on.y + tick}, grid, ui.theme.px(1.5F));
    const std::string words = widgets::fixed(percent, 0) + " %";
    const float wide = ui.theme.body->CalcTextSizeA(font, 1e9F, 0, words.c_str()).x;
    // Below the line, above which the entries lie; read over the bright bone.
    const ImVec2 corner{on.x - wide / 2, on.y + tick};
    const float pad = ui.theme.px(4);
    draw.AddRectFilled({corner.x - pad, corner.y}, {corner.x + wide + pad, corner.y + font},
                       IM_COL32(12, 16, 20, 170), pad);
    draw.AddText(ui.theme.body, font, corner, grid, words.c_str());
    marks.emplace_back(corner.x - pad, on.y - tick, corner.x + wide + pad, corner.y + font);
  }
  // The ellipse edge-on: as far as the norm reaches along the line.
  for (const scene::NormEllipse& of : norms_of(*model_, BoneKind::Tibia, *plateau)) {
    const auto percent_of = [&](const Eigen::Vector3d& point) {
      return plateau->percent_of(point).anterior_posterior;
    };
    const auto [least, most] = std::ranges::minmax(of.outline_mm, {}, percent_of);
    draw.AddLine(along(percent_of(least)), along(percent_of(most)), norm, ui.theme.px(6));
  }
  return marks;
}

void LateralView::draw_landmarks(const widgets::Ui& ui, const widgets::Rect& area, const Shown& shown) const {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float arm = ui.theme.px(7), line = ui.theme.px(2);
  const auto& states = model_->landmark_states(shown.bone);
  for (const auto& [name, point_mm] : model_->landmarks(shown.bone)) {
    const bool is_proposed = landmarks::state_of(states, name) == landmarks::LandmarkState::Proposed;
    const ImU32 color = is_proposed ? widgets::kCaution : widgets::kGood;
    const ImVec2 center = at(area, point_mm);
    draw.AddLine({center.x - arm, center.y}, {center.x + arm, center.y}, color, line);
    draw.AddLine({center.x, center.y - arm}, {center.x, center.y + arm}, color, line);
    if (name != shown.landmark) continue;
    draw.AddCircle(center, 1.6F * arm, color, 24, line);
    const landmarks::LandmarkKind* const kind = landmarks::find_landmark(shown.bone, name);
    draw.AddText(ui.theme.strong, ui.theme.strong->FontSize, {center.x + 2 * arm, center.y + arm}, color,
                 kind == nullptr ? name.c_str() : std::string(kind->title).c_str());
  }
}

std::vector<ImVec4> LateralView::entries_on_screen(const widgets::Rect& area, BoneKind bone) const {
  std::vector<ImVec4> entries;
  for (const tunnels::TunnelKey& key : model_->knee().plan.of(bone)) {
    const auto tunnel = model_->tunnel(key);
    const ImVec2 entry = at(area, tunnels::entry_on_bone(*tunnel, model_->measured(key)));
    const auto radius = static_cast<float>(tunnel->diameter_mm / 2 / plane_.mm_per_px);
    entries.emplace_back(entry.x - radius, entry.y - radius, entry.x + radius, entry.y + radius);
  }
  return entries;
}

std::string LateralView::draw_tunnels(const widgets::Ui& ui, const widgets::Rect& area, BoneKind bone) const {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  std::string text, percents;
  for (const tunnels::TunnelKey& key : model_->knee().plan.of(bone)) {
    const auto tunnel = model_->tunnel(key);
    const ImU32 color = widgets::color_of(scene::kPlanColor);
    const Eigen::Vector3d entry_mm = tunnels::entry_on_bone(*tunnel, model_->measured(key));
    const ImVec2 entry = at(area, entry_mm);
    const double length = model_->drawn_length_mm(key);
    draw.AddLine(entry, at(area, entry_mm + length * tunnel->direction), color, ui.theme.px(2));
    const auto radius = static_cast<float>(tunnel->diameter_mm / 2 / plane_.mm_per_px);
    draw.AddCircle(entry, radius, color, 40, ui.theme.px(2.5F));
    draw.AddCircleFilled(entry, ui.theme.px(4), color);
    const auto& around = model_->surroundings(bone);
    if (!around.has_grid()) continue;
    const std::string percent = around.quadrant ? percent_text(around.quadrant->percent_of(entry_mm))
                                                : percent_text(around.plateau->percent_of(entry_mm));
    const bool is_single = key.bundle == norms::Bundle::Whole;
    text += (is_single ? ". Entry: " : "\nEntry of the " + tunnels::name_of(key) + ": ") + percent;
    percents += (percents.empty() ? "" : "; ") + percent;
    ui.log.note_state("lateral_percent", percents);
  }
  return text;
}

}  // namespace arthronaut::plan
