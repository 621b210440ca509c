// Lines that break at spaces alone, and not between a number and its unit. ImGui also breaks them after a
// full stop or a comma, and so within a number: "75." and below it "0 deg".
#pragma once

#include <imgui.h>

#include <string>
#include <string_view>

namespace arthronaut::widgets {

// The text with line ends put in, so that no line is wider than width_px but of a single word. Line ends that
// it has stay.
[[nodiscard]] std::string wrapped(const ImFont* font, std::string_view text, float width_px);

// The text in as many lines as fit one below the other, in the largest letters that show all of it: the
// font's own, or smaller ones. Where the smallest that can be read are too large its end is cut, "...".
struct LinesWithin {
  std::string lines;
  float letters_px = 0;
};
[[nodiscard]] LinesWithin lines_within(const ImFont* font, std::string_view text, float width_px,
                                       float height_px);

}  // namespace arthronaut::widgets
