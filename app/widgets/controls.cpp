#include "app/widgets/controls.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/widgets/tooltip.h"
#include "app/widgets/wrapped_text.h"
#include "planning/files/fixed_number.h"

namespace arthronaut::widgets {

namespace {

// With `wrap`, as draw_text() breaks it; words that are wider alone are left to ImGui.
ImVec2 text_size(ImFont* font, std::string_view text, float wrap = 0) {
  const std::string lines = wrap > 0 ? wrapped(font, text, wrap) : std::string();
  if (wrap > 0) text = lines;
  return font->CalcTextSizeA(font->FontSize, 1e9F, wrap, text.data(), text.data() + text.size());
}

void draw_text(ImDrawList& draw, ImFont* font, const ImVec2& at, ImU32 color, std::string_view text,
               float wrap = 0) {
  const std::string lines = wrap > 0 ? wrapped(font, text, wrap) : std::string();
  if (wrap > 0) text = lines;
  draw.AddText(font, font->FontSize, at, color, text.data(), text.data() + text.size(), wrap);
}

// What a key needs at a button's right; 0 of none.
float key_room(const Ui& ui, const std::string& key) {
  return key.empty() ? 0 : text_size(ui.theme.body, key).x + ui.theme.px(18);
}

}  // namespace

ImU32 color_of(Severity severity) {
  switch (severity) {
    case Severity::Good:
      return kGood;
    case Severity::Caution:
      return kCaution;
    case Severity::Bad:
      return kBad;
    case Severity::Quiet:
      return kQuietText;
  }
  return kQuietText;
}

void begin_panel(const Ui& ui, const char* name, const Rect& rect, std::string_view title) {
  ImGui::SetCursorScreenPos(rect.min());
  ImGui::BeginChild(name, {rect.width, rect.height}, true, ImGuiWindowFlags_AlwaysUseWindowPadding);
  if (!title.empty()) {
    text_in(ui.theme.strong, kQuietText, title);
    ImGui::Dummy({0, ui.theme.px(2)});
  }
}

void end_panel() { ImGui::EndChild(); }

float action_button_width(const Ui& ui, std::string_view action_id) {
  const Action* action = ui.actions.find(action_id);
  if (action == nullptr) return 0;
  return text_size(ui.theme.body, action->label).x + key_room(ui, key_name(action->key, action->mods)) +
         2 * ImGui::GetStyle().FramePadding.x;
}

void action_button(const Ui& ui, std::string_view action_id, float width, float height) {
  const Action* action = ui.actions.find(action_id);
  if (action == nullptr) return;
  const bool enabled = action->can_run(), needs_hold = enabled && action->needs_hold();
  const bool is_on = action->is_on && action->is_on();
  std::string key = key_name(action->key, action->mods), key_in_tooltip;
  const ImGuiStyle& style = ImGui::GetStyle();
  const ImVec2 label_size = text_size(ui.theme.body, action->label);
  const float key_width = key_room(ui, key);
  if (width <= 0) width = action_button_width(ui, action_id);
  // Where both do not fit beside each other, however close, the label is what has to be read.
  const float closest = key.empty() ? 0 : key_width - ui.theme.px(11);
  if (label_size.x + closest + 2 * style.FramePadding.x > width + 0.5F) key_in_tooltip.swap(key);
  if (height <= 0) height = label_size.y + 2 * style.FramePadding.y;

  ImGui::PushID(action->id.c_str());
  ImGui::BeginDisabled(!enabled);
  const bool clicked = ImGui::InvisibleButton("button", {width, height});
  const bool hovered = enabled && ImGui::IsItemHovered();
  const bool held = ImGui::IsItemActive();
  // What was held ends with its press: letting go is no click, whatever the action has become meanwhile.
  bool& is_a_hold = *ImGui::GetStateStorage()->GetBoolRef(ImGui::GetID("hold"));
  if (ImGui::IsItemActivated()) is_a_hold = needs_hold;
  if (ImGui::IsItemActivated() && needs_hold) ui.actions.press_button(action->id);
  if (clicked && !is_a_hold) action->run();
  if (ImGui::IsItemDeactivated() || (held && !hovered)) ui.actions.release_button(action->id);
  ImGui::EndDisabled();
  const ImVec2 min = ImGui::GetItemRectMin(), max = ImGui::GetItemRectMax();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImGuiCol fill = held ? ImGuiCol_ButtonActive : hovered ? ImGuiCol_ButtonHovered : ImGuiCol_Button;
  draw.AddRectFilled(min, max, is_on ? IM_COL32(28, 74, 104, 255) : ImGui::GetColorU32(fill),
                     style.FrameRounding);
  if (const float done = static_cast<float>(ui.actions.hold_progress(action->id)); done > 0)
    draw.AddRectFilled(min, {min.x + done * (max.x - min.x), max.y}, kHeld, style.FrameRounding);
  if (is_on) draw.AddRect(min, max, kAccent, style.FrameRounding, 0, ui.theme.px(2));
  const ImU32 text = enabled ? kText : IM_COL32(104, 115, 126, 255);
  const float middle = (min.y + max.y) / 2;
  const float left = key.empty() ? (min.x + max.x - label_size.x) / 2 : min.x + style.FramePadding.x;
  draw.PushClipRect(min, max, true);
  draw_text(draw, ui.theme.body, {left, middle - label_size.y / 2}, text, action->label);
  if (!key.empty()) {
    const ImVec2 at{max.x - style.FramePadding.x - text_size(ui.theme.body, key).x,
                    middle - label_size.y / 2};
    const ImU32 color = enabled ? kQuietText : IM_COL32(84, 94, 104, 255);
    draw_text(draw, ui.theme.body, at, color, key);
    // A bar under the key: it is one to be held.
    if (action->needs_hold())
      draw.AddRectFilled({at.x, at.y + label_size.y},
                         {max.x - style.FramePadding.x, at.y + label_size.y + ui.theme.px(3)}, color);
  }
  draw.PopClipRect();
  if (hovered && !action->tooltip.empty())
    tooltip(ui, action->tooltip + (needs_hold ? ". Hold it down" : "") +
                    (key_in_tooltip.empty() ? "" : " (" + key_in_tooltip + ")"));
  ui.log.note_button(action->id, min, max);
  ImGui::PopID();
}

void draw_sign(ImDrawList& draw, const ImVec2& c, float r, Severity severity) {
  const ImU32 color = color_of(severity), ink = kBackground;
  const float line = std::max(r * 0.28F, 1.5F);
  switch (severity) {
    case Severity::Good:
      draw.AddCircleFilled(c, r, color, 24);
      draw.AddLine({c.x - 0.45F * r, c.y + 0.02F * r}, {c.x - 0.10F * r, c.y + 0.40F * r}, ink, line);
      draw.AddLine({c.x - 0.10F * r, c.y + 0.40F * r}, {c.x + 0.50F * r, c.y - 0.35F * r}, ink, line);
      break;
    case Severity::Caution:
      draw.AddTriangleFilled({c.x, c.y - 1.1F * r}, {c.x + 1.15F * r, c.y + 0.9F * r},
                             {c.x - 1.15F * r, c.y + 0.9F * r}, color);
      draw.AddLine({c.x, c.y - 0.4F * r}, {c.x, c.y + 0.30F * r}, ink, line);
      draw.AddCircleFilled({c.x, c.y + 0.62F * r}, line * 0.6F, ink);
      break;
    case Severity::Bad:
      draw.AddRectFilled({c.x - r, c.y - r}, {c.x + r, c.y + r}, color, 0.25F * r);
      draw.AddLine({c.x - 0.45F * r, c.y - 0.45F * r}, {c.x + 0.45F * r, c.y + 0.45F * r}, ink, line);
      draw.AddLine({c.x - 0.45F * r, c.y + 0.45F * r}, {c.x + 0.45F * r, c.y - 0.45F * r}, ink, line);
      break;
    case Severity::Quiet:
      draw.AddCircle(c, 0.8F * r, color, 24, line * 0.7F);
      break;
  }
}

void status_row(const Ui& ui, Severity severity, std::string_view name, std::string_view text) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float radius = ui.theme.px(9), indent = ui.theme.px(30);
  const float wrap = std::max(ImGui::GetContentRegionAvail().x - indent, 1.F);
  const float line = ui.theme.strong->FontSize;
  draw_sign(draw, {at.x + radius + ui.theme.px(2), at.y + line / 2 + 1}, radius, severity);
  const ImVec2 name_size = text_size(ui.theme.strong, name);
  draw_text(draw, ui.theme.strong, {at.x + indent, at.y}, kText, name);
  const ImU32 color =
      severity == Severity::Quiet || severity == Severity::Good ? kQuietText : color_of(severity);
  const float gap = ui.theme.px(10);
  const ImVec2 one_line = text_size(ui.theme.body, text);
  float height = line;
  if (name.empty()) {  // nothing stands on the first line
    draw_text(draw, ui.theme.body, {at.x + indent, at.y}, color, text, wrap);
    height = std::max(height, text_size(ui.theme.body, text, wrap).y);
  } else if (name_size.x + gap + one_line.x <= wrap) {
    draw_text(draw, ui.theme.body, {at.x + indent + name_size.x + gap, at.y}, color, text);
  } else {
    draw_text(draw, ui.theme.body, {at.x + indent, at.y + line}, color, text, wrap);
    height += text_size(ui.theme.body, text, wrap).y;
  }
  ImGui::Dummy({indent + wrap, height});
}

