// What lies beyond the edges of a picture of a bone, in the bone's own axes: without it nobody knows a right
// knee's medial side from a left one's lateral one.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "app/widgets/controls.h"
#include "planning/landmarks/anatomical_axes.h"

namespace arthronaut::plan {

struct EdgeWords {
  std::string left, right, top, bottom;  // "medial", "proximal"; empty where no axis lies within 45 degrees
  bool operator==(const EdgeWords&) const = default;
};
// right, up: of the picture, unit.
[[nodiscard]] EdgeWords edge_words(const Eigen::Vector3d& right, const Eigen::Vector3d& up,
                                   const landmarks::AnatomicalAxes& axes);
// Where a word of that size stands on a line of the picture: in its middle, else as near to it as it covers
// nothing of what is drawn there (`taken`, as corners).
[[nodiscard]] ImVec2 middle_place(const ImVec2& size, const widgets::Rect& line,
                                  const std::vector<ImVec4>& taken);
// taken: what the words at the upper and lower edge are not to cover.
void draw_edge_words(const widgets::Ui& ui, const widgets::Rect& picture, const EdgeWords& words,
                     const std::vector<ImVec4>& taken = {});

}  // namespace arthronaut::plan
