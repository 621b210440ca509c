#include "app/plan/slice_pane.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "app/plan/pane_text.h"
#include "app/widgets/held_mouse.h"

namespace arthronaut::plan {

namespace {

constexpr ImU32 kCross = IM_COL32(86, 180, 233, 150), kMeasured = IM_COL32(240, 228, 66, 255);

ImVec2 screen(const widgets::Rect& rect, const Eigen::Vector2d& pixel) {
  return {rect.x + static_cast<float>(pixel.x()), rect.y + static_cast<float>(pixel.y())};
}

Eigen::Vector2i size_of(const widgets::Rect& rect) {
  return {std::max(static_cast<int>(rect.width), 1), std::max(static_cast<int>(rect.height), 1)};
}

void shadowed(ImDrawList& draw, ImFont* font, const ImVec2& at, ImU32 color, const std::string& text) {
  draw.AddText(font, font->FontSize, {at.x + 1, at.y + 1}, widgets::kBackground, text.c_str());
  draw.AddText(font, font->FontSize, at, color, text.c_str());
}

// 1, 2, 5, 10, ... mm: the longest that is no longer than a quarter of the pane.
double scale_mm(double pane_mm) {
  double length = 1;
  for (const double next : {2.0, 5.0, 10.0, 20.0, 50.0, 100.0})
    if (next <= pane_mm / 4) length = next;
  return length;
}

}  // namespace

SlicePane::SlicePane(std::string title, const Eigen::Vector3d& right, const Eigen::Vector3d& down)
    : title_(std::move(title)), right_(right), down_(down) {}

void SlicePane::turn_to(std::string title, const Eigen::Vector3d& right, const Eigen::Vector3d& down) {
  title_ = std::move(title);
  right_ = right;
  down_ = down;
}

void SlicePane::fit(const images::Volume& volume) {
  const Eigen::Vector3d last = (volume.size - Eigen::Vector3i::Ones()).cast<double>();
  center_mm_ = volume.lps_from_index * Eigen::Vector3d(0.5 * last);
  const Eigen::Vector3d extent =
      (volume.lps_from_index.linear() * last.asDiagonal()).cwiseAbs().rowwise().sum();
  fit_mm_ = std::max(extent.dot(right_.cwiseAbs()), extent.dot(down_.cwiseAbs()));
  is_fitted_ = true;
}

void SlicePane::show(const Eigen::Vector3d& center_mm, double extent_mm) {
  center_mm_ = center_mm;
  fit_mm_ = extent_mm;
  is_fitted_ = true;
}

void SlicePane::zoom(double steps, const Eigen::Vector3d& fixed_mm) {
  const double zoomed = std::clamp(mm_per_px_ * std::pow(0.88, steps), 0.01, 5.0);
  const Eigen::Vector3d away = fixed_mm - center_mm_, n = normal();
  center_mm_ += (1 - zoomed / mm_per_px_) * (away - n.dot(away) * n);
  mm_per_px_ = zoomed;
}

double SlicePane::step_mm(const images::Volume& volume) const {
  // The spacing of the volume's axis that runs nearest to the normal.
  const Eigen::Matrix3d axes = volume.lps_from_index.linear();
  Eigen::Index nearest = 0;
  (axes.colwise().normalized().transpose() * normal()).cwiseAbs().maxCoeff(&nearest);
  return axes.col(nearest).norm();
}

bool lies_in(const SliceLine& line, const scene::SlicePlane& plane) {
  return std::ranges::all_of(line.points_mm, [&](const Eigen::Vector3d& point) {
    return std::abs(plane.normal().dot(point - plane.center_mm)) < kNearSlice_mm;
  });
}

std::string place_in_words(const Eigen::Vector3d& normal, const Eigen::Vector3d& point_mm) {
  const double along_mm = normal.dot(point_mm);
  const Eigen::Vector3d side = along_mm < 0 ? Eigen::Vector3d(-normal) : normal;
  return scene::orientation_letters(side) + " " + widgets::fixed(std::abs(along_mm), 1) + " mm";
}

std::string window_in_words(const scene::GreyWindow& window) {
  return "W " + widgets::fixed(window.width, 0) + " L " + widgets::fixed(window.level, 0);
}

scene::SlicePlane SlicePane::plane_through(const Eigen::Vector3d& cross_mm) const {
  const Eigen::Vector3d n = normal();
  return {center_mm_ + n.dot(cross_mm - center_mm_) * n, right_, down_, mm_per_px_};
}

SliceEvent SlicePane::draw(const widgets::Ui& ui, const char* name, const widgets::Rect& rect,
                           const SliceContent& content) {
  if (rect.width < 8 || rect.height < 8) return {};
  if (is_fitted_) {
    mm_per_px_ = fit_mm_ / std::min(rect.width, rect.height);
    is_fitted_ = false;
    shown_ = {};  // a volume that was just opened may lie where one lay that is gone
  }
  ImGui::SetCursorScreenPos(rect.min());
  ImGui::PushID(name);
  ImGui::InvisibleButton("slice", {rect.width, rect.height},
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
  const SliceEvent event = follow_mouse(rect, content);
  ImGui::PopID();
  const Shown wanted{plane_through(content.cross_mm),
                     size_of(rect),
                     content.window,
                     content.volume,
                     content.revision,
                     content.labels != nullptr ? content.labels->revision : 0};
  const bool is_moved = !(wanted.plane == shown_.plane) || wanted.volume != shown_.volume;
  if (is_moved || wanted.size_px != shown_.size_px || !(wanted.window == shown_.window)) {
    scene::reslice(*content.volume, wanted.plane, wanted.size_px, wanted.window, grey_);
    texture_.upload(wanted.size_px.x(), wanted.size_px.y(), grey_);
  }
  if (is_moved || wanted.revision != shown_.revision || outlines_.size() != content.meshes.size()) {
    outlines_.clear();
    for (const OutlinedMesh& mesh : content.meshes)
      outlines_.push_back(scene::outline_of(*mesh.mesh, wanted.plane.center_mm, wanted.plane.normal()));
  }
  if (content.labels != nullptr &&
      (is_moved || wanted.size_px != shown_.size_px || wanted.labels_revision != shown_.labels_revision)) {
    std::vector<std::uint32_t> rgba;
    scene::draw_labels(*content.volume, content.labels->layers, wanted.plane, wanted.size_px, rgba);
    labels_.upload(wanted.size_px.x(), wanted.size_px.y(), rgba);
  }
  shown_ = wanted;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.PushClipRect(rect.min(), rect.max(), true);
  draw.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture_.texture())), rect.min(),
                rect.max());
  if (content.labels != nullptr)
    draw.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(labels_.texture())), rect.min(),
                  rect.max());
  draw_overlay(ui, rect, content);
  if (content.brush_mm && (content.shows_brush_at_cross || event.is_hovered)) {
    const ImVec2 at = content.shows_brush_at_cross
                          ? screen(rect, shown_.plane.pixel_of(content.cross_mm, shown_.size_px))
                          : ImGui::GetIO().MousePos;
    draw.AddCircle(at, static_cast<float>(*content.brush_mm / mm_per_px_), widgets::kText, 0,
                   ui.theme.px(1.5F));
  }
  draw_frame(ui, rect, content);
  draw.PopClipRect();
  ui.log.note(name, rect.min(), rect.max());
  return event;
}

