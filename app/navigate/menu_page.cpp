#include "app/navigate/menu_page.h"

#include <algorithm>
#include <array>

namespace arthronaut::navigate {

namespace {

// Of the operation, in the order of its steps.
constexpr std::array<std::string_view, 19> kOperation{
    "navigate.back",          "navigate.stop",        "navigate.digitise",       "navigate.register",
    "navigate.take_back",     "navigate.exclude",     "navigate.clear",          "navigate.touch",
    "navigate.control_point", "navigate.check_guide", "navigate.forget_touches", "navigate.earlier",
    "navigate.later",         "navigate.depth_stop",  "navigate.drilled",        "navigate.marker_anew",
    "navigate.bone",          "navigate.tunnel_am",   "navigate.tunnel_pl"};
// Two buttons stand before them, and three stand in a row.
constexpr std::array<std::string_view, 22> kRest{"navigate.panel",
                                                 "navigate.overlay",
                                                 "navigate.undistort",
                                                 "navigate.sounds",
                                                 "navigate.record",
                                                 "navigate.camera",
                                                 "navigate.address",
                                                 "navigate.pictures_as_came",
                                                 "navigate.pictures_lossless",
                                                 "navigate.pictures_h264",
                                                 "navigate.video",
                                                 "navigate.scratch",
                                                 "navigate.drill",
                                                 "navigate.medium",
                                                 "mode.plan",
                                                 "mode.setup",
                                                 "mode.review",
                                                 "app.screenshot",
                                                 "app.record_screen",
                                                 "app.send_screen",
                                                 "app.keys",
                                                 "app.quit"};

}  // namespace

std::vector<std::string_view> menu_page(bool shows_more,
                                        const std::function<bool(std::string_view)>& can_run) {
  std::vector<std::string_view> ids{"navigate.menu", "navigate.more"};
  if (shows_more) ids.insert(ids.end(), kRest.begin(), kRest.end());
  for (const std::string_view id : kOperation)
    if (can_run(id) != shows_more) ids.push_back(id);
  return ids;
}

widgets::Rect cut_menu_states(widgets::Rect& area, std::size_t button_count, float scale) {
  constexpr float kLeast_px = 150;  // five lines
  constexpr auto kColumns = static_cast<std::size_t>(kMenuColumns);
  const auto rows = static_cast<float>((button_count + kColumns - 1) / kColumns);
  const float left = area.height - rows * menu_row_height(scale);
  if (left < kLeast_px * scale) return {area.x, area.y + area.height, area.width, 0};
  return area.cut_bottom(left);
}

}  // namespace arthronaut::navigate
