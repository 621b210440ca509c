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
};

// What the cells say of a code that is supposed to stand at a pose, one by one, however much of it is hidden.
// The cells and the margin of one cell about them are lit by a light that varies linearly.
struct SeenCode {
  int agreeing = 0, seen = 0;  // of cells and margin; not saturated
  // Of the inner cells, which alone tell codes and turns apart. What is bright beside a saturated cell
  // speaks against nothing.
  int agreeing_inside = 0, seen_inside = 0;
  int opposite_inside = 0;  // dark where it should be bright, or bright where dark
  // By how much the inner cells that agree, less those that say the opposite, lead over any other turn or
  // code: a cell that tells two apart counts twice. Not counted unless the code agrees.
  int lead = 0;
  // Nearly half of all that is seen, and of the inside seven cells; few say the opposite.
  [[nodiscard]] bool agrees() const;
  // It agrees, and the inside by itself speaks for this code, this way up: by two cells when none says the
  // opposite, else by three.
  [[nodiscard]] bool is_confirmed() const;
};
[[nodiscard]] SeenCode see_code(const LinearImage& image, const camera::CameraModel& camera,
                                const geometry::RigidTransform& camera_from_marker, double size_mm,
                                std::span<const MarkerCode> codes, std::size_t index);

// `square` holds tangent coordinates, clockwise. The codes have the same count of cells. nullopt when none
// fits.
[[nodiscard]] std::optional<ReadCode> read_code(const LinearImage& image, const camera::CameraModel& camera,
                                                const Corners& square, std::span<const MarkerCode> codes);

// The same of a square of which a part is hidden, by what each cell says: at least seven of the inner cells
// agree, and six more than twice those that say the opposite. Without a pose that the edges confirm it is
// nothing yet.
[[nodiscard]] std::optional<ReadCode> read_covered_code(const LinearImage& image,
                                                        const camera::CameraModel& camera,
                                                        const Corners& square,
                                                        std::span<const MarkerCode> codes);

}  // namespace arthronaut::markers
