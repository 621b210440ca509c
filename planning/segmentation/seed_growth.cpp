#include "planning/segmentation/seed_growth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "planning/geometry/error.h"
#include "planning/geometry/quantile.h"
#include "planning/images/contour.h"
#include "planning/images/voxel_mask.h"
#include "planning/segmentation/box_blur.h"

namespace arthronaut::segmentation {

namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr double kCoarse_mm = 1.0;
// A difference of so many times the noise is an edge like any stronger one.
constexpr double kStrongEdge = 12;
constexpr int kLargestCost = 255;
// What a step costs where nothing changes: of two ways without an edge the shorter one counts.
constexpr int kFlatCost = 1;
// Noise of more than this part of the grey values' range is blurred away before the coarse labels spread; the
// fronts of thin parts suffer by it where it is not needed.
constexpr double kMuchNoise_fraction = 0.09, kBlurOfNoise_mm = 1.2;
// How far from a border of the coarse labels the fine ones are found anew, in coarse voxels.
constexpr int kBand = 1;

struct Grid {
  Vector3i size = Vector3i::Zero();
  std::vector<float> grey;

  [[nodiscard]] std::size_t count() const { return grey.size(); }
};

template <typename Visit>
void for_each_voxel(const Vector3i& size, const Visit& visit) {
  std::size_t v = 0;
  for (int k = 0; k < size.z(); ++k) {
    for (int j = 0; j < size.y(); ++j) {
      for (int i = 0; i < size.x(); ++i) visit(i, j, k, v++);
    }
  }
}

// The usual difference of neighbours: what noise alone makes.
double noise_of(const Grid& grid) {
  std::vector<float> differences;
  const std::size_t stride = std::max<std::size_t>(1, grid.count() / 200000);
  for (std::size_t v = 0; v + 1 < grid.count(); v += stride)
    differences.push_back(std::abs(grid.grey[v + 1] - grid.grey[v]));
  if (differences.empty()) return 1;
  const float middle = geometry::median_in_place(std::span(differences));
  const auto [low, high] = std::minmax_element(grid.grey.begin(), grid.grey.end());
  return std::max<double>(middle, 1e-3 * (*high - *low) + 1e-6F);
}

// Shortest paths from what is labelled to what is not, by buckets of whole costs (Dial 1969). Voxels for
// which `may_change` is 0 stay as they are and pass nothing on but their own label.
void spread(const Grid& grid, Labels& labels, const std::vector<std::uint8_t>& may_change) {
  const double scale = kLargestCost / (kStrongEdge * kStrongEdge * noise_of(grid) * noise_of(grid));
  std::vector<std::uint32_t> cost(grid.count(), UINT32_MAX);
  std::array<std::vector<std::uint32_t>, kLargestCost + kFlatCost + 1> buckets;
  const auto relax_all = [&](std::size_t v, std::uint32_t here, const auto& push) {
    images::for_each_neighbour(grid.size, v, [&](std::size_t next) {
      if (!may_change[next]) return;
      const double difference = grid.grey[next] - grid.grey[v];
      const int edge = static_cast<int>(std::min<double>(kLargestCost, scale * difference * difference));
      const std::uint32_t there = here + static_cast<std::uint32_t>(kFlatCost + edge);
      if (there >= cost[next]) return;
      cost[next] = there;
      labels[next] = labels[v];
      push(next, there);
    });
  };
  std::size_t waiting = 0;
  const auto push = [&](std::size_t v, std::uint32_t at) {
    buckets[at % buckets.size()].push_back(static_cast<std::uint32_t>(v));
    ++waiting;
  };
  for (std::size_t v = 0; v < grid.count(); ++v) {
    if (labels[v] == 0 || may_change[v]) continue;
    cost[v] = 0;
    relax_all(v, 0, push);
  }
  std::vector<std::uint32_t> now;
  for (std::uint32_t at = 0; waiting > 0; ++at) {
    auto& bucket = buckets[at % buckets.size()];
    if (bucket.empty()) continue;
    now.swap(bucket);
    bucket.clear();
    waiting -= now.size();
    for (const std::uint32_t v : now) {
      if (cost[v] == at) relax_all(v, at, push);
    }
  }
}

struct Coarse {
  Grid grid;
  Vector3i factor = Vector3i::Ones();
  [[nodiscard]] std::size_t of(int i, int j, int k) const {
    return static_cast<std::size_t>(i / factor.x()) +
           static_cast<std::size_t>(grid.size.x()) *
               (static_cast<std::size_t>(j / factor.y()) +
                static_cast<std::size_t>(grid.size.y()) * static_cast<std::size_t>(k / factor.z()));
  }
};

Coarse coarse_of(const images::Volume& volume) {
  Coarse coarse;
  const Vector3d spacing = volume.spacing_mm();
  for (int axis = 0; axis < 3; ++axis) {
    coarse.factor[axis] = std::max(1, static_cast<int>(std::lround(kCoarse_mm / spacing[axis])));
    coarse.grid.size[axis] = (volume.size[axis] + coarse.factor[axis] - 1) / coarse.factor[axis];
  }
  const auto count = static_cast<std::size_t>(coarse.grid.size.cast<std::int64_t>().prod());
  std::vector<float> share(count, 0);
  coarse.grid.grey.assign(count, 0);
  for_each_voxel(volume.size, [&](int i, int j, int k, std::size_t v) {
    const std::size_t there = coarse.of(i, j, k);
    coarse.grid.grey[there] += volume.values[v];
    share[there] += 1;
  });
  for (std::size_t v = 0; v < count; ++v) coarse.grid.grey[v] /= share[v];
  return coarse;
}

images::Field field_of(const Vector3i& size) {
  images::Field field;
  field.size = size;
  field.values.assign(static_cast<std::size_t>(size.cast<std::int64_t>().prod()), 0.0F);
  return field;
}

void blur(Grid& grid, const Vector3d& spacing_mm, double radius_mm) {
  images::Field soft = field_of(grid.size);
  soft.values.swap(grid.grey);
  blur_with_box(soft, spacing_mm, radius_mm);
  grid.grey.swap(soft.values);
}

// Of the coarse grid, without its extremes.
double range_of(const Grid& grid) {
  std::vector<float> sorted;
  const std::size_t stride = std::max<std::size_t>(1, grid.count() / 100000);
  for (std::size_t v = 0; v < grid.count(); v += stride) sorted.push_back(grid.grey[v]);
  std::sort(sorted.begin(), sorted.end());
  return sorted[sorted.size() * 95 / 100] - sorted[sorted.size() * 5 / 100];
}

// Voxels whose surroundings have one label are sure of it.
std::vector<std::uint8_t> near_a_border(const Labels& labels, const Vector3i& size) {
  std::vector<std::uint8_t> near(labels.size(), 0);
  const auto nx = static_cast<std::size_t>(size.x()), plane = nx * static_cast<std::size_t>(size.y());
  for_each_voxel(size, [&](int i, int j, int k, std::size_t v) {
    for (int dk = std::max(-kBand, -k); dk <= std::min(kBand, size.z() - 1 - k); ++dk) {
      for (int dj = std::max(-kBand, -j); dj <= std::min(kBand, size.y() - 1 - j); ++dj) {
        for (int di = std::max(-kBand, -i); di <= std::min(kBand, size.x() - 1 - i); ++di) {
          const std::size_t beside = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(v) + di +
                                                              dj * static_cast<std::ptrdiff_t>(nx) +
                                                              dk * static_cast<std::ptrdiff_t>(plane));
          if (labels[beside] != labels[v]) {
            near[v] = 1;
            return;
          }
        }
      }
    }
  });
  return near;
}

}  // namespace

