// Which buttons the theatre's menu shows: on its first page what can be used in the operation now, behind
// "More" everything else, sources and window among it, what can't be used greyed. So the first page never
// takes the room of the states that stand under it. Pure.
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "app/widgets/layout.h"

namespace arthronaut::navigate {

inline constexpr int kMenuColumns = 3;

// Ids of actions, in their order; the two pages together hold every one of them.
[[nodiscard]] std::vector<std::string_view> menu_page(bool shows_more,
                                                      const std::function<bool(std::string_view)>& can_run);

// Cuts the states' panel off the bottom of the area, where there is room for it below this many buttons; else
// it is empty, and the buttons have all of it.
[[nodiscard]] widgets::Rect cut_menu_states(widgets::Rect& area, std::size_t button_count, float scale);
// Of one button and the gap below it.
[[nodiscard]] inline float menu_row_height(float scale) { return 42 * scale; }

}  // namespace arthronaut::navigate
