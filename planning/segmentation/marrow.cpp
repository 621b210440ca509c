#include "planning/segmentation/marrow.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>

namespace arthronaut::segmentation {

namespace {

using images::Volume;
using images::VoxelMask;

// Balls that are tried, the smallest first.
constexpr double kSmallestBall_mm = 2.5, kLargestBall_mm = 6.5, kNextBall_mm = 1;
// Marrow has room for a ball so much larger than the one that does not come out. A notch has not.
constexpr double kLeastRoom = 1.5;
// Gaps are looked for in cells of about this size where voxels are smaller.
constexpr double kCell_mm = 1.5;
// Of the threshold: 120 HU in coarse voxels, 167 in fine ones; muscle has 60, a meniscus 90.
constexpr double kDimBone = 2.0 / 3;
// So much longer is the way of the outside through it: dim bone about the marrow is bone, but for its rim.
constexpr double kThroughDim = 4;

// A part of the volume in cells of one or several voxels.
struct Cells {
  Eigen::Vector3i first = Eigen::Vector3i::Zero(), voxels = first;  // in the volume
  Eigen::Vector3i voxels_each = first;
  Eigen::Vector3d spacing_mm = Eigen::Vector3d::Zero();
  VoxelMask is_bone{Eigen::Vector3i::Zero()};
  // What a ball does not come through: bone, and where it is asked, dim bone. No marrow grows into the other
  // bone.
  VoxelMask is_wall = is_bone, is_other = is_bone;