Labels grow_from_seeds(const images::Volume& volume, std::span<const std::uint8_t> seeds,
                       const SeedGrowthOptions& options) {
  if (seeds.size() != volume.values.size())
    throw InvalidInput("the seeds are not painted in the grid of the volume");
  std::array<bool, 256> is_painted{};
  for (const std::uint8_t label : seeds) is_painted[label] = true;
  if (std::count(is_painted.begin() + 1, is_painted.end(), true) < 2)
    throw InvalidInput("the seeds hold fewer than two labels: paint the bones and what surrounds them");
  const auto tell = [&](double fraction) {
    if (options.on_progress) options.on_progress(fraction);
  };
  tell(0);
  Grid fine{volume.size, volume.values};
  Coarse coarse = coarse_of(volume);
  const Vector3d coarse_mm = volume.spacing_mm().cwiseProduct(coarse.factor.cast<double>());
  if (noise_of(fine) > kMuchNoise_fraction * range_of(coarse.grid))
    blur(coarse.grid, coarse_mm, kBlurOfNoise_mm);
  Labels coarse_labels(coarse.grid.count(), 0);
  std::vector<std::uint8_t> may_change(coarse.grid.count(), 1);
  for_each_voxel(volume.size, [&](int i, int j, int k, std::size_t v) {
    if (seeds[v] == 0) return;
    const std::size_t there = coarse.of(i, j, k);
    coarse_labels[there] = seeds[v];
    may_change[there] = 0;
  });
  tell(0.1);
  spread(coarse.grid, coarse_labels, may_change);
  tell(0.4);
  const auto near = near_a_border(coarse_labels, coarse.grid.size);
  // One voxel to each side where voxels are small.
  blur(fine, volume.spacing_mm(), std::min(0.5, 1.01 * volume.spacing_mm().minCoeff()));
  tell(0.6);
  Labels labels(seeds.begin(), seeds.end());
  std::vector<std::uint8_t> is_open(labels.size(), 0);
  for_each_voxel(volume.size, [&](int i, int j, int k, std::size_t v) {
    if (labels[v] != 0) return;
    const std::size_t there = coarse.of(i, j, k);
    if (near[there]) {
      is_open[v] = 1;
    } else {
      labels[v] = coarse_labels[there];
    }
  });
  tell(0.7);
  spread(fine, labels, is_open);
  tell(1);
  return labels;
}

