#include "app/navigate/bullseye_rings.h"

#include <algorithm>
#include <cmath>
#include <ranges>

#include "app/widgets/controls.h"

namespace arthronaut::navigate {

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
