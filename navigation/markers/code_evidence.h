// Which code of a whole dictionary stands at a pose, by the light on both sides of every boundary between its
// cells.
//
// A highlight adds a light that changes smoothly. So where it hides what a cell is, the step to the cell
// beside it often still shows; two neighbours of one brightness have none between them; and what is darker
// than a bright cell is none, whatever shines on it. Every boundary gives the likelihood of each pair of
// brightnesses on its two sides. Those of several frames add up, to a limit: what is wrong in one is often
// wrong in the next. What covers a marker darkens it, too, and is not foreseen here.
#pragma once

#include <array>

#include "navigation/camera/camera_model.h"
#include "navigation/markers/edge_profiles.h"
#include "navigation/markers/linear_image.h"
#include "navigation/markers/marker_pattern.h"
#include "navigation/markers/seen_code.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::markers {

class CodeEvidence {
 public:
  void start_over() { boundaries_.fill(Boundary()); }
  // What one more frame shows about the marker at this pose, if it is of this code. False where highlights
  // hide less of the inner cells than one of them: then nothing is added.
  bool add(const LinearImage& image, const camera::CameraModel& camera,
           const geometry::RigidTransform& camera_from_marker, double size_mm, const MarkerCode& code,
           const Smear& smear);
  // Logarithm of how much likelier the declared code of this index is than any other one of the dictionary,
  // and than itself another way up. Declared ones that are seen elsewhere are not here.
  [[nodiscard]] double lead(const KnownCodes& codes, std::size_t index) const;

 private:
  // Those that an inner cell has a part in.
  static constexpr int kMostBoundaries = 2 * (kMaxCells - 1) * (kMaxCells - 2);
  struct Boundary {
    // Of logarithms, by what is on both sides: 2 * (the first one is bright) + (the second one is bright).
    std::array<float, 4> sum{};
    int frames = 0;  // in which anything was seen of it
  };
  [[nodiscard]] double likelihood(const MarkerCode& code, int turn) const;

  std::array<Boundary, kMostBoundaries> boundaries_{};
};

}  // namespace arthronaut::markers
