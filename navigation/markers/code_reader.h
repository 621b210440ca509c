// Reads the code of a square: which of the declared markers it is, and which way up.
//
// A declared code is accepted when at most one of its inner cells, and at most two of all cells, read wrong,
// and the light of the cells follows the code (with a gain and a bias that may vary linearly over the
// square). Codes of DICT_4X4_50 differ from each other and from themselves turned in at least 4 of 16 cells,
// the standard markers 0 to 4 in at least 6, so that one wrong cell never makes another marker of it. A
// square with random cells inside a dark border would pass with a probability of 17 * 4 / 65536 = 0.1 % for
// each declared marker; nothing is reported that the edges of the code do not confirm afterwards.
//
// A cell that is saturated says nothing, and one beside it nothing when it is brighter than it should be.
// With such cells none of the others inside may be wrong, and at least ten have to be left: 4 / 1024 for a
// square with random cells.
#pragma once

#include <optional>
#include <span>

#include "navigation/camera/camera_model.h"
#include "navigation/markers/linear_image.h"
#include "navigation/markers/marker_pattern.h"
#include "navigation/markers/planar_pose.h"

namespace arthronaut::markers {

struct ReadCode {
  int index = -1;  // into the codes
  int turn = 0;    // the marker's top-left is the square's corner of this index
  int wrong_cells = 0;
  bool has_unread_cells = false;  // read past cells that say nothing
};

// `square` holds tangent coordinates, clockwise. The codes have the same count of cells. nullopt when none
// fits.
[[nodiscard]] std::optional<ReadCode> read_code(const LinearImage& image, const camera::CameraModel& camera,
                                                const Corners& square, std::span<const MarkerCode> codes);

}  // namespace arthronaut::markers
