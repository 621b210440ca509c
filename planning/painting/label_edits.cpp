#include "planning/painting/label_edits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "planning/geometry/error.h"
#include "planning/images/voxel_mask.h"

namespace arthronaut::painting {

namespace {

using Eigen::Vector3i;
using images::Volume;
using images::VoxelMask;

// Depths closer to each other than this are one level of the watershed.
constexpr double kDepthStep_mm = 0.1;
// Gaps of a cortex up to twice this are taken as closed while bones are parted.
constexpr double kGapOfShell_mm = 2;

// A part of the grid.
struct Part {
  Vector3i first = Vector3i::Zero(), size = Vector3i::Zero();

  template <typename Visit>
  void for_each_row(const Volume& grid, const Visit& visit) const {  // visit(first voxel of part, of grid)
    std::size_t here = 0;
    for (int k = 0; k < size.z(); ++k) {
      for (int j = 0; j < size.y(); ++j, here += static_cast<std::size_t>(size.x()))
        visit(here, grid.index(first.x(), first.y() + j, first.z() + k));
    }
  }
  [[nodiscard]] Labels cut_out(const Labels& labels, const Volume& grid) const {
    Labels part(static_cast<std::size_t>(size.cast<std::int64_t>().prod()));
    for_each_row(grid, [&](std::size_t here, std::size_t there) {
      std::copy_n(labels.begin() + static_cast<std::ptrdiff_t>(there), size.x(),
                  part.begin() + static_cast<std::ptrdiff_t>(here));
    });
    return part;
  }
  void put_back(const Labels& part, Labels& labels, const Volume& grid) const {
    for_each_row(grid, [&](std::size_t here, std::size_t there) {
      std::copy_n(part.begin() + static_cast<std::ptrdiff_t>(here), size.x(),
                  labels.begin() + static_cast<std::ptrdiff_t>(there));
    });
  }
  // Of that size and place; its values are none.
  [[nodiscard]] Volume as_grid(const Volume& grid) const {
    Volume part;
    part.size = size;
    part.lps_from_index = grid.lps_from_index;
    part.lps_from_index.translation() = grid.lps_from_index * first.cast<double>();
    part.values.resize(static_cast<std::size_t>(size.cast<std::int64_t>().prod()));
    return part;
  }
};

void refuse_other_size(std::span<const std::uint8_t> labels, const Volume& grid) {
  if (labels.size() != grid.values.size()) throw InvalidInput("the labels are not of the volume's size");
}

// What the labels for which is_one() holds take, and so much around it; nullopt without any.
template <typename IsOne>
std::optional<Part> part_of(const Labels& labels, const Volume& grid, double margin_mm, const IsOne& is_one) {
  refuse_other_size(labels, grid);
  Vector3i low = grid.size, high = Vector3i::Constant(-1);
  std::size_t v = 0;
  for (int k = 0; k < grid.size.z(); ++k) {
    for (int j = 0; j < grid.size.y(); ++j) {
      for (int i = 0; i < grid.size.x(); ++i, ++v) {
        if (!is_one(labels[v])) continue;
        low = low.cwiseMin(Vector3i(i, j, k));
        high = high.cwiseMax(Vector3i(i, j, k));
      }
    }
  }
  if (high.x() < 0) return std::nullopt;
  const Vector3i margin =
      (margin_mm * grid.spacing_mm().cwiseInverse()).array().ceil().cast<int>().max(margin_mm > 0 ? 1 : 0);
  low = (low - margin).cwiseMax(0);
  high = (high + margin).cwiseMin(grid.size - Vector3i::Ones());
  return Part{low, high - low + Vector3i::Ones()};
}

std::optional<Part> part_of(const Labels& labels, const Volume& grid, double margin_mm, std::uint8_t label) {
  return part_of(labels, grid, margin_mm, [label](std::uint8_t l) { return l == label; });
}

template <typename IsOne>
VoxelMask mask_of(const Labels& labels, const Vector3i& size, const IsOne& is_one) {
  VoxelMask mask(size);
  for (std::size_t v = 0; v < labels.size(); ++v) mask.inside[v] = is_one(labels[v]);
  return mask;
}

// A stroke near a bone's border stands for all of the bone: it takes what can be reached by going deeper all
// the way. Else the other bone would come in through a neck that is deeper than the stroke.
void climb(const VoxelMask& mask, const std::vector<float>& depth_mm, Labels& owner) {
  std::vector<std::size_t> front;
  for (std::size_t v = 0; v < owner.size(); ++v)
    if (owner[v] != kNothing) front.push_back(v);
  for (std::size_t at = 0; at < front.size(); ++at) {
    const std::size_t v = front[at];
    images::for_each_neighbour(mask.size, v, [&](std::size_t next) {
      if (!mask.inside[next] || owner[next] != kNothing || depth_mm[next] <= depth_mm[v]) return;
      owner[next] = owner[v];
      front.push_back(next);
    });
  }
}

// Floods the mask from what is painted, deepest first. `owner` holds the strokes within the mask, and becomes
// every voxel's that is reached.
void flood(const VoxelMask& mask, const std::vector<float>& depth_mm, Labels& owner) {
  const auto level_of = [](double depth) { return static_cast<std::size_t>(depth / kDepthStep_mm); };
  float deepest = 0;
  for (std::size_t v = 0; v < depth_mm.size(); ++v)
    if (mask.inside[v] && std::isfinite(depth_mm[v])) deepest = std::max(deepest, depth_mm[v]);
  std::vector<std::vector<std::uint32_t>> levels(level_of(deepest) + 1);
  const auto level = [&](std::size_t v) {
    return std::min(level_of(std::min(depth_mm[v], deepest)), levels.size() - 1);
  };
  for (std::size_t v = 0; v < owner.size(); ++v)
    if (owner[v] != kNothing) levels[level(v)].push_back(static_cast<std::uint32_t>(v));
  for (std::size_t at = levels.size(); at-- > 0;) {
    // What is reached from here is as deep as here at the most: it joins this level or a lower one.
    for (std::size_t n = 0; n < levels[at].size(); ++n) {
      const std::size_t v = levels[at][n];
      images::for_each_neighbour(mask.size, v, [&](std::size_t next) {
        if (!mask.inside[next] || owner[next] != kNothing) return;
        owner[next] = owner[v];
        levels[std::min(level(next), at)].push_back(static_cast<std::uint32_t>(next));
      });
    }
    levels[at].clear();
  }
}

}  // namespace

void add_above(Labels& labels, const Volume& volume, float threshold, std::uint8_t label) {
  refuse_other_size(labels, volume);
  for (std::size_t v = 0; v < labels.size(); ++v)
    if (labels[v] == kNothing && volume.values[v] >= threshold) labels[v] = label;
}

std::size_t keep_largest(Labels& labels, const Volume& grid, std::uint8_t label) {
  const auto part = part_of(labels, grid, 0, label);
  if (!part) return 0;
  Labels cut = part->cut_out(labels, grid);
  const auto pieces =
      images::connected_pieces(mask_of(cut, part->size, [label](auto l) { return l == label; }), 1);
  std::size_t taken = 0;
  for (std::size_t p = 1; p < pieces.size(); ++p) {
    for (const std::size_t v : pieces[p].voxels) cut[v] = kNothing;
    taken += pieces[p].count;
  }
  part->put_back(cut, labels, grid);
  return taken;
}

void fill_holes(Labels& labels, const Volume& grid, std::uint8_t label, double closing_radius_mm) {
  const auto part = part_of(labels, grid, closing_radius_mm, label);
  if (!part) return;
  Labels cut = part->cut_out(labels, grid);
  VoxelMask mask = mask_of(cut, part->size, [label](auto l) { return l == label; });
  if (closing_radius_mm > 0) images::close_gaps(mask, grid.spacing_mm(), closing_radius_mm);
  images::fill_enclosed(mask, axis_along(grid, Eigen::Vector3d::UnitZ()));
  for (std::size_t v = 0; v < cut.size(); ++v)
    if (cut[v] == kNothing && mask.inside[v]) cut[v] = label;
  part->put_back(cut, labels, grid);
}

void part_by_strokes(Labels& labels, const Volume& grid, std::span<const std::uint8_t> strokes) {
  refuse_other_size(strokes, grid);
  const auto is_bone = [](std::uint8_t l) { return l == kFemur || l == kTibia; };
  const auto part = part_of(labels, grid, kGapOfShell_mm, is_bone);
  if (!part) throw InvalidInput("there is no bone yet that could be parted");
  Labels cut = part->cut_out(labels, grid);
  Labels owner = part->cut_out({strokes.begin(), strokes.end()}, grid);
  VoxelMask mask = mask_of(cut, part->size, is_bone);
  images::close_gaps(mask, grid.spacing_mm(), kGapOfShell_mm);
  images::fill_enclosed(mask, axis_along(grid, Eigen::Vector3d::UnitZ()));
  std::array<bool, 256> is_painted{};
  for (std::size_t v = 0; v < owner.size(); ++v) {
    if (!mask.inside[v]) owner[v] = kNothing;
    is_painted[owner[v]] = true;
  }
  if (std::count(is_painted.begin() + 1, is_painted.end(), true) < 2)
    throw InvalidInput("paint a stroke into each of the bones that touch");
  const std::vector<float> depth_mm = images::depths_mm(mask, grid.spacing_mm());
  climb(mask, depth_mm, owner);
  flood(mask, depth_mm, owner);
  for (std::size_t v = 0; v < cut.size(); ++v) {
    if (is_bone(cut[v]) && owner[v] != kNothing) cut[v] = owner[v] == kSurroundings ? kNothing : owner[v];
  }
  part->put_back(cut, labels, grid);
}

void fill_between(Labels& labels, const Volume& grid, int axis, std::uint8_t label) {
  const auto part = part_of(labels, grid, grid.spacing_mm().maxCoeff(), label);
  if (!part) return;
  Labels cut = part->cut_out(labels, grid);
  segmentation::fill_between_slices(cut, part->as_grid(grid), axis, label);
  part->put_back(cut, labels, grid);
}

void smooth(Labels& labels, const Volume& grid, std::uint8_t label, double radius_mm) {
  const auto part = part_of(labels, grid, 3 * radius_mm, label);
  if (!part) return;
  Labels cut = part->cut_out(labels, grid);
  segmentation::smooth_label(cut, part->as_grid(grid), label, radius_mm, kNothing);
  part->put_back(cut, labels, grid);
}

int axis_along(const Volume& grid, const Eigen::Vector3d& direction) {
  Eigen::Index axis = 0;
  (grid.lps_from_index.linear().colwise().normalized().transpose() * direction).cwiseAbs().maxCoeff(&axis);
  return static_cast<int>(axis);
}

double volume_ml(std::span<const std::uint8_t> labels, const Volume& grid, std::uint8_t label) {
  const auto count = std::count(labels.begin(), labels.end(), label);
  return std::abs(grid.lps_from_index.linear().determinant()) / 1000 * static_cast<double>(count);
}

}  // namespace arthronaut::painting