SliceEvent SlicePane::follow_mouse(const widgets::Rect& rect, const SliceContent& content) {
  SliceEvent event;
  const ImGuiIO& io = ImGui::GetIO();
  const Eigen::Vector2i size = size_of(rect);
  const scene::SlicePlane plane = plane_through(content.cross_mm);
  const Eigen::Vector2d mouse(io.MousePos.x - rect.x, io.MousePos.y - rect.y);
  const Eigen::Vector3d under_mouse = plane.point_at(mouse, size);
  event.is_hovered = ImGui::IsItemHovered();
  if (event.is_hovered) event.value = scene::value_at(*content.volume, under_mouse);
  if (ImGui::IsItemActivated()) {
    press_travel_px_ = 0;
    pressed_mm_ = under_mouse;
    press_measures_ = content.measures && ImGui::IsMouseDown(ImGuiMouseButton_Left);
    press_paints_ =
        content.brush_mm && ImGui::IsMouseDown(ImGuiMouseButton_Left) && !io.KeyShift && !io.KeyCtrl;
    if (press_paints_) event.painted = {under_mouse, under_mouse, true};
  }
  if (ImGui::IsItemActive()) {
    const ImVec2 way = widgets::held_mouse_way_px();
    press_travel_px_ += std::hypot(way.x, way.y);
    const bool left = ImGui::IsMouseDown(ImGuiMouseButton_Left);
    if (ImGui::IsMouseDown(ImGuiMouseButton_Right) && (way.x != 0 || way.y != 0)) {
      scene::GreyWindow window = content.window;  // over the pane's height: twice the window
      const double per_px = 2 * std::max(window.width, 1.0) / rect.height;
      window.width = std::max(window.width + per_px * way.x, 1.0);
      window.level -= per_px * way.y;
      event.window = window;
    } else if (ImGui::IsMouseDown(ImGuiMouseButton_Middle) || (left && io.KeyShift)) {
      shift({way.x, way.y});
    } else if (press_paints_) {
      if (!event.painted && under_mouse != pressed_mm_) event.painted = {pressed_mm_, under_mouse, false};
      pressed_mm_ = under_mouse;
    } else if (left && !press_measures_) {
      event.cross_mm = under_mouse;
    }
  }
  constexpr float kDrag_px = 5;
  if (ImGui::IsItemDeactivated() && press_measures_) {
    event.measured_mm = {pressed_mm_};
    if (press_travel_px_ >= kDrag_px) event.measured_mm.push_back(under_mouse);
  } else if (content.measures && event.is_hovered) {
    if (ImGui::IsItemActive() && press_measures_) event.reaching_mm.push_back(pressed_mm_);
    event.reaching_mm.push_back(under_mouse);
  }
  if (event.is_hovered && io.MouseWheel != 0) {
    if (content.brush_mm && io.KeyShift) {
      event.brush_steps = io.MouseWheel;
    } else if (io.KeyCtrl) {  // what is under the mouse stays there
      zoom(io.MouseWheel, under_mouse);
    } else {
      // A touchpad scrolls by fractions of a step: they add up.
      const float steps = std::trunc(wheel_steps_ += io.MouseWheel);
      wheel_steps_ -= steps;
      if (steps != 0) event.cross_mm = content.cross_mm + steps * step_mm(*content.volume) * normal();
    }
  }
  return event;
}

