// Where a word stands that belongs to a point of a picture.
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <vector>

#include "app/widgets/controls.h"

namespace arthronaut::plan {

// The upper left corner of a text of that size: to the right of the point, but never over the edge of the
// picture, where half of a number would be cut off and the rest be read as the whole.
[[nodiscard]] inline ImVec2 beside(const ImVec2& point, const ImVec2& text, float gap,
                                   const widgets::Rect& picture) {
  const auto within = [](float wanted, float from, float room) {
    return std::clamp(wanted, from, from + std::max(room, 0.F));
  };
  return {within(point.x + gap, picture.x, picture.width - text.x),
          within(point.y, picture.y, picture.height - text.y)};
}

// Where a word runs over none of those that were drawn before (`taken`, as corners; it joins them) and not
// over the edge: to the right of its sign at `point`, whose half width is `gap`, else to the left, on the
// first of the lines where there is room; 0 is the sign's own, 1 the one below. Nowhere: nullopt.
[[nodiscard]] inline std::optional<ImVec2> free_place_on(std::initializer_list<float> lines,
                                                         const ImVec2& point, const ImVec2& text, float gap,
                                                         const widgets::Rect& picture,
                                                         std::vector<ImVec4>& taken) {
  const auto is_free = [&](const ImVec4& place) {
    return place.x >= picture.x && place.z <= picture.x + picture.width && place.y >= picture.y &&
           place.w <= picture.y + picture.height && std::ranges::none_of(taken, [&](const ImVec4& other) {
             return place.x < other.z && other.x < place.z && place.y < other.w && other.y < place.w;
           });
  };
  for (const float line : lines)
    for (const float left : {point.x + gap, point.x - gap - text.x}) {
      const ImVec2 corner(left, point.y + (line - 0.5F) * text.y);
      const ImVec4 place(corner.x, corner.y, corner.x + text.x, corner.y + text.y);
      if (!is_free(place)) continue;
      taken.push_back(place);
      return corner;
    }
  return std::nullopt;
}

// The same of a word that must be said: on the lines above and below in turn, and where nothing is free to
// the right.
[[nodiscard]] inline ImVec2 free_place(const ImVec2& point, const ImVec2& text, float gap,
                                       const widgets::Rect& picture, std::vector<ImVec4>& taken) {
  if (const auto free = free_place_on({0, 1, -1, 2, -2, 3, -3}, point, text, gap, picture, taken))
    return *free;
  const ImVec2 corner = beside({point.x, point.y - text.y / 2}, text, gap, picture);
  taken.emplace_back(corner.x, corner.y, corner.x + text.x, corner.y + text.y);
  return corner;
}

// The same for a measurement of two points or three: beside the middle of a distance's line, outside of an
// angle at its vertex, so that the word covers none of its own lines and points.
[[nodiscard]] inline ImVec2 beside_measured(const std::vector<ImVec2>& points, const ImVec2& text, float gap,
                                            const widgets::Rect& picture) {
  const auto unit = [](float x, float y) {
    const float length = std::hypot(x, y);
    return length > 0 ? ImVec2(x / length, y / length) : ImVec2(0, -1);
  };
  const ImVec2 &a = points[0], &b = points[1];
  ImVec2 from((a.x + b.x) / 2, (a.y + b.y) / 2), away = unit(b.y - a.y, a.x - b.x);
  if (points.size() == 3) {
    const ImVec2 to_a = unit(a.x - b.x, a.y - b.y), to_c = unit(points[2].x - b.x, points[2].y - b.y);
    from = b;
    away = unit(-to_a.x - to_c.x, -to_a.y - to_c.y);
  }
  // As far as the word's corners reach towards the line.
  const float off = gap + (std::abs(away.x) * text.x + std::abs(away.y) * text.y) / 2;
  const ImVec2 corner(from.x + off * away.x - text.x / 2, from.y + off * away.y - text.y / 2);
  return beside(corner, text, 0, picture);
}

// Where a box over a picture stands: in the one place, unless it would cover one of the points there and none
// in the other.
[[nodiscard]] inline widgets::Rect clear_place(const widgets::Rect& usual, const widgets::Rect& other,
                                               const std::vector<ImVec2>& points) {
  const auto covers = [&](const widgets::Rect& box) {
    return std::ranges::any_of(points, [&](const ImVec2& point) { return box.contains(point); });
  };
  return covers(usual) && !covers(other) ? other : usual;
}

}  // namespace arthronaut::plan
