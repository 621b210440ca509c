#include "app/plan/pane_keys.h"

#include <GLFW/glfw3.h>

#include <array>
#include <tuple>

namespace arthronaut::plan {

void add_pane_keys(widgets::Actions& actions, const PaneKeys& keys) {
  struct Arrow {
    std::string word;
    int key;
    Eigen::Vector2d way;
  };
  const std::array<Arrow, 4> arrows{Arrow{"left", GLFW_KEY_LEFT, {-1, 0}},
                                    Arrow{"right", GLFW_KEY_RIGHT, {1, 0}}, Arrow{"up", GLFW_KEY_UP, {0, -1}},
                                    Arrow{"down", GLFW_KEY_DOWN, {0, 1}}};
  const auto add = [&](const std::string& name, const std::string& label, const std::string& hint, int key,
                       int modifiers, const std::function<bool()>& is_possible, std::function<void()> act) {
    actions.add({keys.mode + "." + name, label, hint, key, modifiers, true, is_possible, {}, std::move(act)});
  };
  for (const Arrow& arrow : arrows) {
    add(keys.move_name + "_" + arrow.word, keys.move_label + " " + arrow.word, keys.move_hint, arrow.key,
        GLFW_MOD_ALT, keys.is_possible, [move = keys.move, way = arrow.way] { move(way); });
    add("shift_" + arrow.word, "Shift " + arrow.word, keys.shift_hint, arrow.key,
        GLFW_MOD_CONTROL | GLFW_MOD_SHIFT, keys.is_possible,
        [shift = keys.shift, way = arrow.way] { shift(kKeyedShift_px * way); });
  }
  for (const auto& [name, label, key, steps] : {std::tuple{"zoom_in", "Zoom in", GLFW_KEY_EQUAL, 1.0},
                                                std::tuple{"zoom_out", "Zoom out", GLFW_KEY_MINUS, -1.0}})
    add(name, label, keys.zoom_hint, key, GLFW_MOD_CONTROL, keys.is_possible,
        [zoom = keys.zoom, by = steps] { zoom(by); });
  for (const auto& [name, label, key, images] :
       {std::tuple{"next_image", "Next image", GLFW_KEY_PAGE_UP, 1},
        std::tuple{"image_before", "Image before", GLFW_KEY_PAGE_DOWN, -1}})
    add(name, label, keys.scroll_hint, key, GLFW_MOD_SHIFT, keys.can_scroll,
        [scroll = keys.scroll, by = images] { scroll(by); });
}

std::optional<std::size_t> pressed_pane(std::span<const widgets::Rect> panes) {
  const ImGuiIO& io = ImGui::GetIO();
  if (!io.MouseClicked[0] && !io.MouseClicked[1] && !io.MouseClicked[2]) return std::nullopt;
  for (std::size_t i = 0; i < panes.size(); ++i)
    if (panes[i].contains(io.MousePos)) return i;
  return std::nullopt;
}

void frame_keyed_pane(const widgets::Ui& ui, const widgets::Rect& pane) {
  ImGui::GetWindowDrawList()->AddRect(pane.min(), pane.max(), widgets::kAccent, 0, 0, ui.theme.px(2));
}

}  // namespace arthronaut::plan
