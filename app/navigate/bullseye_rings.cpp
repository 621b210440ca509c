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

TargetWords words_in_target(float radius_px, float half_width_px, const DirectionNames& names,
                            float letters_px, const std::function<float(const std::string&)>& width_of) {
  constexpr float kFree = 0.36F;  // of the radius: the rings of 1 and 2 mm
  const float gap = 0.16F * letters_px, rim = radius_px - 0.3F * letters_px, row = 1.05F * letters_px;
  // How far out on the rim lies what is so far from the middle the other way.
  const auto on_rim = [&](float across) { return std::sqrt(std::max(rim * rim - across * across, 0.F)); };
  TargetWords words;
  words.fits = rim > row;
  const auto put = [&](DirectionLabel& label, std::string_view name, const auto& place) {
    label.text = in_short(name);
    label.place = place(width_of(label.text));
    const widgets::Rect& at = label.place;
    const float dx = std::max({at.x, -at.x - at.width, 0.F}), dy = std::max({at.y, -at.y - at.height, 0.F});
    words.fits = words.fits && std::hypot(dx, dy) >= kFree * radius_px;
  };
  // Above the line that they belong to; at the panel's edge where most of the word so stands outside.
  const auto end_px = [&](float width) {
    return half_width_px - radius_px > width / 3 ? half_width_px - gap : on_rim(row);
  };
  put(words.up, names.up, [&](float width) {
    return widgets::Rect{-width / 2, -on_rim(width / 2), width, letters_px};
  });
  put(words.down, names.down, [&](float width) {
    return widgets::Rect{-width / 2, on_rim(width / 2) - letters_px, width, letters_px};
  });
  put(words.left, names.left, [&](float width) {
    return widgets::Rect{-end_px(width), -row, width, letters_px};
  });
  put(words.right, names.right, [&](float width) {
    return widgets::Rect{end_px(width) - width, -row, width, letters_px};
  });
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