void SlicePane::draw_overlay(const widgets::Ui& ui, const widgets::Rect& rect, const SliceContent& content) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const scene::SlicePlane& plane = shown_.plane;
  const auto at = [&](const Eigen::Vector3d& point) {
    return screen(rect, plane.pixel_of(point, shown_.size_px));
  };
  const auto off_plane_mm = [&](const Eigen::Vector3d& point) {
    return std::abs(plane.normal().dot(point - plane.center_mm));
  };
  for (std::size_t i = 0; i < outlines_.size() && i < content.meshes.size(); ++i)
    for (const auto& [a, b] : outlines_[i])
      draw.AddLine(at(a), at(b), content.meshes[i].color, ui.theme.px(content.meshes[i].line_px));
  const ImVec2 cross = at(content.cross_mm);
  const float gap = ui.theme.px(14);
  for (const auto& [from, to] :
       {std::pair{ImVec2(rect.x, cross.y), ImVec2(cross.x - gap, cross.y)},
        std::pair{ImVec2(cross.x + gap, cross.y), ImVec2(rect.x + rect.width, cross.y)},
        std::pair{ImVec2(cross.x, rect.y), ImVec2(cross.x, cross.y - gap)},
        std::pair{ImVec2(cross.x, cross.y + gap), ImVec2(cross.x, rect.y + rect.height)}})
    draw.AddLine(from, to, kCross, ui.theme.px(1.5F));
  for (const SliceMark& mark : content.marks) {
    if (off_plane_mm(mark.point_mm) > kNearSlice_mm) continue;
    const ImVec2 p = at(mark.point_mm);
    draw.AddCircle(p, ui.theme.px(6), mark.color, 16, ui.theme.px(2));
    shadowed(draw, ui.theme.body, {p.x + ui.theme.px(9), p.y - ui.theme.body->FontSize / 2}, mark.color,
             mark.word);
  }
  for (const SliceLine& line : content.lines) {
    const bool is_whole = line.is_being_made || lies_in(line, plane);
    for (const Eigen::Vector3d& point : line.points_mm)
      if (is_whole || off_plane_mm(point) < kNearSlice_mm)
        draw.AddCircleFilled(at(point), ui.theme.px(4), kMeasured);
    if (!is_whole) continue;
    for (std::size_t i = 0; i + 1 < line.points_mm.size(); ++i)
      draw.AddLine(at(line.points_mm[i]), at(line.points_mm[i + 1]), kMeasured, ui.theme.px(2));
    if (line.word.empty()) continue;
    std::vector<ImVec2> points;
    for (const Eigen::Vector3d& point : line.points_mm) points.push_back(at(point));
    const ImVec2 size = ui.theme.strong->CalcTextSizeA(ui.theme.strong->FontSize, 1e9F, 0, line.word.c_str());
    // Clear of the edge: there the patient's sides stand, two letters wide at most.
    shadowed(draw, ui.theme.strong,
             beside_measured(points, size, ui.theme.px(6),
                             rect.inset(ui.theme.px(10) + 1.5F * ui.theme.strong->FontSize)),
             kMeasured, line.word);
  }
}

