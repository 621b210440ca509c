// A CT made from known bones: a cortex of even thickness, marrow, soft tissue, each voxel filled by what it
// covers, noise. What its import should give is known exactly.
#pragma once

#include <functional>
#include <vector>

#include "planning/geometry/triangle_mesh.h"
#include "planning/images/volume.h"

namespace arthronaut::test {

struct KnownCtOptions {
  Eigen::Vector3d spacing_mm{0.4, 0.4, 0.625};
  double margin_mm = 8;
  double cortex_mm = 1.5;  // thickness of the cortex
  double cortex_hu = 1200, marrow_hu = 150, soft_tissue_hu = 50;
  double blur_mm = 0.35;  // sigma of the scanner's point spread
  double noise_hu = 25;
  std::uint64_t seed = 1;
  int samples = 3;  // rays a voxel along j and along k; along i coverage is exact
  // The volume ends here: what lies beyond is cut off. LPS.
  double lowest_mm = -1e9, highest_mm = 1e9;
  // What is done to the bones before the scanner sees them: no blur and no noise yet.
  std::function<void(images::Volume&)> operate = nullptr;
};

[[nodiscard]] images::Volume known_ct(const std::vector<geometry::TriangleMesh>& bones,
                                      const KnownCtOptions& options = {});

// The share of each voxel that lies within the closed mesh, in the grid of the volume.
[[nodiscard]] std::vector<float> coverage(const geometry::TriangleMesh& mesh, const images::Volume& grid,
                                          int samples);

// Distances of the surface's vertices from the truth, sorted, mm; those nearer than `margin_mm` to the top or
// the bottom of the truth, where caps are, left out.
[[nodiscard]] std::vector<double> distances_to(const geometry::TriangleMesh& truth,
                                               const geometry::TriangleMesh& surface, double margin_mm);

}  // namespace arthronaut::test