  // Whether it lies where the box of the solid ends and the volume goes on: the bone does not come there.
  [[nodiscard]] bool is_at_margin(const Volume& volume, const Box& box, std::size_t cell) const {
    const Eigen::Array3i at = is_bone.index_of(cell).array();
    const Eigen::Array3i low = first.array() + at * voxels_each.array(), high = low + voxels_each.array() - 1,
                         end = box.first.array() + box.size.array();
    return (box.first.array() > 0 && low <= box.first.array()).any() ||
           (end < volume.size.array() && high >= end - 1).any();
  }
  template <typename Visit>  // visit(cell, voxel of the solid), of those that the solid's box has
  void for_each_voxel(const BoneSolid& solid, const Visit& visit) const {
    const Eigen::Vector3i shift = solid.box.first - first;
    std::size_t voxel = 0;
    for (int k = 0; k < solid.box.size.z(); ++k) {
      for (int j = 0; j < solid.box.size.y(); ++j) {
        for (int i = 0; i < solid.box.size.x(); ++i, ++voxel) {
          const Eigen::Array3i cell = (Eigen::Array3i(i, j, k) + shift.array()) / voxels_each.array();
          visit(is_bone.index(cell.x(), cell.y(), cell.z()), voxel);
        }
      }
    }
  }
};

// With room for the largest ball about the bone.
Cells cells_about(const Volume& volume, const BoneSolid& solid) {
  Cells cells;
  const Eigen::Vector3d voxel_mm = volume.spacing_mm();
  const Eigen::Vector3i margin = ((2 * kLargestBall_mm) / voxel_mm.array()).ceil().cast<int>();
  cells.first = (solid.box.first - margin).cwiseMax(0);
  cells.voxels = (solid.box.first + solid.box.size + margin).cwiseMin(volume.size) - cells.first;
  cells.voxels_each = (kCell_mm / voxel_mm.array()).floor().cwiseMax(1).cast<int>();
  cells.spacing_mm = voxel_mm.cwiseProduct(cells.voxels_each.cast<double>());
  cells.is_bone = VoxelMask(((cells.voxels + cells.voxels_each).array() - 1) / cells.voxels_each.array());
  cells.for_each_voxel(solid, [&](std::size_t cell, std::size_t voxel) {
    cells.is_bone.inside[cell] |= solid.mask.inside[voxel];
  });
  cells.is_wall = cells.is_bone;
  cells.is_other = VoxelMask(cells.is_bone.size);
  return cells;
}

std::vector<float> distances_to_mm(const Cells& cells, const VoxelMask& mask) {
  std::vector<std::size_t> inside;
  for (std::size_t c = 0; c < mask.inside.size(); ++c)
    if (mask.inside[c]) inside.push_back(c);
  return images::distances_mm(mask.size, inside, cells.spacing_mm);
}

// What is as bright as this is no soft tissue, if darker than the bone that is sure: a plate that is thinner
// than a slice. What is nearer to the other bone is of that one: it must not shut off what lies between the
// two.
void wall_up_dim_bone(const Volume& volume, const BoneSolid& solid, const VoxelMask& others, double dim_hu,
                      Cells& cells) {
  cells.for_each_voxel(solid, [&](std::size_t cell, std::size_t voxel) {
    cells.is_other.inside[cell] |= others.inside[voxel] && !cells.is_bone.inside[cell];
  });
  const bool has_other = std::ranges::find(cells.is_other.inside, 1) != cells.is_other.inside.end();
  const auto to_bone_mm = distances_to_mm(cells, cells.is_bone);
  const auto to_other_mm = has_other ? distances_to_mm(cells, cells.is_other) : std::vector<float>{};
  cells.for_each_voxel(solid, [&](std::size_t cell, std::size_t voxel) {
    if (has_other && to_other_mm[cell] < to_bone_mm[cell]) return;
    const Eigen::Vector3i at = solid.box.first + solid.mask.index_of(voxel);
    cells.is_wall.inside[cell] |= volume.at(at.x(), at.y(), at.z()) >= dim_hu;
  });
}

enum Label : std::uint8_t { kFree = 0, kOutside = 1, kMarrow = 2 };

// Where the middle of the ball can be, by whether it comes out; all free where nothing is kept in.
std::vector<std::uint8_t> middles_of(const Volume& volume, const Box& box, const Cells& cells,
                                     const std::vector<float>& distances_mm, double radius_mm) {
  VoxelMask middles(cells.is_bone.size);
  for (std::size_t c = 0; c < distances_mm.size(); ++c)
    middles.inside[c] = distances_mm[c] > static_cast<float>(radius_mm);
  const auto pieces = images::connected_pieces(middles, 1);
  const auto comes_out = [&](const images::VoxelPiece& piece) {
    return std::ranges::any_of(piece.voxels,
                               [&](std::size_t c) { return cells.is_at_margin(volume, box, c); });
  };
  const auto has_room = [&](const images::VoxelPiece& piece) {
    return std::ranges::any_of(piece.voxels,
                               [&](std::size_t c) { return distances_mm[c] > kLeastRoom * radius_mm; });
  };
  std::vector<std::uint8_t> labels(distances_mm.size(), kFree);
  bool has_marrow = false, has_outside = false;
  for (const images::VoxelPiece& piece : pieces) {
    const bool is_outside = comes_out(piece);
    if (!is_outside && !has_room(piece)) continue;
    (is_outside ? has_outside : has_marrow) = true;
    for (const std::size_t c : piece.voxels) labels[c] = is_outside ? kOutside : kMarrow;
  }
  if (!has_marrow || !has_outside) std::ranges::fill(labels, std::uint8_t{kFree});
  return labels;
}

// From both sides at once, the nearer first, so that they meet in the gap.
void grow(const Cells& cells, std::vector<std::uint8_t>& labels) {
  using Front = std::pair<double, std::size_t>;
  std::priority_queue<Front, std::vector<Front>, std::greater<>> fronts;
  for (std::size_t c = 0; c < labels.size(); ++c)
    if (labels[c] != kFree) fronts.emplace(0, c);
  while (!fronts.empty()) {
    const auto [way_mm, from] = fronts.top();
    fronts.pop();
    for (int axis = 0; axis < 3; ++axis)
      images::for_each_neighbour(
          cells.is_bone.size, from,
          [&](std::size_t to) {
            if (labels[to] != kFree || cells.is_bone.inside[to] || cells.is_other.inside[to]) return;
            labels[to] = labels[from];
            const bool is_held_up = labels[to] == kOutside && cells.is_wall.inside[to];
            fronts.emplace(way_mm + (is_held_up ? kThroughDim : 1) * cells.spacing_mm[axis], to);
          },
          1U << axis);
  }
}

// Fills marrow that the end of the volume cuts open. Outside is what comes to a face of the box that is none
// of the volume's, where the bone is kept off by a margin; where all faces are, the largest piece.
void cap_ends(const Volume& volume, BoneSolid& solid) {
  VoxelMask& mask = solid.mask;
  const Eigen::Vector3i last = mask.size - Eigen::Vector3i::Ones();
  VoxelMask open(mask.size);
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    Eigen::Vector3i at;
    for (const int end : {0, last[axis]}) {
      at[axis] = end;
      for (at[v] = 0; at[v] <= last[v]; ++at[v]) {
        for (at[u] = 0; at[u] <= last[u]; ++at[u]) {
          const std::size_t voxel = mask.index(at.x(), at.y(), at.z());
          open.inside[voxel] = mask.inside[voxel] == 0;
        }
      }
    }
  }
  const auto is_within_volume = [&](std::size_t voxel) {
    const Eigen::Array3i at = mask.index_of(voxel).array();
    const Eigen::Array3i in_volume = at + solid.box.first.array();
    return (at == 0 && in_volume > 0).any() ||
           (at == last.array() && in_volume < volume.size.array() - 1).any();
  };
  std::vector<images::VoxelPiece> pieces = images::connected_pieces(open, 1);
  const auto comes_out = [&](const images::VoxelPiece& piece) {
    return std::any_of(piece.voxels.begin(), piece.voxels.end(), is_within_volume);
  };
  const bool has_margin = std::any_of(pieces.begin(), pieces.end(), comes_out);
  for (std::size_t i = 0; i < pieces.size(); ++i)
    if (has_margin ? !comes_out(pieces[i]) : i > 0)
      for (const std::size_t voxel : pieces[i].voxels) mask.inside[voxel] = 1;
}

}  // namespace

