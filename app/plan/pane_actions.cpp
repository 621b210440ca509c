// What the mouse does in the 3D view and in the slices, by keys: they act in one of them, which is framed.
#include <GLFW/glfw3.h>

#include <array>
#include <utility>

#include "app/plan/pane_keys.h"
#include "app/plan/plan_view.h"
#include "app/plan/tunnel_moves.h"

namespace arthronaut::plan {

namespace {

// What a press does, as if the mouse were drawn over so many pixels of a view 1000 high: 6 degrees.
constexpr double kHeight_px = 1000, kTurn_px = 28;
constexpr double kReach_mm = 5;  // from the cross-hair of a slice to the surface that a click is meant for
constexpr std::array kPaneNames{"3D view", "upper slice", "lower left slice", "lower right slice"};

}  // namespace

std::optional<std::size_t> PlanView::keyed_slice() const {
  if (!state_.shows_slices || slices_.volume() == nullptr || state_.keyed_pane == 0) return std::nullopt;
  return state_.keyed_pane - 1;
}

void PlanView::draw_keyed_pane(const widgets::Ui& ui, const std::array<widgets::Rect, 4>& panes) {
  if (const auto pressed = pressed_pane(panes)) state_.keyed_pane = *pressed;
  frame_keyed_pane(ui, panes[state_.keyed_pane]);
}

void PlanView::draw_aiming_cross(const widgets::Ui& ui, const widgets::Rect& area) const {
  if (state_.placing == Placing::Nothing || keyed_slice()) return;
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 middle = area.center();
  const float reach = ui.theme.px(14), gap = ui.theme.px(4);
  // With a dark seam: it is read over bone and tunnels alike.
  for (const auto& [color, wide] : {std::pair{widgets::kBackground, 5.F}, std::pair{widgets::kText, 2.F}})
    for (const float sign : {-1.F, 1.F}) {
      draw.AddLine({middle.x + sign * gap, middle.y}, {middle.x + sign * reach, middle.y}, color,
                   ui.theme.px(wide));
      draw.AddLine({middle.x, middle.y + sign * gap}, {middle.x, middle.y + sign * reach}, color,
                   ui.theme.px(wide));
    }
}

void PlanView::click_here() {
  const auto slice = keyed_slice();
  if (slice && slices_.tool() != MeasuringTool::None) return slices_.measure_here();
  if (!slice) {
    const scene::SceneCamera& camera = bones_.camera();
    const scene::SceneRay ahead{camera.position_mm, scene::axes_of(camera).ahead};
    return state_.placing == Placing::Entry ? place_entry(ahead) : place_landmark(ahead);
  }
  const bool is_landmark = state_.placing == Placing::Landmark;
  const Eigen::Vector3d here = slices_.cross_mm();
  const Eigen::Vector3d on_bone = model_->surface(state_.key.bone).closest_point(here).point_mm;
  if (is_landmark && lies_within_bone(landmark())) return put_landmark_there(here);
  if (const double off_mm = (on_bone - here).norm(); off_mm > kReach_mm) {
    state_.hint = {"The cross-hair is " + widgets::fixed(off_mm, 0) + " mm from the surface of the " +
                   std::string(bones::to_text(state_.key.bone)) + ". Move it there, or press Esc."};
    return;
  }
  is_landmark ? put_landmark_there(on_bone) : put_entry_there(on_bone);
}

void PlanView::add_pane_actions(widgets::Actions& actions) {
  actions.add({"plan.next_pane",
               "Next pane",
               "Keys that turn, move, shift and zoom act in another one: the 3D view, or a slice",
               GLFW_KEY_S,
               GLFW_MOD_SHIFT,
               false,
               [this] { return state_.shows_slices && slices_.volume() != nullptr; },
               {},
               [this] { state_.keyed_pane = (state_.keyed_pane + 1) % kPaneNames.size(); }});
  const auto has_pane = [this] { return keyed_slice() || (model_ != nullptr && !state_.shows_lateral); };
  add_pane_keys(actions, {.mode = "plan",
                          .move_name = "turn",
                          .move_label = "Turn",
                          .move_hint = "Turns the 3D view by 6 degrees; in a slice it moves the cross-hair",
                          .shift_hint = "Shifts the picture",
                          .zoom_hint = "The picture, about its middle; a slice about its cross-hair",
                          .scroll_hint = "In the framed slice, as the wheel",
                          .is_possible = has_pane,
                          .can_scroll = [this] { return keyed_slice().has_value(); },
                          .move =
                              [this](const Eigen::Vector2d& way) {
                                if (const auto slice = keyed_slice())
                                  return slices_.move_cross(*slice, kKeyedCross_px * way);
                                bones_.look(scene::orbited(bones_.camera(), kTurn_px * way, kHeight_px));
                              },
                          .shift =
                              [this](const Eigen::Vector2d& by_px) {
                                if (const auto slice = keyed_slice()) return slices_.shift(*slice, by_px);
                                bones_.look(scene::panned(bones_.camera(), by_px, kHeight_px));
                              },
                          .zoom =
                              [this](double steps) {
                                if (const auto slice = keyed_slice()) return slices_.zoom(*slice, steps);
                                bones_.look(scene::zoomed(bones_.camera(), steps));
                              },
                          .scroll = [this](int images) { slices_.scroll(*keyed_slice(), images); }});
  actions.add(
      {"plan.click_here",
       "Click here",
       "Places, or sets a measuring's point: at the framed slice's cross-hair, or in the 3D view's middle",
       GLFW_KEY_SPACE,
       0,
       false,
       [this] {
         return model_ != nullptr && (state_.placing != Placing::Nothing ||
                                      (keyed_slice() && slices_.tool() != MeasuringTool::None));
       },
       {},
       [this] { click_here(); }});
}

}  // namespace arthronaut::plan
