#include "app/widgets/wrapped_text.h"

#include <algorithm>

namespace arthronaut::widgets {

std::string wrapped(const ImFont* font, std::string_view text, float width_px) {
  const auto wide = [&](std::string_view part) {
    return font->CalcTextSizeA(font->FontSize, 1e9F, 0, part.data(), part.data() + part.size()).x;
  };
  const float space = wide(" ");
  std::string lines;
  float used = 0;
  bool begins_line = true;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(" \n"), text.size());
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

}  // namespace arthronaut::widgets