void fill_between_slices(Labels& labels, const images::Volume& grid, int axis, std::uint8_t label) {
  if (labels.size() != grid.values.size() || axis < 0 || axis > 2)
    throw InvalidInput("the labels are not of the volume's size");
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const Vector3d spacing = grid.spacing_mm();
  const auto voxel = [&](int a, int b, int slice) {
    Vector3i at;
    at[u] = a;
    at[v] = b;
    at[axis] = slice;
    return grid.index(at.x(), at.y(), at.z());
  };
  const Vector3i slice_size(grid.size[u], grid.size[v], 1);
  // Signed distances within a slice, positive inside; empty where the label is not painted.
  const auto signed_distances = [&](int slice) {
    images::VoxelMask inside(slice_size);
    for (int b = 0; b < slice_size.y(); ++b) {
      for (int a = 0; a < slice_size.x(); ++a)
        inside.inside[inside.index(a, b, 0)] = labels[voxel(a, b, slice)] == label;
    }
    if (inside.count() == 0) return std::vector<float>{};
    return images::signed_depths_mm(inside, Vector3d(spacing[u], spacing[v], 1));
  };
  std::vector<float> last;
  int last_slice = -1;
  for (int slice = 0; slice < grid.size[axis]; ++slice) {
    std::vector<float> here = signed_distances(slice);
    if (here.empty()) continue;
    for (int between = last_slice + 1; last_slice >= 0 && between < slice; ++between) {
      const auto share = static_cast<float>(between - last_slice) / static_cast<float>(slice - last_slice);
      for (int b = 0; b < slice_size.y(); ++b) {
        for (int a = 0; a < slice_size.x(); ++a) {
          const std::size_t i = static_cast<std::size_t>(a) +
                                static_cast<std::size_t>(slice_size.x()) * static_cast<std::size_t>(b);
          std::uint8_t& there = labels[voxel(a, b, between)];
          if (there == 0 && (1 - share) * last[i] + share * here[i] > 0) there = label;
        }
      }
    }
    last = std::move(here);
    last_slice = slice;
  }
}

void smooth_label(Labels& labels, const images::Volume& grid, std::uint8_t label, double radius_mm,
                  std::uint8_t instead) {
  if (labels.size() != grid.values.size()) throw InvalidInput("the labels are not of the volume's size");
  images::Field soft = field_of(grid.size);
  for (std::size_t v = 0; v < labels.size(); ++v) soft.values[v] = labels[v] == label ? 1.0F : 0.0F;
  for (int pass = 0; pass < 2; ++pass) blur_with_box(soft, grid.spacing_mm(), radius_mm);
  // As many voxels as before: at half-way a blur would take from what bulges.
  std::vector<float> eligible;
  std::size_t count = 0;
  for (std::size_t v = 0; v < labels.size(); ++v) {
    if (labels[v] != label && labels[v] != instead) continue;
    eligible.push_back(soft.values[v]);
    count += labels[v] == label;
  }
  if (count == 0 || count == eligible.size()) return;
  const auto level = eligible.end() - static_cast<std::ptrdiff_t>(count);
  std::nth_element(eligible.begin(), level, eligible.end());
  for (std::size_t v = 0; v < labels.size(); ++v) {
    if (labels[v] == label || labels[v] == instead) labels[v] = soft.values[v] >= *level ? label : instead;
  }
}

}  // namespace arthronaut::segmentation
