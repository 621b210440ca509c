#include "planning/segmentation/bone_solid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "planning/segmentation/marrow.h"

namespace arthronaut::segmentation {

namespace {

using images::Volume;
using images::VoxelMask;

// An appendage is worn off from its bone within so much, and has at least this volume then, at most this part
// of the bone's.
constexpr double kDeepestNeck_mm = 4.5, kLeastAppendage_mm3 = 1000, kLargestAppendage_fraction = 0.35;

Box padded(const Volume& volume, const Eigen::Vector3i& low, const Eigen::Vector3i& high, double margin_mm) {
  const Eigen::Vector3i margin = (margin_mm / volume.spacing_mm().array()).ceil().cast<int>() + 2;
  Box box;
  box.first = (low - margin).cwiseMax(0);
  box.size = (high + margin).cwiseMin(volume.size.array().matrix() - Eigen::Vector3i::Ones()) - box.first +
             Eigen::Vector3i::Ones();
  return box;
}

void close_and_fill(const Volume& volume, BoneSolid& solid, double closing_radius_mm) {
  if (closing_radius_mm > 0) images::close_gaps(solid.mask, volume.spacing_mm(), closing_radius_mm);
  fill_marrow(volume, solid);
}

}  // namespace

Eigen::Vector3d BoneSolid::lps_of(const Volume& volume, std::size_t voxel) const {
  return volume.lps_from_index * (box.first + mask.index_of(voxel)).cast<double>();
}

BoneSolid solid_of(const Volume& volume, const std::vector<std::size_t>& voxels, double closing_radius_mm) {
  const auto nx = static_cast<std::size_t>(volume.size.x()), ny = static_cast<std::size_t>(volume.size.y());
  const auto at = [&](std::size_t v) {
    return Eigen::Vector3i(static_cast<int>(v % nx), static_cast<int>(v / nx % ny),
                           static_cast<int>(v / (nx * ny)));
  };
  Eigen::Vector3i low = volume.size, high = Eigen::Vector3i::Constant(-1);
  for (const std::size_t v : voxels) {
    low = low.cwiseMin(at(v));
    high = high.cwiseMax(at(v));
  }
  BoneSolid solid;
  solid.box = padded(volume, low, high, closing_radius_mm);
  solid.mask = VoxelMask(solid.box.size);
  for (const std::size_t v : voxels) {
    const Eigen::Vector3i here = at(v) - solid.box.first;
    solid.mask.inside[solid.mask.index(here.x(), here.y(), here.z())] = 1;
  }
  close_and_fill(volume, solid, closing_radius_mm);
  return solid;
}

BoneSolid solid_of(const Volume& volume, const Box& box, const VoxelMask& part, double closing_radius_mm) {
  BoneSolid solid{box, part};
  close_and_fill(volume, solid, closing_radius_mm);
  return solid;
}

VoxelMask within_other(const BoneSolid& solid, const BoneSolid* other) {
  VoxelMask within(solid.mask.size);
  if (other == nullptr) return within;
  for (std::size_t v = 0; v < within.inside.size(); ++v) {
    const Eigen::Array3i there = (solid.box.first + within.index_of(v) - other->box.first).array();
    if ((there < 0).any() || (there >= other->mask.size.array()).any()) continue;
    within.inside[v] = other->mask.inside[other->mask.index(there.x(), there.y(), there.z())];
  }
  return within;
}

PieceExtent extent_of(const std::vector<Eigen::Vector3d>& points_mm) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), low = points_mm.front(), high = low;
  for (const Eigen::Vector3d& p : points_mm) {
    sum += p;
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return {sum / static_cast<double>(points_mm.size()), high.z() - low.z(), low.z()};
}

double SectionProfile::largest_mm2() const {
  return area_mm2.empty() ? 0 : *std::max_element(area_mm2.begin(), area_mm2.end());
}

double SectionProfile::largest_at_mm() const {
  const auto at = std::max_element(area_mm2.begin(), area_mm2.end()) - area_mm2.begin();
  return low_mm + (static_cast<double>(at) + 0.5) * step_mm;
}

