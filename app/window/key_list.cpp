#include "app/window/key_list.h"

#include <algorithm>
#include <iterator>

#include "app/widgets/wrapped_text.h"

namespace arthronaut::window {

namespace {

std::size_t line_count(const std::string& words) {
  return 1 + static_cast<std::size_t>(std::ranges::count(words, '\n'));
}

}  // namespace

KeyListLayout key_list_layout(const ImFont* font, const std::vector<std::string>& explanations, float room_px,
                              float height_px) {
  constexpr float kLeast = 0.4F, kSmaller = 0.96F, kLine = 1.25F;
  KeyListLayout layout;
  for (float share = 1; share >= kLeast; share *= kSmaller) {
    layout.letters_px = share * font->FontSize;
    layout.words.clear();
    std::size_t all = 0;
    for (const std::string& one : explanations) {
      layout.words.push_back(widgets::wrapped(font, one, room_px / share));
      all += line_count(layout.words.back());
    }
    // The left column is the longer one, by no more than its last explanation.
    std::size_t left = 0, i = 0;
    while (i < layout.words.size() && 2 * left < all) left += line_count(layout.words[i++]);
    layout.first_on_the_right = i;
    const std::size_t rows = std::max<std::size_t>({left, all - left, 1});
    layout.line_px = std::min(1.7F * layout.letters_px, height_px / static_cast<float>(rows));
    if (layout.line_px >= kLine * layout.letters_px) return layout;
  }
  return layout;
}

std::vector<KeyRow> key_rows(const widgets::Actions& actions, const std::vector<std::string_view>& prefixes,
                             const std::vector<mode::HeldKeys>& held) {
  std::vector<KeyRow> here, everywhere;
  std::string not_now;
  for (const mode::HeldKeys& keys : held) here.push_back({keys.keys, keys.words});
  for (const widgets::Action& action : actions.all()) {
    const bool is_shown = std::any_of(prefixes.begin(), prefixes.end(),
                                      [&](std::string_view prefix) { return action.id.starts_with(prefix); });
    if (!is_shown || action.key == 0) continue;
    const std::string key = widgets::key_name(action.key, action.mods);
    if (!action.can_run()) {
      not_now += (not_now.empty() ? "" : ", ") + action.label + " (" + key + ")";
      continue;
    }
    const bool is_of_window = action.id.starts_with("app.") || action.id.starts_with("mode.");
    (is_of_window ? everywhere : here).push_back({key, action.label + ": " + action.tooltip});
  }
  std::vector<KeyRow> rows;
  const auto append = [&](const char* heading, std::vector<KeyRow> part) {
    if (part.empty()) return;
    rows.push_back({"", heading, KeyUse::Heading});
    std::ranges::move(part, std::back_inserter(rows));
  };
  append("On this screen, now", std::move(here));
  append("Everywhere", std::move(everywhere));
  if (!not_now.empty()) append("Not possible now", {{"", not_now, KeyUse::NotNow}});
  return rows;
}

bool draw_key_list(const widgets::Ui& ui, const std::vector<KeyRow>& shown) {
  std::vector<std::string> explanations;
  for (const KeyRow& row : shown) explanations.push_back(row.words);
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImDrawList& draw = *ImGui::GetForegroundDrawList();
  draw.AddRectFilled({0, 0}, size, IM_COL32(6, 8, 10, 244));
  const float key_width = ui.theme.px(150), column_width = std::min(ui.theme.px(900), size.x / 2);
  const float left = size.x / 2 - column_width + ui.theme.px(16);
  const float head = ui.theme.title->FontSize + ui.theme.px(16), margin = ui.theme.px(12);
  const KeyListLayout layout = key_list_layout(
      ui.theme.body, explanations, column_width - key_width - ui.theme.px(24), size.y - head - 2 * margin);
  draw.AddText(ui.theme.title, ui.theme.title->FontSize, {left, margin}, widgets::kText, "Keys (F10 closes)");
  float x = left, y = margin + head;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    if (i == layout.first_on_the_right) {
      x += column_width;
      y = margin + head;
    }
    const bool is_heading = shown[i].use == KeyUse::Heading, is_now = shown[i].use == KeyUse::Now;
    draw.AddText(ui.theme.strong, layout.letters_px, {x, y}, widgets::kAccent, shown[i].key.c_str());
    const float words_x = is_now ? x + key_width : x;
    ImFont* const font = is_heading ? ui.theme.strong : ui.theme.body;
    float at = y;
    for (std::size_t from = 0, to = 0; from <= layout.words[i].size(); from = to + 1, at += layout.line_px) {
      to = std::min(layout.words[i].find('\n', from), layout.words[i].size());
      const std::string line = layout.words[i].substr(from, to - from);
      draw.AddText(font, layout.letters_px, {words_x, at},
                   is_now || is_heading ? widgets::kText : widgets::kQuietText, line.c_str());
    }
    y = at;
  }
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize(size);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::Begin("keys", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav);
  ImGui::PopStyleVar();
  const bool is_clicked = ImGui::InvisibleButton("cover", size);
  ImGui::End();
  return is_clicked;
}

}  // namespace arthronaut::window
