#include "app/widgets/tooltip.h"

#include "app/widgets/wrapped_text.h"

namespace arthronaut::widgets {

void tooltip(const Theme& theme, std::string_view text) {
  ImGui::BeginTooltip();
  ImGui::PushFont(theme.body);
  ImGui::PushTextWrapPos(theme.px(560));
  const std::string lines = wrapped(theme.body, text, theme.px(560));
  ImGui::TextUnformatted(lines.data(), lines.data() + lines.size());
  ImGui::PopTextWrapPos();
  ImGui::PopFont();
  ImGui::EndTooltip();
}

}  // namespace arthronaut::widgets
