// Where what is said of a thing lies on the screen: beside it, and over nothing that may be clicked next.
#pragma once

#include <vector>

#include "app/widgets/layout.h"

namespace arthronaut::widgets {

// The upper left corner of a tooltip of this size within the screen: of the places that cover nothing of
// `about` and `clear_of` the nearest to `about`; where there is none the one that covers least.
[[nodiscard]] ImVec2 tooltip_place(const Rect& about, const ImVec2& size, const Rect& screen, float gap,
                                   const std::vector<Rect>& clear_of);

}  // namespace arthronaut::widgets
