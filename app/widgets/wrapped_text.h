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

}  // namespace arthronaut::widgets
