// Which side of the patient each border of a slice is of: without it left and right are a guess.
#pragma once

#include <array>
#include <string>

#include "app/scene/reslice.h"
#include "app/widgets/controls.h"

namespace arthronaut::review {

// Of the left, right, upper and lower border; see scene::orientation_letters(). plane: in the patient's LPS.
[[nodiscard]] std::array<std::string, 4> side_letters(const scene::SlicePlane& plane);
// At the borders of `picture`, over it.
void draw_side_letters(const widgets::Ui& ui, const widgets::Rect& picture, const scene::SlicePlane& plane);

}  // namespace arthronaut::review
