// Where the rings of the bullseye bear their numbers: inside of each, right under the line to the right, so
// that what is drawn along the rim covers none of them; where the words about it stand; and where the guide's
// tail ends. Pure.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "app/widgets/layout.h"

namespace arthronaut::navigate {

inline constexpr double kShown_mm = 6;  // radius of the whole bullseye
inline constexpr std::array<double, 3> kRings_mm{1, 2, 5};

struct RingLabel {
  std::string text;  // "2", of the outer one "5 mm"
  widgets::Rect place;
};
// The rings about 0, 0, of a bullseye of that radius. Where two would stand in each other, the outer one is
// named; where one does not fit inside its ring, it is not.
[[nodiscard]] std::vector<RingLabel> ring_labels(float radius_px, float line_px, float gap_px,
                                                 const std::function<float(const std::string&)>& width_of);

// A direction's word. Where it stands at the foot, an arrow head tells which way; none: empty.
struct DirectionLabel {
  std::string text;
  widgets::Rect place, arrow;
};
// The bullseye about the middle of its area, as large as it can be with all four words in letters of that
// size about it: those of the sides beside it, or at its foot where they would take more than a seventh of
// it. Upper and lower word stand in full where there is room.
struct TargetWords {
  float radius_px = 0;
  DirectionLabel up, down, left, right;
  bool fits = false;  // else the letters are too large for the area
};
struct DirectionNames {
  std::string_view up, down, left, right;  // "anterior"
};
[[nodiscard]] TargetWords words_about_target(const widgets::Rect& area, const DirectionNames& names,
                                             float letters_px,
                                             const std::function<float(const std::string&)>& width_of);

// Where the tail ends of a guide at `from` that leans by `lean`, all from the bullseye's middle. It may leave
// the rim, since a tail cut there would look like less tilt, but not what is drawn on, which reaches as far
// as `half` to either side.
[[nodiscard]] ImVec2 tail_end(const ImVec2& from, const ImVec2& lean, const ImVec2& half);

}  // namespace arthronaut::navigate
