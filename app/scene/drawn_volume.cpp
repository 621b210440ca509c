#include "app/scene/drawn_volume.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/scene/reslice.h"

namespace arthronaut::scene {

namespace {

constexpr double kLowestCt_hu = -1024, kHighestCt_hu = 3071;
constexpr double kLevelsOfGrey = 1023;
constexpr int kStepsOfGrey = 40;
constexpr double kStep_hu = 25;

struct Block {
  Eigen::Vector3i first, count, factor;  // of the volume's voxels; blocks along each axis
};

// The voxels whose centres span the box; nullopt where there are none.
std::optional<Block> voxels_of(const images::Volume& volume, const geometry::Bounds& box_mm) {
  const Eigen::Affine3d index_from_lps = volume.lps_from_index.inverse();
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e9), high = -low;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d at(corner & 1 ? box_mm.max_mm.x() : box_mm.min_mm.x(),
                             corner & 2 ? box_mm.max_mm.y() : box_mm.min_mm.y(),
                             corner & 4 ? box_mm.max_mm.z() : box_mm.min_mm.z());
    const Eigen::Vector3d index = index_from_lps * at;
    low = low.cwiseMin(index);
    high = high.cwiseMax(index);
  }
  Block block;
  block.factor = Eigen::Vector3i::Ones();
  for (int axis = 0; axis < 3; ++axis) {
    const double last = volume.size[axis] - 1.0;
    const double from = std::max(std::floor(low[axis]), 0.0), to = std::min(std::ceil(high[axis]), last);
    if (to - from < 1) return std::nullopt;
    block.first[axis] = static_cast<int>(from);
    block.count[axis] = static_cast<int>(to - from) + 1;
  }
  return block;
}

std::size_t voxels_in(const Block& block) {
  std::size_t count = 1;
  for (int axis = 0; axis < 3; ++axis)
    count *= static_cast<std::size_t>(std::max(block.count[axis] / block.factor[axis], 2));
  return count;
}

// Larger blocks along the axis on which they are shortest, until there are few enough.
void coarsen(Block& block, const Eigen::Vector3d& spacing_mm, std::size_t most_voxels) {
  while (voxels_in(block) > most_voxels) {
    int shortest = -1;
    for (int axis = 0; axis < 3; ++axis) {
      if (block.count[axis] < 2 * (block.factor[axis] + 1)) continue;
      if (shortest < 0 ||
          block.factor[axis] * spacing_mm[axis] < block.factor[shortest] * spacing_mm[shortest])
        shortest = axis;
    }
    if (shortest < 0) return;
    ++block.factor[shortest];
  }
}

}  // namespace

std::shared_ptr<const DrawnVolume> drawn_volume(const images::Volume& volume, const geometry::Bounds& box_mm,
                                                std::size_t most_voxels) {
  auto block = voxels_of(volume, box_mm);
  if (!block) return nullptr;
  coarsen(*block, volume.spacing_mm(), most_voxels);
  auto drawn = std::make_shared<DrawnVolume>();
  drawn->size = block->count.cwiseQuotient(block->factor);
  drawn->is_ct = volume.modality == images::Modality::Ct;
  if (drawn->is_ct) {
    drawn->lowest = kLowestCt_hu;
    drawn->highest = kHighestCt_hu;
  } else {
    const GreyWindow window = automatic_window(volume);
    drawn->lowest = window.level - window.width / 2;
    drawn->highest = window.level + window.width / 2;
    drawn->per_level = window.width / kLevelsOfGrey;
  }
  const Eigen::Vector3d factor = block->factor.cast<double>();
  const Eigen::Vector3d middle = 0.5 * (factor - Eigen::Vector3d::Ones());  // of the first block
  drawn->lps_from_index = volume.lps_from_index * Eigen::Translation3d(block->first.cast<double>() + middle) *
                          Eigen::Scaling(factor);
  const double in_block = factor.prod();
  drawn->levels.resize(static_cast<std::size_t>(drawn->size.x()) * static_cast<std::size_t>(drawn->size.y()) *
                       static_cast<std::size_t>(drawn->size.z()));
  std::vector<double> row(static_cast<std::size_t>(drawn->size.x()));
  std::size_t out = 0;
  for (int k = 0; k < drawn->size.z(); ++k) {
    for (int j = 0; j < drawn->size.y(); ++j) {
      std::ranges::fill(row, 0.0);
      for (int dk = 0; dk < block->factor.z(); ++dk) {
        for (int dj = 0; dj < block->factor.y(); ++dj) {
          const float* at = volume.values.data() +
                            volume.index(block->first.x(), block->first.y() + j * block->factor.y() + dj,
                                         block->first.z() + k * block->factor.z() + dk);
          for (double& sum : row)
            for (int di = 0; di < block->factor.x(); ++di) sum += *at++;
        }
      }
      for (const double sum : row) {
        const double value = std::clamp(sum / in_block, drawn->lowest, drawn->highest);
        drawn->levels[out++] =
            static_cast<std::uint16_t>(std::lround((value - drawn->lowest) / drawn->per_level));
      }
    }
  }
  return drawn;
}

std::string in_words(VolumePreset preset) {
  switch (preset) {
    case VolumePreset::Bone:
      return "bone";
    case VolumePreset::BoneAndSoftTissue:
      return "bone and soft tissue";
    case VolumePreset::Grey:
      return "grey values";
  }
  return "";
}

double first_threshold(const DrawnVolume& volume) {
  constexpr double kBone_hu = 250, kAboveAir = 0.1;
  return volume.is_ct ? kBone_hu : volume.lowest + kAboveAir * (volume.highest - volume.lowest);
}

double moved_threshold(const DrawnVolume& volume, double threshold, int steps) {
  const double step = volume.is_ct ? kStep_hu : (volume.highest - volume.lowest) / kStepsOfGrey;
  return std::clamp(threshold + steps * step, volume.lowest + step, volume.highest - step);
}

}  // namespace arthronaut::scene
