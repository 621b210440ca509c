#include "planning/segmentation/box_blur.h"

#include <algorithm>
#include <cmath>

namespace arthronaut::segmentation {

namespace {

// `lines` side by side lie `step` apart along the axis and are contiguous in memory: summed together.
void blur_block(float* first, std::size_t width, std::size_t step, int n, int reach,
                std::vector<float>& rows) {
  rows.resize(width * (static_cast<std::size_t>(n) + 1));
  float* const sums = rows.data();  // running mean of the line so far
  std::fill(sums, sums + width, 0.0F);
  float* const copies = sums + width;
  for (int i = 0; i < n; ++i)
    std::copy_n(first + static_cast<std::size_t>(i) * step, width,
                copies + static_cast<std::size_t>(i) * width);
  const float share = 1.0F / static_cast<float>(2 * reach + 1);
  for (int i = -reach; i < n; ++i) {
    if (i + reach < n) {
      const float* in = copies + static_cast<std::size_t>(i + reach) * width;
      for (std::size_t x = 0; x < width; ++x) sums[x] += in[x];
    }
    if (i - reach - 1 >= 0) {
      const float* out = copies + static_cast<std::size_t>(i - reach - 1) * width;
      for (std::size_t x = 0; x < width; ++x) sums[x] -= out[x];
    }
    if (i < 0) continue;
    float* to = first + static_cast<std::size_t>(i) * step;
    for (std::size_t x = 0; x < width; ++x) to[x] = sums[x] * share;
  }
}

}  // namespace

void blur_with_box(images::Field& field, const Eigen::Vector3d& spacing_mm, double radius_mm) {
  const auto nx = static_cast<std::size_t>(field.size.x()), ny = static_cast<std::size_t>(field.size.y()),
             nz = static_cast<std::size_t>(field.size.z());
  std::vector<float> rows;
  const auto reach = [&](int axis) { return static_cast<int>(radius_mm / spacing_mm[axis]); };
  float* const values = field.values.data();
  if (const int r = reach(0); r > 0) {
    for (std::size_t line = 0; line < ny * nz; ++line)
      blur_block(values + line * nx, 1, 1, field.size.x(), r, rows);
  }
  if (const int r = reach(1); r > 0) {
    for (std::size_t k = 0; k < nz; ++k) blur_block(values + k * nx * ny, nx, nx, field.size.y(), r, rows);
  }
  if (const int r = reach(2); r > 0) {
    for (std::size_t j = 0; j < ny; ++j) blur_block(values + j * nx, nx, nx * ny, field.size.z(), r, rows);
  }
}

}  // namespace arthronaut::segmentation
