#include "app/navigate/bullseye_rings.h"

#include <algorithm>
#include <cmath>
#include <ranges>

#include "app/widgets/controls.h"

namespace arthronaut::navigate {

namespace {

// As surgeons shorten them; the words in full stand beside the numbers.
std::string in_short(std::string_view direction) {
  const bool has_three = direction == "medial" || direction == "lateral" || direction == "anterior";
  return std::string(direction.substr(0, has_three ? 3 : 4));
}

}  // namespace

std::vector<RingLabel> ring_labels(float radius_px, float line_px, float gap_px,
                                   const std::function<float(const std::string&)>& width_of) {
  std::vector<RingLabel> labels;
  float end = radius_px;  // the next one inwards ends left of it
  for (const double ring_mm : kRings_mm | std::views::reverse) {
    const float ring = radius_px * static_cast<float>(ring_mm / kShown_mm), foot = gap_px + line_px;
    if (foot >= ring) continue;
    const std::string text = widgets::fixed(ring_mm, 0) + (ring_mm == kRings_mm.back() ? " mm" : "");
    const float width = width_of(text);
    // Its lower corner is what comes nearest to the ring.
    const float right = std::sqrt(ring * ring - foot * foot) - gap_px;
    if (right > end || right - width < gap_px) continue;
    labels.push_back({text, {right - width, gap_px, width, line_px}});
    end = right - width - gap_px;
  }
  return labels;
}

TargetWords words_about_target(const widgets::Rect& area, const DirectionNames& names, float letters_px,
                               const std::function<float(const std::string&)>& width_of) {
  constexpr float kMuch = 0.85F;
  const float gap = 0.16F * letters_px, row = 1.05F * letters_px, head = 0.5F * letters_px;
  const std::string left = in_short(names.left), right = in_short(names.right);
  const float left_px = width_of(left), right_px = width_of(right);
  const float half_height = area.height / 2 - row;
  const float beside = std::min(area.width / 2 - std::max(left_px, right_px) - gap, half_height),
              alone = std::min(area.width / 2, half_height);
  // At the foot the lower word has what the other two leave of the line.
  const float end_px = head + gap, least = gap / 2;
  const float room = area.width - left_px - right_px - 2 * (end_px + gap + least);
  const bool has_foot = width_of(in_short(names.down)) <= room;
  const bool is_at_foot = has_foot && beside < kMuch * alone;
  const auto in_full = [&](std::string_view name, float most) {
    return width_of(std::string(name)) <= most ? std::string(name) : in_short(name);
  };
  TargetWords words;
  words.radius_px = is_at_foot ? alone : beside;
  words.fits = words.radius_px >= kMuch * alone && words.radius_px > letters_px;
  const ImVec2 center = area.center();
  const float top = center.y - words.radius_px - row, foot = center.y + words.radius_px;
  const auto label = [&](const std::string& text, float x, float y) {
    return DirectionLabel{text, {x, y, width_of(text), letters_px}, {}};
  };
  const auto in_middle = [&](const std::string& text, float y) {
    return label(text, center.x - width_of(text) / 2, y);
  };
  words.up = in_middle(in_full(names.up, area.width), top);
  words.down = in_middle(in_full(names.down, is_at_foot ? room : area.width), foot);
  const float right_end = area.x + area.width - least;
  if (!is_at_foot) {  // above the line that they belong to
    words.left = label(left, area.x + least, center.y - row);
    words.right = label(right, right_end - right_px, center.y - row);
    return words;
  }
  words.left = label(left, area.x + least + end_px, foot);
  words.right = label(right, right_end - end_px - right_px, foot);
  const float arrow_top = foot + (letters_px - head) / 2;
  words.left.arrow = {area.x + least, arrow_top, head, head};
  words.right.arrow = {right_end - head, arrow_top, head, head};
  // In the middle of what is left, where the words beside it are not as wide as each other.
  const float from = words.left.place.x + left_px, to = words.right.place.x;
  words.down.place.x =
      std::clamp(words.down.place.x, from + gap, std::max(from + gap, to - gap - words.down.place.width));
  return words;
}

ImVec2 tail_end(const ImVec2& from, const ImVec2& lean, const ImVec2& half) {
  float share = 1;
  const auto keep = [&](float at, float by, float end) {
    if (by != 0) share = std::min(share, std::max((std::copysign(end, by) - at) / by, 0.F));
  };
  keep(from.x, lean.x, half.x);
  keep(from.y, lean.y, half.y);
  return {from.x + share * lean.x, from.y + share * lean.y};
}

}  // namespace arthronaut::navigate