SectionProfile profile_of(const Volume& volume, const BoneSolid& solid) {
  SectionProfile profile;
  const Eigen::RowVector3d rise = volume.lps_from_index.linear().row(2);
  const double voxel_mm3 = std::abs(volume.lps_from_index.linear().determinant());
  profile.step_mm = std::max(2.0, rise.cwiseAbs().maxCoeff());
  double low = std::numeric_limits<double>::infinity(), high = -low;
  std::size_t count = 0;
  std::vector<double> heights;
  const Eigen::Vector3i size = solid.mask.size;
  const double base = (volume.lps_from_index * solid.box.first.cast<double>()).z();
  const auto for_each = [&](const auto& visit) {
    std::size_t v = 0;
    for (int k = 0; k < size.z(); ++k) {
      for (int j = 0; j < size.y(); ++j) {
        for (int i = 0; i < size.x(); ++i, ++v) {
          if (solid.mask.inside[v])
            visit(Eigen::Vector3d(i, j, k), base + rise.x() * i + rise.y() * j + rise.z() * k);
        }
      }
    }
  };
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for_each([&](const Eigen::Vector3d& index, double z) {
    low = std::min(low, z);
    high = std::max(high, z);
    sum += index;
    ++count;
  });
  if (count == 0) return profile;
  profile.low_mm = low - 0.5 * profile.step_mm;
  profile.area_mm2.assign(static_cast<std::size_t>((high - profile.low_mm) / profile.step_mm) + 1, 0);
  for_each([&](const Eigen::Vector3d&, double z) {
    profile.area_mm2[static_cast<std::size_t>((z - profile.low_mm) / profile.step_mm)] +=
        voxel_mm3 / profile.step_mm;
  });
  profile.center_mm =
      volume.lps_from_index * (solid.box.first.cast<double>() + sum / static_cast<double>(count));
  profile.volume_mm3 = voxel_mm3 * static_cast<double>(count);
  return profile;
}

std::vector<Eigen::Vector3d> take_off_appendage(const Volume& volume, BoneSolid& solid,
                                                const VoxelMask& marrow) {
  const Eigen::Vector3d spacing = volume.spacing_mm();
  const double voxel_mm3 = std::abs(volume.lps_from_index.linear().determinant());
  VoxelMask grown = solid.mask;
  std::vector<std::size_t> added;
  for (std::size_t v = 0; v < grown.inside.size(); ++v) {
    if (!marrow.inside[v]) continue;
    grown.inside[v] = 0;
    added.push_back(v);
  }
  const std::vector<float> depths = images::depths_mm(grown, spacing);
  std::vector<Eigen::Vector3d> taken;
  for (double radius = 1.5; radius <= kDeepestNeck_mm; radius += 1) {
    VoxelMask worn = grown;
    for (std::size_t v = 0; v < depths.size(); ++v) worn.inside[v] = depths[v] > radius;
    const auto pieces =
        images::connected_pieces(worn, static_cast<std::size_t>(kLeastAppendage_mm3 / voxel_mm3));
    if (pieces.size() < 2) continue;
    if (static_cast<double>(pieces[1].count) >
        kLargestAppendage_fraction * static_cast<double>(pieces[0].count))
      continue;
    std::vector<std::size_t> others, kept = added;
    kept.insert(kept.end(), pieces[0].voxels.begin(), pieces[0].voxels.end());
    for (std::size_t p = 1; p < pieces.size(); ++p)
      others.insert(others.end(), pieces[p].voxels.begin(), pieces[p].voxels.end());
    const auto to_kept = images::distances_mm(solid.mask.size, kept, spacing),
               to_others = images::distances_mm(solid.mask.size, others, spacing);
    for (std::size_t v = 0; v < depths.size(); ++v) {
      if (!solid.mask.inside[v] || to_kept[v] < to_others[v]) continue;
      solid.mask.inside[v] = 0;
      taken.push_back(solid.lps_of(volume, v));
    }
    return taken;
  }
  return taken;
}

}  // namespace arthronaut::segmentation
