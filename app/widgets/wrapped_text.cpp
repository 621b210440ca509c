#include "app/widgets/wrapped_text.h"

#include <algorithm>
#include <array>

namespace arthronaut::widgets {

namespace {

// What is drawn as one: a word, and a number with the unit that follows it: "7" at the end of a line and "s"
// below it are read as two things.
std::size_t end_of_part(std::string_view text) {
  const auto end_of_word = [&](std::size_t from) {
    return std::min(text.find_first_of(" \n", from), text.size());
  };
  const std::size_t end = end_of_word(0);
  const bool is_number = end > 0 && text[end - 1] >= '0' && text[end - 1] <= '9';
  if (!is_number || end == text.size() || text[end] == '\n') return end;
  const std::size_t next = end_of_word(end + 1);
  constexpr std::array<std::string_view, 7> kUnits{"mm", "s", "ms", "deg", "px", "%", "min"};
  std::string_view unit = text.substr(end + 1, next - end - 1);
  while (!unit.empty() && (unit.back() == ',' || unit.back() == ';' || unit.back() == '.'))
    unit.remove_suffix(1);
  return std::find(kUnits.begin(), kUnits.end(), unit) != kUnits.end() ? next : end;
}

}  // namespace

std::string wrapped(const ImFont* font, std::string_view text, float width_px) {
  const auto wide = [&](std::string_view part) {
    return font->CalcTextSizeA(font->FontSize, 1e9F, 0, part.data(), part.data() + part.size()).x;
  };
  const float space = wide(" ");
  std::string lines;
  float used = 0;
  bool begins_line = true;
  while (!text.empty()) {
    const std::size_t end = end_of_part(text);
    const float word = wide(text.substr(0, end));
    if (!begins_line) {
      const bool fits = used + space + word <= width_px;
      lines += fits ? ' ' : '\n';
      used = fits ? used + space : 0;
    }
    lines += text.substr(0, end);
    used += word;
    begins_line = end < text.size() && text[end] == '\n';
    if (begins_line) lines += '\n', used = 0;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

LinesWithin lines_within(const ImFont* font, std::string_view text, float width_px, float height_px) {
  constexpr float kLeast = 0.7F, kSmaller = 0.97F;
  const auto fits = [&](const std::string& lines, float share) {
    const ImVec2 size = font->CalcTextSizeA(share * font->FontSize, 1e9F, 0, lines.c_str());
    return size.x <= width_px + 0.5F && size.y <= height_px + 0.5F;
  };
  LinesWithin within;
  float share = 1;
  for (; share >= kLeast; share *= kSmaller) {
    within = {wrapped(font, text, width_px / share), share * font->FontSize};
    if (fits(within.lines, share)) return within;
  }
  share /= kSmaller;
  for (std::size_t length = text.size(); length > 0 && !fits(within.lines, share);) {
    do --length;
    while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0U) == 0x80U);
    within.lines = wrapped(font, std::string(text.substr(0, length)) + "\u2026", width_px / share);
  }
  return within;
}

}  // namespace arthronaut::widgets
