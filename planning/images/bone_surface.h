// From a volume to the surface of one bone: by its label, or by a threshold of Hounsfield units.
//
// The surface is taken by marching cubes in the volume's own grid, carried to the patient by the whole affine
// (oblique and sheared grids included) and smoothed there. Where the bone runs out of the volume it is closed
// with a flat cap.
#pragma once

#include <string>
#include <vector>

#include "planning/geometry/triangle_mesh.h"
#include "planning/images/volume.h"

namespace arthronaut::images {

struct BoneSurface {
  geometry::TriangleMesh mesh;      // LPS, mm, closed; not yet turned outwards
  std::vector<std::string> notes;   // what was chosen, for a person to see
  std::vector<std::string> doubts;  // why it may not be the one bone that was asked for
};

// Throws InvalidInput when the volume is no label map or does not hold the label; the message lists those
// that it does.
[[nodiscard]] BoneSurface surface_of_label(const Volume& volume, int label);

// Which of the pieces above the threshold: several bones of a knee lie in one scan. In thick slices the bones
// touch: unless the largest is asked for, they are parted where they are thinnest.
enum class Piece { Largest, Superior, Inferior };

struct ThresholdOptions {
  // Cortical bone of adults in CT is above it, marrow and soft tissue below.
  double threshold = 250;
  Piece piece = Piece::Largest;
  // Gaps of the cortex up to twice this are closed, then the marrow is filled in, so that one surface is
  // left.
  double closing_radius_mm = 2.0;
};

// Throws InvalidInput when nothing is above the threshold.
[[nodiscard]] BoneSurface surface_above_threshold(const Volume& volume, const ThresholdOptions& options = {});

}  // namespace arthronaut::images
