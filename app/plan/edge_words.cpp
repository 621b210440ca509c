#include "app/plan/edge_words.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace arthronaut::plan {

namespace {

constexpr double kNear_cos = 0.7071;

std::string word_of(const Eigen::Vector3d& way, const landmarks::AnatomicalAxes& axes) {
  for (const auto& [axis, towards, away] : {std::tuple{&axes.proximal, "proximal", "distal"},
                                            {&axes.lateral, "lateral", "medial"},
                                            {&axes.anterior, "anterior", "posterior"}}) {
    const double along = way.dot(*axis);
    if (std::abs(along) > kNear_cos) return along > 0 ? towards : away;
  }
  return "";
}

}  // namespace

EdgeWords edge_words(const Eigen::Vector3d& right, const Eigen::Vector3d& up,
                     const landmarks::AnatomicalAxes& axes) {
  return {word_of(-right, axes), word_of(right, axes), word_of(up, axes), word_of(-up, axes)};
}

ImVec2 middle_place(const ImVec2& size, const widgets::Rect& line, const std::vector<ImVec4>& taken) {
  const ImVec2 middle{line.x + (line.width - size.x) / 2, line.y};
  const auto is_free = [&](float x) {
    return x >= line.x && x + size.x <= line.x + line.width &&
           std::ranges::none_of(taken, [&](const ImVec4& other) {
             return x < other.z && other.x < x + size.x && middle.y < other.w && other.y < middle.y + size.y;
           });
  };
  const float step = size.y / 2;
  for (float off = 0; off < line.width / 2; off += step)
    for (const float x : {middle.x + off, middle.x - off})
      if (is_free(x)) return {x, middle.y};
  return middle;
}

void draw_edge_words(const widgets::Ui& ui, const widgets::Rect& picture, const EdgeWords& words,
                     const std::vector<ImVec4>& taken) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  ImFont* font = ui.theme.body;
  const widgets::Rect inner = picture.inset(ui.theme.px(10));
  const auto size_of = [&](const std::string& word) {
    return font->CalcTextSizeA(font->FontSize, 1e9F, 0, word.c_str());
  };
  const auto put = [&](const std::string& word, const ImVec2& at) {
    if (word.empty()) return;
    const float pad = ui.theme.px(4);  // read over a bright bone, too
    const ImVec2 size = size_of(word);
    draw.AddRectFilled({at.x - pad, at.y}, {at.x + size.x + pad, at.y + size.y}, IM_COL32(12, 16, 20, 150),
                       pad);
    draw.AddText(font, font->FontSize, at, widgets::kCaution, word.c_str());
  };
  const float middle = inner.y + (inner.height - font->FontSize) / 2;
  put(words.left, {inner.x, middle});
  put(words.right, {inner.x + inner.width - size_of(words.right).x, middle});
  widgets::Rect line = inner;
  put(words.top, middle_place(size_of(words.top), line, taken));
  line.y += inner.height - font->FontSize;
  put(words.bottom, middle_place(size_of(words.bottom), line, taken));
}

}  // namespace arthronaut::plan
