#include "app/widgets/tooltip.h"

namespace arthronaut::widgets {

void tooltip(const Theme& theme, std::string_view text) {
  ImGui::BeginTooltip();
  ImGui::PushFont(theme.body);
  ImGui::PushTextWrapPos(theme.px(560));
  ImGui::TextUnformatted(text.data(), text.data() + text.size());
  ImGui::PopTextWrapPos();
  ImGui::PopFont();
  ImGui::EndTooltip();
}

}  // namespace arthronaut::widgets
