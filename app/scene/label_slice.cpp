#include "app/scene/label_slice.h"

#include <algorithm>
#include <cmath>

namespace arthronaut::scene {

namespace {

using Eigen::Vector3d;

constexpr std::uint32_t kOpaque = 0xFF000000U;  // alpha is the last byte

// The label of each pixel; 0 outside.
void sample(const images::Volume& volume, const LabelLayer& layer, const SlicePlane& plane,
            const Eigen::Vector2i& size_px, std::vector<std::uint8_t>& labels) {
  const auto width = static_cast<std::size_t>(size_px.x());
  labels.assign(width * static_cast<std::size_t>(size_px.y()), 0);
  const Eigen::Affine3d index_from_lps = volume.lps_from_index.inverse();
  const Vector3d step = index_from_lps.linear() * (plane.mm_per_px * plane.right);
  const Vector3d end = volume.size.cast<double>().array() - 0.5;
  for (int y = 0; y < size_px.y(); ++y) {
    const Vector3d start = index_from_lps * plane.point_at({0, y}, size_px);
    double from = 0, to = size_px.x() - 1;
    for (int axis = 0; axis < 3; ++axis) {  // where the row is within the outermost voxels
      if (std::abs(step[axis]) < 1e-12) {
        if (start[axis] < -0.5 || start[axis] >= end[axis]) to = -1;
        continue;
      }
      const double a = (-0.5 - start[axis]) / step[axis], b = (end[axis] - start[axis]) / step[axis];
      from = std::max(from, std::min(a, b));
      to = std::min(to, std::max(a, b));
    }
    std::uint8_t* row = labels.data() + static_cast<std::size_t>(y) * width;
    for (int x = static_cast<int>(std::ceil(from)); x <= static_cast<int>(std::floor(to)); ++x) {
      const Eigen::Vector3i at =
          (start + x * step).array().round().cast<int>().max(0).min(volume.size.array() - 1);
      const std::size_t voxel = volume.index(at.x(), at.y(), at.z());
      row[x] = layer.threshold ? static_cast<std::uint8_t>(volume.values[voxel] >= *layer.threshold)
                               : layer.labels[voxel];
    }
  }
}

}  // namespace

void draw_labels(const images::Volume& volume, std::span<const LabelLayer> layers, const SlicePlane& plane,
                 const Eigen::Vector2i& size_px, std::vector<std::uint32_t>& rgba) {
  const int width = std::max(size_px.x(), 0), height = std::max(size_px.y(), 0);
  rgba.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
  std::vector<std::uint8_t> labels;
  for (const LabelLayer& layer : layers) {
    if (!layer.threshold && layer.labels.size() != volume.values.size()) continue;
    sample(volume, layer, plane, {width, height}, labels);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const auto at =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
        const std::uint8_t label = labels[at];
        if (label >= layer.colors.size() || (layer.colors[label] & kOpaque) == 0) continue;
        const bool is_border = (x > 0 && labels[at - 1] != label) ||
                               (x + 1 < width && labels[at + 1] != label) ||
                               (y > 0 && labels[at - static_cast<std::size_t>(width)] != label) ||
                               (y + 1 < height && labels[at + static_cast<std::size_t>(width)] != label);
        rgba[at] = is_border ? layer.colors[label] | kOpaque : layer.colors[label];
      }
    }
  }
}

}  // namespace arthronaut::scene