void fill_marrow(const Volume& volume, BoneSolid& solid) {
  cap_ends(volume, solid);
  images::fill_unreached(solid.mask);
}

ClosedMarrow close_marrow(const Volume& volume, BoneSolid& solid, const VoxelMask& others, double threshold) {
  ClosedMarrow closed{solid.mask};
  Cells cells = cells_about(volume, solid);
  // With dim bone for a wall marrow that is itself as bright would have no room: it is asked second.
  for (const bool has_dim_walls : {false, true}) {
    if (has_dim_walls) wall_up_dim_bone(volume, solid, others, kDimBone * threshold, cells);
    std::vector<float> distances_mm = distances_to_mm(cells, cells.is_wall);
    for (double radius = kSmallestBall_mm; radius <= kLargestBall_mm; radius += kNextBall_mm) {
      std::vector<std::uint8_t> labels = middles_of(volume, solid.box, cells, distances_mm, radius);
      if (std::ranges::find(labels, std::uint8_t{kMarrow}) == labels.end()) continue;
      grow(cells, labels);
      cells.for_each_voxel(solid, [&](std::size_t cell, std::size_t voxel) {
        if (labels[cell] == kMarrow) solid.mask.inside[voxel] = 1;
      });
      for (std::size_t c = 0; c < labels.size(); ++c)
        if (labels[c] == kMarrow) cells.is_bone.inside[c] = cells.is_wall.inside[c] = 1;
      distances_mm = distances_to_mm(cells, cells.is_wall);
      closed.widest_mm = std::max(closed.widest_mm, 2 * radius);
      closed.has_dim_walls = closed.has_dim_walls || has_dim_walls;
    }
  }
  if (closed.widest_mm > 0) fill_marrow(volume, solid);
  for (std::size_t v = 0; v < solid.mask.inside.size(); ++v)
    closed.voxels.inside[v] = solid.mask.inside[v] && !closed.voxels.inside[v];
  return closed;
}

}  // namespace arthronaut::segmentation
