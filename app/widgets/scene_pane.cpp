#include "app/widgets/scene_pane.h"

#include "app/widgets/draw_damage.h"
#include "app/widgets/held_mouse.h"

namespace arthronaut::widgets {

namespace {

constexpr double kStillAfter_s = 0.25;
constexpr float kMostPixelsWhenStill = 8e6F;
constexpr float kClickTravel_px = 4;
constexpr float kDragTravel_px = 3;  // a hand that clicks on a handle trembles less

Eigen::Vector2d vector(const ImVec2& v) { return {v.x, v.y}; }

}  // namespace

ScenePane::ScenePane(std::function<void()> make_current) : make_current_(std::move(make_current)) {}

scene::SceneView& ScenePane::view() {
  if (view_ == nullptr) view_ = std::make_unique<scene::SceneView>(make_current_);
  return *view_;
}

void ScenePane::show(const scene::SceneContent& content) {
  view().show(content);
  changed_ = true;
}

PaneInput ScenePane::draw(const Ui& ui, const char* name, const Rect& rect,
                          const std::function<bool(const Eigen::Vector2d&)>& is_handle) {
  PaneInput input;
  if (rect.width < 2 || rect.height < 2) return input;
  ImGui::SetCursorScreenPos(rect.min());
  ImGui::PushID(name);
  ImGui::InvisibleButton("view", {rect.width, rect.height},
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
  const ImGuiIO& io = ImGui::GetIO();
  input.is_hovered = ImGui::IsItemHovered();
  input.mouse_px = vector(io.MousePos) - vector(rect.min());
  input.size_px = {rect.width, rect.height};
  const bool left = ImGui::IsMouseDown(ImGuiMouseButton_Left);
  if (ImGui::IsItemActivated()) {
    press_travel_px_ = 0;
    press_px_ = input.mouse_px;
    drags_handle_ = left && is_handle && is_handle(input.mouse_px);
    input.handle_pressed = drags_handle_;
  }
  if (ImGui::IsItemActive()) {
    press_travel_px_ += vector(held_mouse_way_px()).norm();
    input.handle_dragged = drags_handle_ && press_travel_px_ >= kDragTravel_px;
  }
  if (ImGui::IsItemDeactivated()) {
    input.was_clicked = !drags_handle_ && press_travel_px_ < kClickTravel_px && input.is_hovered &&
                        ImGui::IsMouseReleased(ImGuiMouseButton_Left);
    drags_handle_ = false;
    // A slow frame sees the button let go where the mouse has gone since.
    if (input.was_clicked) input.mouse_px = press_px_;
  }
  follow_mouse(input);
  ui.log.note(name, rect.min(), rect.max());
  ImGui::PopID();
  render(ui, rect);
  return input;
}

void ScenePane::follow_mouse(const PaneInput& input) {
  const ImGuiIO& io = ImGui::GetIO();
  const Eigen::Vector2d drag = vector(held_mouse_way_px());
  if (ImGui::IsItemActive() && !drags_handle_ && !drag.isZero(0)) {
    camera_ = ImGui::IsMouseDown(ImGuiMouseButton_Left) ? scene::orbited(camera_, drag, input.size_px.y())
                                                        : scene::panned(camera_, drag, input.size_px.y());
  }
  if (input.is_hovered && io.MouseWheel != 0) camera_ = scene::zoomed(camera_, io.MouseWheel);
}

void ScenePane::render(const Ui& ui, const Rect& rect) {
  if (!(camera_ == drawn_camera_)) changed_ = true;
  if (changed_) changed_at_s_ = ui.now_s;
  const bool is_still = ui.now_s - changed_at_s_ > kStillAfter_s;
  const bool is_large = is_still && smooths_ && rect.width * rect.height * 4 < kMostPixelsWhenStill;
  const float factor = is_large ? 2 : 1;
  scene::SceneView& drawn = view();
  drawn.set_still(is_still);
  drawn.resize(static_cast<int>(rect.width * factor), static_cast<int>(rect.height * factor));
  drawn.look(camera_);
  {
    const WidgetLog::Timed timed(ui.log, "scene_ms");
    if (drawn.render_if_dirty()) {
      ui.log.add("scenes", 1);
      ++version_;
    }
  }
  drawn_camera_ = camera_;
  changed_ = false;
  const auto texture = static_cast<std::uintptr_t>(drawn.texture());
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  shows_version(draw, version_);
  draw.AddImageRounded(reinterpret_cast<ImTextureID>(texture), rect.min(), rect.max(), {0, 1}, {1, 0},
                       IM_COL32_WHITE, ui.theme.px(6));
  draw.AddCallback(ImDrawCallback_ResetRenderState, nullptr);
}

}  // namespace arthronaut::widgets
