#include "app/plan/bone_pane.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <utility>

#include "app/plan/edge_words.h"
#include "app/plan/pane_text.h"
#include "app/scene/lateral_plane.h"
#include "app/scene/notch_cut.h"
#include "app/widgets/tooltip.h"

namespace arthronaut::plan {

namespace {

using bones::BoneKind;

// Of a sign's size: what is pressed beyond that is the view, which is turned.
constexpr double kReach = 1.2;
constexpr double kSeeThroughOpacity = 0.3;  // of 10 mm of bone in the images
constexpr ImU32 kHidden = IM_COL32(232, 237, 242, 110);

std::optional<BoneKind> only_bone_of(scene::ViewDirection view) {
  if (view == scene::ViewDirection::Distal || view == scene::ViewDirection::Notch) return BoneKind::Femur;
  if (view == scene::ViewDirection::Plateau) return BoneKind::Tibia;
  return std::nullopt;
}

float radius_px(const PaneMark& mark) {
  if (mark.id.empty()) return 4;  // one of many
  return mark.shape == PaneMark::Shape::Cross || mark.shape == PaneMark::Shape::Pin ? 8 : 13;
}

// Whether the point lies in a closed line, by how often a ray from it crosses.
bool holds(const std::vector<Eigen::Vector2d>& line, const Eigen::Vector2d& point) {
  bool is_inside = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Eigen::Vector2d &a = line[i], &b = line[(i + 1) % line.size()];
    if ((a.y() > point.y()) != (b.y() > point.y()) &&
        point.x() < a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
      is_inside = !is_inside;
  }
  return is_inside;
}

}  // namespace

BonePane::BonePane(std::function<void()> make_current) : pane_(std::move(make_current)) {}

void BonePane::open(const open_case::PlanModel* model) {
  model_ = model;
  beside_ = {};
  volume_.reset();
  is_see_through_ = false;
  held_.clear();
  look_from(scene::ViewDirection::Anterior);
}

void BonePane::look_from(scene::ViewDirection view) {
  looked_from_ = view;
  only_ = only_bone_of(view);
  if (only_ && !model_->has_bone(*only_)) only_.reset();
  const BoneKind of = only_.value_or(model_->has_bone(BoneKind::Femur) ? BoneKind::Femur : BoneKind::Tibia);
  cut_.reset();
  if (view == scene::ViewDirection::Notch && of == BoneKind::Femur) cut_ = model_->notch_cut();
  geometry::Bounds joint = model_->joint_bounds(only_);
  if (const auto& quadrant = model_->surroundings(of).quadrant;
      quadrant && view == scene::ViewDirection::Notch)
    joint = scene::with_grid(joint, *quadrant);
  const scene::SceneCamera camera = scene::look_from(view, model_->axes(of), joint, aspect_);
  open_ = {(joint.min_mm + joint.max_mm) / 2, (camera.position_mm - camera.focus_mm).normalized()};
  pane_.look(camera);
  named_ = camera;
  is_stale_ = true;
}

bool BonePane::is_seen_from(scene::ViewDirection view) const {
  constexpr double kSame = 1e-6;
  const auto direction = [](const scene::SceneCamera& camera) -> Eigen::Vector3d {
    return (camera.focus_mm - camera.position_mm).normalized();
  };
  return looked_from_ == view && (direction(camera()) - direction(named_)).norm() < kSame &&
         (camera().up.normalized() - named_.up.normalized()).norm() < kSame;
}

void BonePane::look_at(const Eigen::Vector3d& point_mm, BoneKind bone) {
  constexpr double kAway_mm = 160;
  looked_from_.reset();
  only_ = bone;
  cut_.reset();
  is_stale_ = true;
  const landmarks::AnatomicalAxes& axes = model_->axes(bone);
  Eigen::Vector3d outwards = model_->surface(bone).closest_point(point_mm).normal;
  if (is_hidden(visible(), point_mm + kAway_mm * outwards, point_mm)) {
    // In a hollow: from the first of these sides that sees it.
    for (const Eigen::Vector3d& side : {Eigen::Vector3d(-axes.proximal), Eigen::Vector3d(axes.anterior),
                                        Eigen::Vector3d(-axes.anterior), Eigen::Vector3d(axes.proximal)})
      if (!is_hidden(visible(), point_mm + kAway_mm * side, point_mm)) {
        outwards = side;
        break;
      }
  }
  const Eigen::Vector3d up = std::abs(outwards.dot(axes.proximal)) > 0.9 ? axes.anterior : axes.proximal;
  open_ = {point_mm, outwards};
  pane_.look(scene::look_along(-outwards, point_mm, kAway_mm, up));
}

void BonePane::see_through(bool on) {
  is_see_through_ = on;
  is_stale_ = true;
}

void BonePane::set_content(scene::SceneContent beside_the_bones) {
  beside_ = std::move(beside_the_bones);
  is_stale_ = true;
}

VisibleBones BonePane::visible() const {
  VisibleBones seen;
  seen.cut = cut_;
  for (const BoneKind kind : {BoneKind::Femur, BoneKind::Tibia})
    if (model_->has_bone(kind) && shows(kind)) seen.bones.push_back({kind, &model_->surface(kind)});
  return seen;
}

void BonePane::show_volume(const std::shared_ptr<const scene::VolumeItem>& item) {
  if (item == volume_) return;
  volume_ = item;
  is_stale_ = true;
}

// Images show both bones; where one alone is looked at they end half way to the other.
std::optional<scene::CutPlane> BonePane::cut_of_other_bone() const {
  if (!only_ || !model_->has_bone(BoneKind::Femur) || !model_->has_bone(BoneKind::Tibia)) return std::nullopt;
  const Eigen::Vector3d& proximal = model_->axes(*only_).proximal;
  const auto height = [&](const Eigen::Vector3d& at) { return at.dot(proximal); };
  const auto& femur = model_->knee().bones.at(BoneKind::Femur).mesh.vertices_mm;
  const auto& tibia = model_->knee().bones.at(BoneKind::Tibia).mesh.vertices_mm;
  const Eigen::Vector3d& lowest = *std::ranges::min_element(femur, {}, height);
  const Eigen::Vector3d& highest = *std::ranges::max_element(tibia, {}, height);
  return scene::CutPlane{(lowest + highest) / 2, *only_ == BoneKind::Femur ? -proximal : proximal};
}

void BonePane::show() {
  scene::SceneContent content = beside_;
  if (volume_ != nullptr) {
    scene::VolumeItem item = *volume_;
    if (is_see_through_) item.opacity = kSeeThroughOpacity;
    for (const auto& cut : {cut_, cut_of_other_bone()})
      if (cut) item.cuts.push_back(*cut);
    if (item.preset == scene::VolumePreset::Grey && !cut_) item.cuts.push_back(open_);
    content.volume = std::make_shared<const scene::VolumeItem>(std::move(item));
    pane_.show(content);
    is_stale_ = false;
    return;
  }
  for (const BoneKind kind : {BoneKind::Femur, BoneKind::Tibia}) {
    if (!model_->has_bone(kind) || !shows(kind)) continue;
    content.bones.push_back(
        {model_->drawn_mesh(kind), scene::kBoneColor, is_see_through_ ? 0.42 : 1.0, cut_});
  }
  pane_.show(content);
  is_stale_ = false;
}

// Where the bone is translucent the eye sees what is behind it; not what is cut away.
bool BonePane::is_out_of_sight(const PaneMark& mark) const {
  const VisibleBones seen = visible();
  if (is_see_through_ || mark.shows_through) return seen.cut && seen.cut->cuts_away(mark.point_mm);
  return is_hidden(seen, pane_.camera().position_mm, mark.point_mm);
}

PaneEvent BonePane::draw(const widgets::Ui& ui, const widgets::Rect& area,
                         const std::vector<PaneMark>& marks) {
  aspect_ = area.width / std::max(area.height, 1.F);
  if (is_stale_) show();
  const Eigen::Vector2d size(area.width, area.height);
  const auto take_hold = [&](const Eigen::Vector2d& pixel) {
    held_.clear();
    double nearest = std::numeric_limits<double>::infinity();
    for (const PaneMark& mark : marks) {
      if (!mark.can_be_dragged) continue;
      const auto at = scene::project(pane_.camera(), mark.point_mm, size);
      if (!at) continue;
      const double away = (*at - pixel).norm();
      if (away >= nearest || away > kReach * ui.theme.px(radius_px(mark)) || is_out_of_sight(mark)) continue;
      nearest = away;
      held_ = mark.id;
      held_offset_px_ = *at - pixel;
    }
    return !held_.empty();
  };
  const widgets::PaneInput input = pane_.draw(ui, "plan.view", area, take_hold);
  const scene::SceneCamera& camera = pane_.camera();
  const Eigen::Vector3d right = (camera.focus_mm - camera.position_mm).cross(camera.up).normalized();
  const BoneKind axes_of =
      only_.value_or(model_->has_bone(BoneKind::Femur) ? BoneKind::Femur : BoneKind::Tibia);
  draw_edge_words(ui, area, edge_words(right, camera.up.normalized(), model_->axes(axes_of)));
  const bool is_resting = input.is_hovered && !input.handle_dragged;  // a tooltip would hide the place
  const bool has_said = draw_marks(ui, area, marks, is_resting);
  PaneEvent event;
  if (is_resting && !has_said)
    event.hover = scene::ray_through(pane_.camera(), input.mouse_px, input.size_px);
  if (input.was_clicked) event.click = scene::ray_through(pane_.camera(), input.mouse_px, input.size_px);
  if (input.handle_pressed) event.pressed = held_;
  if (input.handle_dragged) {
    event.dragged = held_;
    event.drag_ray = scene::ray_through(pane_.camera(), input.mouse_px + held_offset_px_, input.size_px);
  }
  return event;
}

std::vector<ImVec2> BonePane::handles_on_screen(const widgets::Rect& area,
                                                const std::vector<PaneMark>& marks) const {
  std::vector<ImVec2> handles;
  for (const PaneMark& mark : marks)
    if (const auto at = scene::project(pane_.camera(), mark.point_mm, {area.width, area.height});
        mark.can_be_dragged && at)
      handles.emplace_back(area.x + static_cast<float>(at->x()), area.y + static_cast<float>(at->y()));
  return handles;
}

std::vector<Eigen::Vector2d> BonePane::outline_on_screen(const std::vector<Eigen::Vector3d>& outline_mm,
                                                         const Eigen::Vector2d& size_px) const {
  std::vector<Eigen::Vector2d> outline;
  for (const Eigen::Vector3d& point : outline_mm)
    if (const auto pixel = scene::project(pane_.camera(), point, size_px)) outline.push_back(*pixel);
  return outline;
}

bool BonePane::draw_marks(const widgets::Ui& ui, const widgets::Rect& area,
                          const std::vector<PaneMark>& marks, bool is_hovered) const {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.PushClipRect(area.min(), area.max(), true);
  const Eigen::Vector2d size(area.width, area.height);
  const float line = ui.theme.px(3);
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const PaneMark* under_mouse = nullptr;
  std::vector<ImVec4> words;  // that were drawn, and the points of which there are many
  for (const PaneMark& mark : marks)
    if (const auto at = scene::project(pane_.camera(), mark.point_mm, size); at && mark.id.empty()) {
      const float x = area.x + static_cast<float>(at->x()), y = area.y + static_cast<float>(at->y());
      const float r = ui.theme.px(radius_px(mark));
      words.emplace_back(x - r, y - r, x + r, y + r);
    }
  for (const PaneMark& mark : marks) {
    const auto projected = scene::project(pane_.camera(), mark.point_mm, size);
    if (!projected) continue;
    const ImVec2 at(area.x + static_cast<float>(projected->x()), area.y + static_cast<float>(projected->y()));
    const bool is_behind = is_out_of_sight(mark), is_one_of_many = mark.id.empty();
    if (is_behind && is_one_of_many) continue;
    const ImU32 color = is_behind ? kHidden : mark.color;
    const float r = ui.theme.px(radius_px(mark));
    switch (mark.shape) {
      case PaneMark::Shape::Ring:
        draw.AddCircle(at, r, color, 32, is_behind ? line * 0.5F : line);
        if (!is_behind) draw.AddCircleFilled(at, r * 0.3F, color);
        break;
      case PaneMark::Shape::Diamond:
        if (!is_behind)
          draw.AddQuadFilled({at.x, at.y - r}, {at.x + r, at.y}, {at.x, at.y + r}, {at.x - r, at.y}, color);
        draw.AddQuad({at.x, at.y - r}, {at.x + r, at.y}, {at.x, at.y + r}, {at.x - r, at.y},
                     is_behind ? kHidden : widgets::kText, line * 0.7F);
        break;
      case PaneMark::Shape::Cross:
        draw.AddLine({at.x - r, at.y}, {at.x + r, at.y}, color, line * 0.7F);
        draw.AddLine({at.x, at.y - r}, {at.x, at.y + r}, color, line * 0.7F);
        break;
      case PaneMark::Shape::Pin:
        draw.AddTriangleFilled(at, {at.x - r * 0.7F, at.y - r * 1.6F}, {at.x + r * 0.7F, at.y - r * 1.6F},
                               color);
        break;
      case PaneMark::Shape::Dot:
        draw.AddCircleFilled(at, r, color);
        break;
      case PaneMark::Shape::Circle:
        draw.AddCircle(at, r, color, 12, line * 0.5F);
        break;
      case PaneMark::Shape::Saltire:
        draw.AddLine({at.x - r, at.y - r}, {at.x + r, at.y + r}, color, line * 0.5F);
        draw.AddLine({at.x - r, at.y + r}, {at.x + r, at.y - r}, color, line * 0.5F);
        break;
    }
    // What cannot be taken hold of is named where it is seen.
    if (!mark.word.empty() && (!is_behind || mark.can_be_dragged)) {
      const std::string word = mark.word + (is_behind ? " (behind)" : "");
      const ImFont* font = is_behind ? ui.theme.body : ui.theme.strong;
      const ImVec2 from{at.x, at.y - (mark.shape == PaneMark::Shape::Pin ? 2.1F * r : 0)};
      ImVec2 wide = font->CalcTextSizeA(font->FontSize, std::numeric_limits<float>::max(), 0, word.c_str());
      // Among many the number farther off would be read as that of another, and two that touch as one.
      if (is_one_of_many) wide.x += font->FontSize / 2;
      const std::optional<ImVec2> place = is_one_of_many
                                              ? free_place_on({0}, from, wide, r * 1.4F, area, words)
                                              : free_place(from, wide, r * 1.4F, area, words);
      if (place) {
        draw.AddText(font, font->FontSize, {place->x + 1, place->y + 1}, widgets::kBackground, word.c_str());
        draw.AddText(font, font->FontSize, *place, is_behind ? kHidden : widgets::kText, word.c_str());
      }
    }
    const bool is_near = std::abs(mouse.x - at.x) < r * 1.4F && std::abs(mouse.y - at.y) < r * 1.4F;
    const bool is_within = !is_near && !is_behind && !mark.area_mm.empty() &&
                           holds(outline_on_screen(mark.area_mm, size), {mouse.x - area.x, mouse.y - area.y});
    // What is nearer than an area tells more.
    if (is_hovered && !mark.tooltip.empty() && (is_near || (is_within && under_mouse == nullptr)))
      under_mouse = &mark;
    if (!is_one_of_many)
      ui.log.note("plan." + mark.id + "_handle", {at.x - r, at.y - r}, {at.x + r, at.y + r});
  }
  if (under_mouse != nullptr) widgets::tooltip_at_mouse(ui, under_mouse->tooltip);
  draw.PopClipRect();
  return under_mouse != nullptr;
}

}  // namespace arthronaut::plan
