#include "planning/images/thick_slices.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "planning/images/voxel_mask.h"

namespace arthronaut::images {

namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

constexpr double kThick_spacings = 2;
// Finer steps between the slices end at the same surface, with more triangles.
constexpr double kStep_mm = 0.8;
// Room about the label: slices of distances need neighbours to go over to, rows a border outside.
constexpr int kRoom_voxels = 2;

// A slice across an axis of the volume, with that axis as its third.
struct SliceAxes {
  int u, v, across;
  explicit SliceAxes(int axis) : u((axis + 1) % 3), v((axis + 2) % 3), across(axis) {}
  [[nodiscard]] Vector3i voxel(int a, int b, int slice) const {
    Vector3i at;
    at[u] = a;
    at[v] = b;
    at[across] = slice;
    return at;
  }
};

float catmull_rom(float p0, float p1, float p2, float p3, float t) {
  return p1 + 0.5F * t * (p2 - p0 + t * (2 * p0 - 5 * p1 + 4 * p2 - p3 + t * (3 * (p1 - p2) + p3 - p0)));
}

}  // namespace

std::optional<int> axis_of_thick_slices(const Volume& volume) {
  const Vector3d spacing = volume.spacing_mm();
  int axis = 0;
  const double widest = spacing.maxCoeff(&axis);
  const double second = std::max(spacing[(axis + 1) % 3], spacing[(axis + 2) % 3]);
  if (widest < kThick_spacings * second) return std::nullopt;
  return axis;
}

LabelDepths depths_between_slices(const Volume& volume, int label, int axis) {
  const SliceAxes axes(axis);
  const Vector3d spacing = volume.spacing_mm();
  const auto wanted = static_cast<float>(label);
  const auto [low, high] = *bounds_of_label(volume, label);
  const Vector3i first = low.array() - kRoom_voxels, size = (high - low).array() + 1 + 2 * kRoom_voxels;
  const Vector3i slice_size(size[axes.u], size[axes.v], 1);
  const Vector3d within_slice(spacing[axes.u], spacing[axes.v], 1);
  // Beyond a slice's thickness a distance says nothing about the next one.
  const auto far = static_cast<float>(spacing[axis]);
  std::vector<std::vector<float>> slices;
  for (int s = 0; s < size[axis]; ++s) {
    VoxelMask inside(slice_size);
    for (int b = 0; b < slice_size.y(); ++b) {
      for (int a = 0; a < slice_size.x(); ++a) {
        const Vector3i at = first + axes.voxel(a, b, s);
        const bool is_in_volume = (at.array() >= 0).all() && (at.array() < volume.size.array()).all();
        inside.inside[inside.index(a, b, 0)] = is_in_volume && volume.at(at.x(), at.y(), at.z()) == wanted;
      }
    }
    std::vector<float> depths = signed_depths_mm(inside, within_slice);
    for (float& depth : depths) depth = std::clamp(depth, -far, far);
    slices.push_back(std::move(depths));
  }
  // Half a slice beyond the volume what reaches its border is cut off.
  const auto cut = [&](int border, int beyond) {
    for (std::size_t i = 0; i < slices[static_cast<std::size_t>(beyond)].size(); ++i)
      slices[static_cast<std::size_t>(beyond)][i] = -std::abs(slices[static_cast<std::size_t>(border)][i]);
  };
  if (low[axis] == 0) cut(kRoom_voxels, kRoom_voxels - 1);
  if (high[axis] == volume.size[axis] - 1) cut(size[axis] - 1 - kRoom_voxels, size[axis] - kRoom_voxels);

  const int steps = std::max(1, static_cast<int>(std::lround(spacing[axis] / kStep_mm)));
  LabelDepths result;
  Field& field = result.field;
  field.first_index = first;
  field.first_index[axis] *= steps;
  field.size = size;
  field.size[axis] = (size[axis] - 1) * steps + 1;
  field.values.resize(static_cast<std::size_t>(field.size.cast<std::int64_t>().prod()));
  result.lps_from_index = volume.lps_from_index;
  result.lps_from_index.linear().col(axis) /= steps;
  const auto slice = [&](int s) -> const std::vector<float>& {
    return slices[static_cast<std::size_t>(std::clamp(s, 0, size[axis] - 1))];
  };
  for (int fine = 0; fine < field.size[axis]; ++fine) {
    const int s = fine / steps;
    const float t = static_cast<float>(fine % steps) / static_cast<float>(steps);
    std::size_t i = 0;
    for (int b = 0; b < slice_size.y(); ++b) {
      for (int a = 0; a < slice_size.x(); ++a, ++i) {
        const Vector3i at = axes.voxel(a, b, fine);
        field.values[field.index(at.x(), at.y(), at.z())] =
            catmull_rom(slice(s - 1)[i], slice(s)[i], slice(s + 1)[i], slice(s + 2)[i], t);
      }
    }
  }
  return result;
}

}  // namespace arthronaut::images
