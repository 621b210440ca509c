// What the mouse does in a pane, by keys: wherever several panes stand side by side they act in one, which is
// framed, and are the same keys.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "app/widgets/actions.h"
#include "app/widgets/controls.h"
#include "app/widgets/layout.h"

namespace arthronaut::plan {

// What a press does, as if the mouse were drawn over so many pixels: of a slice, zoomed in it moves less.
inline constexpr double kKeyedCross_px = 2, kKeyedShift_px = 30;

struct PaneKeys {
  std::string mode;                   // "plan": with what the names of the actions begin
  std::string move_name, move_label;  // "turn", "Turn": by Alt and the arrows
  std::string move_hint, shift_hint, zoom_hint, scroll_hint;
  std::function<bool()> is_possible, can_scroll;
  std::function<void(const Eigen::Vector2d& way)> move;  // one of the screen's four, rows down, of length 1
  std::function<void(const Eigen::Vector2d& by_px)> shift;  // Ctrl, Shift and the arrows
  std::function<void(double steps)> zoom;                   // Ctrl with + and -
  std::function<void(int images)> scroll;                   // Shift with Page up and down
};
void add_pane_keys(widgets::Actions& actions, const PaneKeys& keys);

// In which a button of the mouse was pressed now: keys follow it.
[[nodiscard]] std::optional<std::size_t> pressed_pane(std::span<const widgets::Rect> panes);
void frame_keyed_pane(const widgets::Ui& ui, const widgets::Rect& pane);

}  // namespace arthronaut::plan
