// A volume made ready to be drawn in 3D: what of it lies about the joint, brought down to so many voxels that
// software OpenGL turns it at the speed of a hand. It lies where the volume lies, whatever its axes.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/scene/scene_content.h"
#include "planning/geometry/triangle_mesh.h"
#include "planning/images/volume.h"

namespace arthronaut::scene {

struct DrawnVolume {
  Eigen::Vector3i size = Eigen::Vector3i::Zero();  // at least 2 along each axis
  // To LPS in mm, from the index of a voxel's centre. As the volume's: oblique, mirrored, never singular.
  Eigen::Affine3d lps_from_index = Eigen::Affine3d::Identity();
  std::vector<std::uint16_t> levels;  // i runs fastest; value = lowest + per_level * level
  double lowest = 0, highest = 0, per_level = 1;
  bool is_ct = false;  // values are Hounsfield units
};

// Each voxel is the mean of a block of the volume's, of 1 x 1 x 1 where these are no more than most_voxels;
// the blocks are kept as near to cubes as they can be. Values of a CT from -1024 to 3071 HU, of other images
// between the quantiles of automatic_window(); what lies outside of these is brought in. box_mm is in LPS,
// along its axes; what is drawn holds it as far as the volume goes. nullptr where the volume does not reach
// into the box with at least two voxels along each axis.
[[nodiscard]] std::shared_ptr<const DrawnVolume> drawn_volume(const images::Volume& volume,
                                                              const geometry::Bounds& box_mm,
                                                              std::size_t most_voxels = 4'000'000);

// Of which values are shown, and how.
enum class VolumePreset {
  Bone,               // one opaque surface at the threshold
  BoneAndSoftTissue,  // the same within muscle and skin, faint
  // MR: everything but air, opaque and in its own grey. Skin is among the brightest, so that no threshold
  // shows what lies within: cut open it shows the anatomy, as a slice does.
  Grey,
};
[[nodiscard]] std::string in_words(VolumePreset preset);  // "bone and soft tissue"
// That a look at it begins with: 250 HU, or a tenth of an MR's range, above its air.
[[nodiscard]] double first_threshold(const DrawnVolume& volume);
// Moved by steps of 25 HU, or 40 to the range of an MR; between the values that are drawn.
[[nodiscard]] double moved_threshold(const DrawnVolume& volume, double threshold, int steps);

struct VolumeItem {
  std::shared_ptr<const DrawnVolume> volume;  // compared by address
  VolumePreset preset = VolumePreset::Bone;
  double threshold = 250;  // a value of the volume
  double opacity = 1;      // below 1: of 10 mm of what is opaque else
  std::vector<CutPlane> cuts = {};
  bool operator==(const VolumeItem&) const = default;
};

}  // namespace arthronaut::scene