void SlicePane::draw_frame(const widgets::Ui& ui, const widgets::Rect& rect,
                           const SliceContent& content) const {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  ImFont* font = ui.theme.strong;
  const float edge = ui.theme.px(8), high = font->FontSize;
  const auto wide = [&](const std::string& text) {
    return font->CalcTextSizeA(high, 1e9F, 0, text.c_str()).x;
  };
  shadowed(draw, font, {rect.x + edge, rect.y + edge}, widgets::kText, title_);
  const std::string left = scene::orientation_letters(-right_), right = scene::orientation_letters(right_),
                    top = scene::orientation_letters(-down_), bottom = scene::orientation_letters(down_);
  const float middle_y = rect.y + (rect.height - high) / 2, middle_x = rect.x + rect.width / 2;
  // Over the lines of the cross, which end in the same places.
  const auto side = [&](const ImVec2& at, const std::string& letters) {
    const float pad = ui.theme.px(3);
    draw.AddRectFilled({at.x - pad, at.y}, {at.x + wide(letters) + pad, at.y + high},
                       IM_COL32(12, 16, 20, 200), pad);
    shadowed(draw, font, at, widgets::kCaution, letters);
  };
  side({rect.x + edge, middle_y}, left);
  side({rect.x + rect.width - edge - wide(right), middle_y}, right);
  side({middle_x - wide(top) / 2, rect.y + edge}, top);
  side({middle_x - wide(bottom) / 2, rect.y + rect.height - edge - high}, bottom);
  // The scale, with its ends.
  const double length = scale_mm(rect.width * mm_per_px_);
  const auto bar = static_cast<float>(length / mm_per_px_);
  const ImVec2 from(rect.x + rect.width - edge - bar, rect.y + rect.height - edge - ui.theme.px(4));
  const ImVec2 to(from.x + bar, from.y);
  draw.AddLine(from, to, widgets::kText, ui.theme.px(2));
  for (const ImVec2& end : {from, to})
    draw.AddLine({end.x, end.y - ui.theme.px(5)}, {end.x, end.y + ui.theme.px(3)}, widgets::kText,
                 ui.theme.px(2));
  const std::string text = widgets::fixed(length, 0) + " mm";
  shadowed(draw, ui.theme.body,
           {to.x - ui.theme.body->CalcTextSizeA(ui.theme.body->FontSize, 1e9F, 0, text.c_str()).x,
            from.y - ui.theme.body->FontSize - ui.theme.px(4)},
           widgets::kText, text);
  const std::string place =
      content.place.empty() ? place_in_words(normal(), content.cross_mm) : content.place;
  const float row = ui.theme.body->FontSize, lowest = rect.y + rect.height - edge - row;
  shadowed(draw, ui.theme.body, {rect.x + edge, lowest}, widgets::kQuietText, place);
  shadowed(draw, ui.theme.body, {rect.x + edge, lowest - row}, widgets::kQuietText,
           window_in_words(content.window));
  draw.AddRect(rect.min(), rect.max(), widgets::kPanelEdge);
}

}  // namespace arthronaut::plan
