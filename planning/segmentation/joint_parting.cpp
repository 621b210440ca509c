#include "planning/segmentation/joint_parting.h"

#include <cmath>
#include <queue>
#include <vector>

#include "planning/segmentation/marrow.h"

namespace arthronaut::segmentation {

namespace {

using images::Volume;
using images::VoxelMask;

// The sheet is smooth, and told in steps of 1 mm over columns of 2 mm: so near to it the darkest voxels lie
// where it is seen. Where it is not, beside the plates that face each other, it only goes on somehow.
constexpr double kSeenWithin_mm = 2, kUnseenWithin_mm = 8;
// The further off, the less it tells: as steeply as the eminences rise beside the plates.
constexpr double kUnseenSlope = 1.5;
constexpr double kLeastMarrow_mm3 = 2000;
constexpr double kLeastOff_mm = 3;

enum Bone : std::uint8_t { kNone = 0, kAbove = 1, kBelow = 2 };

// What may be either's is open, what is neither's none.
struct Bones {
  std::vector<std::uint8_t> of_voxel;
  VoxelMask is_open;
  std::vector<float> grey;
};

// By the sheet alone.
Bones bones_by_sheet(const Volume& volume, const BoneSolid& whole, const JointSpace& joint,
                     const VoxelMask& bright, const VoxelMask& marrow) {
  Bones bones{std::vector<std::uint8_t>(bright.inside.size(), kNone), VoxelMask(bright.size), {}};
  bones.grey.resize(bright.inside.size());
  for (std::size_t v = 0; v < bright.inside.size(); ++v) {
    if (!bright.inside[v] && !marrow.inside[v]) continue;
    const Eigen::Vector3i index = whole.box.first + bright.index_of(v);
    const Eigen::Vector3d p = volume.lps_from_index * index.cast<double>();
    const JointSpace::Sheet sheet = joint.at(p.x(), p.y());
    const double above_mm = p.z() - sheet.height_mm;
    bones.grey[v] = volume.at(index.x(), index.y(), index.z());
    const double within_mm = std::min(kUnseenWithin_mm, kSeenWithin_mm + kUnseenSlope * sheet.from_seen_mm);
    if (bright.inside[v] && std::abs(above_mm) < within_mm) {
      bones.is_open.inside[v] = 1;
    } else {
      bones.of_voxel[v] = above_mm > 0 ? kAbove : kBelow;
    }
  }
  return bones;
}

void flood(const VoxelMask& bright, Bones& bones) {
  using Front = std::pair<float, std::size_t>;  // the brightest first
  std::priority_queue<Front> fronts;
  const auto flood_from = [&](std::size_t from) {
    images::for_each_neighbour(bright.size, from, [&](std::size_t to) {
      if (!bones.is_open.inside[to] || bones.of_voxel[to] != kNone) return;
      bones.of_voxel[to] = bones.of_voxel[from];
      fronts.emplace(bones.grey[to], to);
    });
  };
  const std::vector<std::uint8_t> sure = bones.of_voxel;
  for (std::size_t from = 0; from < sure.size(); ++from)
    if (sure[from] != kNone && bright.inside[from]) flood_from(from);
  while (!fronts.empty()) {
    const std::size_t from = fronts.top().second;
    fronts.pop();
    flood_from(from);
  }
}

VoxelMask bright_of(const Volume& volume, const BoneSolid& whole, double threshold) {
  VoxelMask bright = whole.mask;
  for (std::size_t v = 0; v < bright.inside.size(); ++v) {
    if (!bright.inside[v]) continue;
    const Eigen::Vector3i index = whole.box.first + bright.index_of(v);
    bright.inside[v] = volume.at(index.x(), index.y(), index.z()) >= threshold;
  }
  return bright;
}

// What the bright encloses by itself, without any gap closed. Small rooms may lie between the bones.
VoxelMask marrow_within(const Volume& volume, const BoneSolid& whole, const VoxelMask& bright) {
  BoneSolid filled{whole.box, bright};
  fill_marrow(volume, filled);
  for (std::size_t v = 0; v < bright.inside.size(); ++v)
    filled.mask.inside[v] = filled.mask.inside[v] && !bright.inside[v];
  const double voxel_mm3 = std::abs(volume.lps_from_index.linear().determinant());
  VoxelMask marrow(bright.size);
  for (const auto& room :
       images::connected_pieces(filled.mask, static_cast<std::size_t>(kLeastMarrow_mm3 / voxel_mm3)))
    for (const std::size_t v : room.voxels) marrow.inside[v] = 1;
  return marrow;
}

BoneSolid alone(const Volume& volume, const BoneSolid& whole, const std::vector<std::uint8_t>& bones,
                Bone bone, double closing_radius_mm) {
  VoxelMask part(whole.mask.size);
  for (std::size_t v = 0; v < bones.size(); ++v) part.inside[v] = bones[v] == bone;
  const auto pieces = images::connected_pieces(part, 1);
  if (pieces.empty()) return {whole.box, part};
  std::vector<std::size_t> voxels = pieces.front().voxels;
  for (std::size_t& v : voxels) {
    const Eigen::Vector3i index = whole.box.first + whole.mask.index_of(v);
    v = volume.index(index.x(), index.y(), index.z());
  }
  BoneSolid solid = solid_of(volume, voxels, closing_radius_mm);
  // What closing has taken of the other goes back.
  const Eigen::Array3i shift = solid.box.first - whole.box.first;
  for (std::size_t v = 0; v < solid.mask.inside.size(); ++v) {
    if (!solid.mask.inside[v]) continue;
    const Eigen::Array3i at = solid.mask.index_of(v).array() + shift;
    if ((at < 0).any() || (at >= whole.mask.size.array()).any()) continue;
    const std::uint8_t owner = bones[whole.mask.index(at.x(), at.y(), at.z())];
    if (owner != kNone && owner != bone) solid.mask.inside[v] = 0;
  }
  return solid;
}

double off_joint_mm2(const Volume& volume, const BoneSolid& whole, const JointSpace& joint,
                     const std::vector<std::uint8_t>& bones) {
  const Eigen::Vector3d spacing = volume.spacing_mm();
  const double far_mm = std::max(kLeastOff_mm, spacing.maxCoeff() + 0.5 * joint.step_mm);
  double area_mm2 = 0;
  for (std::size_t v = 0; v < bones.size(); ++v) {
    if (bones[v] != kAbove) continue;
    for (unsigned axis = 0; axis < 3; ++axis)
      images::for_each_neighbour(
          whole.mask.size, v,
          [&](std::size_t beside) {
            if (bones[beside] != kBelow) return;
            const Eigen::Vector3d p = 0.5 * (whole.lps_of(volume, v) + whole.lps_of(volume, beside));
            if (std::abs(p.z() - joint.at(p.x(), p.y()).height_mm) > far_mm)
              area_mm2 += spacing.prod() / spacing[axis];
          },
          1U << axis);
  }
  return area_mm2;
}

}  // namespace

PartedBones part_bones(const Volume& volume, const BoneSolid& whole, const JointSpace& joint,
                       double threshold, double closing_radius_mm) {
  const VoxelMask bright = bright_of(volume, whole, threshold);
  Bones bones = bones_by_sheet(volume, whole, joint, bright, marrow_within(volume, whole, bright));
  flood(bright, bones);
  return {alone(volume, whole, bones.of_voxel, kAbove, closing_radius_mm),
          alone(volume, whole, bones.of_voxel, kBelow, closing_radius_mm),
          off_joint_mm2(volume, whole, joint, bones.of_voxel)};
}

}  // namespace arthronaut::segmentation