float number_width(ImFont* font, std::string_view text) {
  const float digit = text_size(font, "0").x;
  float width = 0;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t length = 1;
    while (i + length < text.size() && (static_cast<unsigned char>(text[i + length]) & 0xC0U) == 0x80U)
      ++length;
    const bool is_digit = text[i] >= '0' && text[i] <= '9';
    width += is_digit ? digit : text_size(font, text.substr(i, length)).x;
    i += length;
  }
  return width;
}

float draw_number(ImDrawList& draw, ImFont* font, const ImVec2& at, ImU32 color, std::string_view text) {
  const float digit = text_size(font, "0").x;
  float x = at.x;
  for (std::size_t i = 0; i < text.size();) {
    std::size_t length = 1;
    while (i + length < text.size() && (static_cast<unsigned char>(text[i + length]) & 0xC0U) == 0x80U)
      ++length;
    const std::string_view glyph = text.substr(i, length);
    const float own = text_size(font, glyph).x;
    const bool is_digit = text[i] >= '0' && text[i] <= '9';
    draw_text(draw, font, {x + (is_digit ? (digit - own) / 2 : 0), at.y}, color, glyph);
    x += is_digit ? digit : own;
    i += length;
  }
  return x - at.x;
}

void number_block(const Ui& ui, const Rect& rect, std::string_view name, std::string_view value,
                  std::string_view unit, Severity severity) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const Theme& theme = ui.theme;
  const ImU32 color = severity == Severity::Quiet ? kText : color_of(severity);
  float x = rect.x;
  if (severity != Severity::Quiet) {
    draw_sign(draw, {x + theme.px(10), rect.y + theme.strong->FontSize / 2}, theme.px(9), severity);
    x += theme.px(28);
  }
  draw_text(draw, theme.strong, {x, rect.y}, kQuietText, name);
  const float top = rect.y + theme.strong->FontSize * 1.05F;
  const float width = draw_number(draw, theme.number, {rect.x, top}, color, value);
  draw_text(draw, theme.strong,
            {rect.x + width + theme.px(8), top + theme.number->FontSize * 0.86F - theme.strong->FontSize},
            kQuietText, unit);
}

