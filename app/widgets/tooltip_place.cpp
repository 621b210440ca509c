#include "app/widgets/tooltip_place.h"

#include <cmath>
#include <limits>

namespace arthronaut::widgets {

namespace {

float covered(const Rect& a, const Rect& b) {
  const float width = std::min(a.max().x, b.max().x) - std::max(a.x, b.x);
  const float height = std::min(a.max().y, b.max().y) - std::max(a.y, b.y);
  return width > 0 && height > 0 ? width * height : 0;
}

float apart(const Rect& a, const Rect& b) {
  return std::hypot(std::max({a.x - b.max().x, b.x - a.max().x, 0.F}),
                    std::max({a.y - b.max().y, b.y - a.max().y, 0.F}));
}

}  // namespace

ImVec2 tooltip_place(const Rect& about, const ImVec2& size, const Rect& screen, float gap,
                     const std::vector<Rect>& clear_of) {
  // A best place touches something, by its gap, on one side in each direction; or ends where `about` does.
  std::vector<float> xs{about.x, about.max().x - size.x}, ys{about.y, about.max().y - size.y};
  std::vector<Rect> taken = clear_of;
  taken.push_back(about);
  for (const Rect& other : taken) {
    xs.insert(xs.end(), {other.x - gap - size.x, other.max().x + gap});
    ys.insert(ys.end(), {other.y - gap - size.y, other.max().y + gap});
  }
  ImVec2 best = about.min();
  float least_covered = std::numeric_limits<float>::infinity(), least_apart = least_covered;
  for (const float at_x : xs)
    for (const float at_y : ys) {
      const Rect place{std::clamp(at_x, screen.x, std::max(screen.x, screen.max().x - size.x)),
                       std::clamp(at_y, screen.y, std::max(screen.y, screen.max().y - size.y)), size.x,
                       size.y};
      const float distance = apart(place, about);
      if (least_covered == 0 && distance >= least_apart) continue;
      float area = 0;
      for (const Rect& other : taken) area += covered(place, other);
      if (area > least_covered || (area == least_covered && distance >= least_apart)) continue;
      best = place.min();
      least_covered = area;
      least_apart = distance;
    }
  return best;
}

}  // namespace arthronaut::widgets
