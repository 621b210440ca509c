// A code of which a part may be hidden: what each of its cells says by itself.
//
// A highlight only adds light. So an inner cell that is saturated, or beside one that is, is told by its
// parts: where some are as dark as the dark, or more are darker than anything bright, it is dark, whatever
// shines on it or beside them; where none is dark and many are just as bright as the bright, it is bright;
// else it says nothing.
#pragma once

#include <optional>
#include <span>

#include "navigation/camera/camera_model.h"
#include "navigation/markers/code_reader.h"
#include "navigation/markers/linear_image.h"
#include "navigation/markers/marker_pattern.h"
#include "navigation/markers/planar_pose.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::markers {

// What a code may be mixed up with.
struct KnownCodes {
  std::span<const MarkerCode> declared;
  std::span<const MarkerCode> dictionary = {};  // all that may be in view, declared or not
  // Of the declared ones: seen elsewhere in this frame, so that they are not here. Empty: of none is known.
  std::span<const char> are_elsewhere = {};

  [[nodiscard]] bool is_elsewhere(std::size_t index) const {
    return index < are_elsewhere.size() && are_elsewhere[index];
  }
};

// What the cells say of a code that is supposed to stand at a pose, one by one, however much of it is hidden.
// The cells and the margin of one cell about them are lit by a light that varies linearly.
struct SeenCode {
  int agreeing = 0, seen = 0;  // of cells and margin; not saturated
  // Of the inner cells, which alone tell codes and turns apart.
  int agreeing_inside = 0, seen_inside = 0;
  int bright_inside = 0;    // of those that agree
  int opposite_inside = 0;  // dark where it should be bright, or bright where dark
  // By how much the inner cells that agree, less those that say the opposite, lead over any other turn or
  // code: a cell that tells two apart counts twice. Not counted unless the code agrees.
  int lead = 0;
  bool is_undeclared = false;  // a code that is not declared tells the inside better; counted where it leads
  // Nearly half of all that is seen, and of the inside seven cells; few say the opposite. Five are enough
  // where none does and both dark and bright are seen.
  [[nodiscard]] bool agrees() const;
  // It agrees, and the inside by itself speaks for this code, this way up: by two cells when none says the
  // opposite, else by three; and for none that is not declared.
  [[nodiscard]] bool is_confirmed() const;
};
[[nodiscard]] SeenCode see_code(const LinearImage& image, const camera::CameraModel& camera,
                                const geometry::RigidTransform& camera_from_marker, double size_mm,
                                const KnownCodes& codes, std::size_t index);

// The code of a square (as read_code) of which a part is hidden, by what each cell says: it is confirmed, and
// of the inner cells five more agree than twice those that say the opposite. None that is elsewhere. Without
// a pose that the edges confirm it is nothing yet.
[[nodiscard]] std::optional<ReadCode> read_covered_code(const LinearImage& image,
                                                        const camera::CameraModel& camera,
                                                        const Corners& square, const KnownCodes& codes);

}  // namespace arthronaut::markers
