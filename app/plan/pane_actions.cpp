// What the mouse does in the 3D view and in the slices, by keys: they act in one of them, which is framed.
#include <GLFW/glfw3.h>

#include <array>
#include <tuple>
#include <utility>

#include "app/plan/plan_view.h"
#include "app/plan/tunnel_moves.h"

namespace arthronaut::plan {

namespace {

// What a press does, as if the mouse were drawn over so many pixels of a view 1000 high: 6 degrees, 3 % of
// it.
constexpr double kHeight_px = 1000, kTurn_px = 28, kShift_px = 30;
constexpr double kCross_px = 2;  // of the slice: zoomed in it moves less
constexpr double kReach_mm = 5;  // from the cross-hair of a slice to the surface that a click is meant for
constexpr std::array kPaneNames{"3D view", "upper slice", "lower left slice", "lower right slice"};

}  // namespace

std::optional<std::size_t> PlanView::keyed_slice() const {
  if (!state_.shows_slices || slices_.volume() == nullptr || state_.keyed_pane == 0) return std::nullopt;
  return state_.keyed_pane - 1;
}

void PlanView::draw_keyed_pane(const widgets::Ui& ui, const std::array<widgets::Rect, 4>& panes) {
  const ImGuiIO& io = ImGui::GetIO();
  for (std::size_t i = 0; i < panes.size(); ++i)
    if (panes[i].contains(io.MousePos) && (io.MouseClicked[0] || io.MouseClicked[1] || io.MouseClicked[2]))
      state_.keyed_pane = i;
  const widgets::Rect& pane = panes[state_.keyed_pane];
  ImGui::GetWindowDrawList()->AddRect(pane.min(), pane.max(), widgets::kAccent, 0, 0, ui.theme.px(2));
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
  struct Arrow {
    std::string word;
    int key;
    Eigen::Vector2d way;  // of the screen, rows down
  };
  const std::array<Arrow, 4> arrows{Arrow{"left", GLFW_KEY_LEFT, {-1, 0}},
                                    Arrow{"right", GLFW_KEY_RIGHT, {1, 0}}, Arrow{"up", GLFW_KEY_UP, {0, -1}},
                                    Arrow{"down", GLFW_KEY_DOWN, {0, 1}}};
  for (const Arrow& arrow : arrows) {
    actions.add({"plan.turn_" + arrow.word,
                 "Turn " + arrow.word,
                 "Turns the 3D view by 6 degrees; in a slice it moves the cross-hair",
                 arrow.key,
                 GLFW_MOD_ALT,
                 true,
                 has_pane,
                 {},
                 [this, way = arrow.way] {
                   if (const auto slice = keyed_slice()) return slices_.move_cross(*slice, kCross_px * way);
                   bones_.look(scene::orbited(bones_.camera(), kTurn_px * way, kHeight_px));
                 }});
    actions.add({"plan.shift_" + arrow.word,
                 "Shift " + arrow.word,
                 "Shifts the picture",
                 arrow.key,
                 GLFW_MOD_CONTROL | GLFW_MOD_SHIFT,
                 true,
                 has_pane,
                 {},
                 [this, way = arrow.way] {
                   if (const auto slice = keyed_slice()) return slices_.shift(*slice, kShift_px * way);
                   bones_.look(scene::panned(bones_.camera(), kShift_px * way, kHeight_px));
                 }});
  }
  for (const auto& [id, label, key, steps] : {std::tuple{"plan.zoom_in", "Zoom in", GLFW_KEY_EQUAL, 1.0},
                                              std::tuple{"plan.zoom_out", "Zoom out", GLFW_KEY_MINUS, -1.0}})
    actions.add({id,
                 label,
                 "The picture, about its middle; a slice about its cross-hair",
                 key,
                 GLFW_MOD_CONTROL,
                 true,
                 has_pane,
                 {},
                 [this, by = steps] {
                   if (const auto slice = keyed_slice()) return slices_.zoom(*slice, by);
                   bones_.look(scene::zoomed(bones_.camera(), by));
                 }});
  for (const auto& [id, label, key, images] :
       {std::tuple{"plan.next_image", "Next image", GLFW_KEY_PAGE_UP, 1},
        std::tuple{"plan.image_before", "Image before", GLFW_KEY_PAGE_DOWN, -1}})
    actions.add({id,
                 label,
                 "In the framed slice, as the wheel",
                 key,
                 GLFW_MOD_SHIFT,
                 true,
                 [this] { return keyed_slice().has_value(); },
                 {},
                 [this, by = images] { slices_.scroll(*keyed_slice(), by); }});
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
