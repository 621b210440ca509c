#include "app/plan/edge_words.h"

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

void draw_edge_words(const widgets::Ui& ui, const widgets::Rect& picture, const EdgeWords& words) {
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  ImFont* font = ui.theme.body;
  // across, down: the share of what the word leaves free of the picture.
  const auto put = [&](const std::string& word, float across, float down) {
    const float edge = ui.theme.px(10);
    const ImVec2 size = font->CalcTextSizeA(font->FontSize, 1e9F, 0, word.c_str());
    const ImVec2 at{picture.x + edge + across * (picture.width - size.x - 2 * edge),
                    picture.y + edge + down * (picture.height - size.y - 2 * edge)};
    const float pad = ui.theme.px(4);  // read over a bright bone, too
    if (!word.empty())
      draw.AddRectFilled({at.x - pad, at.y}, {at.x + size.x + pad, at.y + size.y}, IM_COL32(12, 16, 20, 150),
                         pad);
    draw.AddText(font, font->FontSize, at, widgets::kCaution, word.c_str());
  };
  put(words.left, 0, 0.5F);
  put(words.right, 1, 0.5F);
  put(words.top, 0.5F, 0);
  put(words.bottom, 0.5F, 1);
}

}  // namespace arthronaut::plan