void text_in(ImFont* font, ImU32 color, std::string_view text) {
  ImGui::PushFont(font);
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  ImGui::PushTextWrapPos(0);
  const std::string lines = wrapped(font, text, ImGui::GetContentRegionAvail().x);
  ImGui::TextUnformatted(lines.data(), lines.data() + lines.size());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
  ImGui::PopFont();
}

void text_centered(const Ui& ui, const Rect& rect, ImFont* font, ImU32 color, std::string_view text) {
  // Lines are centred one by one: ImGui's wrapping alone would set them flush left.
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float wrap = std::max(rect.width - ui.theme.px(24), 1.F);
  const std::string broken = wrapped(font, text, wrap);
  text = broken;
  std::array<std::string_view, 12> lines;
  std::size_t count = 0;
  while (!text.empty() && count < lines.size()) {
    const char* end = font->CalcWordWrapPositionA(1.F, text.data(), text.data() + text.size(), wrap);
    const std::size_t hard = text.find('\n');
    std::size_t length = std::max<std::size_t>(static_cast<std::size_t>(end - text.data()), 1);
    if (hard != std::string_view::npos) length = std::min(length, std::max<std::size_t>(hard, 1));
    lines[count++] = text.substr(0, length);
    text.remove_prefix(length);
    while (!text.empty() && (text.front() == ' ' || text.front() == '\n')) text.remove_prefix(1);
  }
  float y = rect.y + (rect.height - font->FontSize * static_cast<float>(count)) / 2;
  for (std::size_t i = 0; i < count; ++i, y += font->FontSize)
    draw_text(draw, font, {rect.x + (rect.width - text_size(font, lines[i]).x) / 2, y}, color, lines[i]);
}

void caption(const Ui& ui, const Rect& picture, ImU32 color, std::string_view text) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  const float beside = ui.theme.px(14), above = ui.theme.px(9);
  const float wrap = std::max(picture.width - 2 * beside, 1.F);
  const ImVec2 size = text_size(ui.theme.strong, text, wrap);
  draw.AddRectFilled(picture.min(), {picture.x + size.x + 2 * beside, picture.y + size.y + 2 * above},
                     IM_COL32(12, 15, 19, 200), ui.theme.px(6));
  draw_text(draw, ui.theme.strong, {picture.x + beside, picture.y + above}, color, text, wrap);
}

std::string fixed(double value, int decimals) {
  std::string text = files::fixed(value, decimals);
  return text.front() == '-' ? "\u2212" + text.substr(1) : text;
}

std::string plus_minus(double sigma) { return "\u00B1 " + fixed(std::max(sigma, 0.1), 1); }

}  // namespace arthronaut::widgets
