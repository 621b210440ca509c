// Where the rings of the bullseye bear their numbers: inside of each, right under the line to the right, so
// that what is drawn along the rim covers none of them; where the words of its directions stand in it; and
// where the guide's tail ends. Pure.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <string_view>
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

struct DirectionLabel {
  std::string text;
  widgets::Rect place;
};
// The four words of a bullseye about 0, 0, in letters of that size: inside the rim, beside which they would
// take a third of its radius; to the sides they stand at the edge of the panel where that is wider.
struct TargetWords {
  DirectionLabel up, down, left, right;
  bool fits = false;  // else the letters are too large: they reach into the ring of 2 mm, or leave none
};
struct DirectionNames {
  std::string_view up, down, left, right;  // "anterior"
};
[[nodiscard]] TargetWords words_in_target(float radius_px, float half_width_px, const DirectionNames& names,
                                          float letters_px,
                                          const std::function<float(const std::string&)>& width_of);

// Where the tail ends of a guide at `from` that leans by `lean`, all from the bullseye's middle. It may leave
// the rim, since a tail cut there would look like less tilt, but not what is drawn on, which reaches as far
// as `half` to either side.
[[nodiscard]] ImVec2 tail_end(const ImVec2& from, const ImVec2& lean, const ImVec2& half);

}  // namespace arthronaut::navigate
