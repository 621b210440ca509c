#include "tests/planning/segmentation/known_mr.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "planning/images/voxel_mask.h"
#include "planning/phantom/phantom_knee.h"
#include "tests/planning/segmentation/known_ct.h"

namespace arthronaut::test {

namespace {

// By label, as in a fat-suppressed MR: bones dark, cartilage bright, the rest between; neighbours differ.
float grey_of(int label) {
  constexpr float kGrey[] = {520, 800, 830, 810, 780, 250, 230, 240, 260, 400, 420};
  return label >= 0 && label < 11 ? kGrey[label] : 500;
}

// Half of each neighbour's value comes over: voxels at borders are mixed.
void mix(images::Volume& volume) {
  for (int axis = 0; axis < 3; ++axis) {
    std::size_t step = 1;
    for (int a = 0; a < axis; ++a) step *= static_cast<std::size_t>(volume.size[a]);
    const std::vector<float> before = volume.values;
    const auto n = static_cast<std::size_t>(volume.size[axis]);
    for (std::size_t v = 0; v < before.size(); ++v) {
      const std::size_t at = v / step % n;
      const float low = before[at > 0 ? v - step : v], high = before[at + 1 < n ? v + step : v];
      volume.values[v] = 0.5F * before[v] + 0.25F * (low + high);
    }
  }
}

}  // namespace

images::Volume known_labels() {
  const auto knee = phantom::make_phantom_knee();
  const auto low = geometry::bounds_of(knee.tibia.mesh).min_mm,
             high = geometry::bounds_of(knee.femur.mesh).max_mm;
  images::Volume labels;
  labels.lps_from_index.linear() = Eigen::Vector3d(0.6, 0.6, 0.8).asDiagonal();
  labels.lps_from_index.translation() = Eigen::Vector3d(-50, -45, low.z() - 5);
  labels.size = {167, 150, static_cast<int>((high.z() - low.z() + 10) / 0.8)};
  labels.values.assign(static_cast<std::size_t>(labels.size.cast<std::int64_t>().prod()), 0.0F);
  const auto femur = coverage(knee.femur.mesh, labels, 2), tibia = coverage(knee.tibia.mesh, labels, 2);
  for (std::size_t v = 0; v < femur.size(); ++v)
    labels.values[v] = femur[v] > 0.5F ? 5.0F : tibia[v] > 0.5F ? 6.0F : 0.0F;
  return labels;
}

images::Volume known_mr(const images::Volume& labels, double noise, std::uint64_t seed) {
  images::Volume mr = labels;
  mr.modality_in_file = "MR";
  mr.modality = images::Modality::Mr;
  mr.segments.clear();
  for (float& v : mr.values) v = grey_of(static_cast<int>(v));
  mix(mr);
  std::mt19937_64 random(seed);
  std::normal_distribution<float> normal(0.0F, static_cast<float>(noise));
  std::size_t v = 0;
  for (int k = 0; k < mr.size.z(); ++k) {
    for (int j = 0; j < mr.size.y(); ++j) {
      const float field =
          1.2F + 0.2F * std::sin(3.0F * static_cast<float>(j) / static_cast<float>(mr.size.y()) +
                                 2.0F * static_cast<float>(k) / static_cast<float>(mr.size.z()));
      for (int i = 0; i < mr.size.x(); ++i, ++v)
        mr.values[v] = std::round(field * mr.values[v] + normal(random));
    }
  }
  return mr;
}

std::vector<std::uint8_t> strokes(const images::Volume& labels, const std::vector<int>& bones) {
  std::vector<std::uint8_t> painted(labels.values.size(), 0);
  const int slices = labels.size.z();
  const Eigen::Vector3d in_plane(labels.spacing_mm().x(), labels.spacing_mm().y(), 1);
  // Along a row of the slice, where what is painted lies at least so deep within its own kind.
  const auto paint = [&](int slice, std::uint8_t value, double depth_mm, const auto& is_own, int part,
                         int parts) {
    images::VoxelMask own(Eigen::Vector3i(labels.size.x(), labels.size.y(), 1));
    for (int j = 0; j < labels.size.y(); ++j) {
      for (int i = 0; i < labels.size.x(); ++i)
        own.inside[own.index(i, j, 0)] = is_own(static_cast<int>(labels.at(i, j, slice)));
    }
    const auto depths = images::depths_mm(own, in_plane);
    // The row, within its part of the slice, along which most can be painted.
    int best = -1, most = 0;
    for (int j = part * labels.size.y() / parts; j < (part + 1) * labels.size.y() / parts; ++j) {
      int count = 0;
      for (int i = 0; i < labels.size.x(); ++i) count += depths[own.index(i, j, 0)] >= depth_mm;
      if (count > most) {
        most = count;
        best = j;
      }
    }
    if (best < 0) return;
    for (int j = best; j < std::min(best + 2, labels.size.y()); ++j) {
      for (int i = 0; i < labels.size.x(); ++i)
        if (depths[own.index(i, j, 0)] >= depth_mm) painted[labels.index(i, j, slice)] = value;
    }
  };
  for (const int bone : bones) {
    std::vector<int> with_bone;
    for (int k = 0; k < slices; ++k) {
      std::size_t count = 0;
      for (int j = 0; j < labels.size.y(); ++j) {
        for (int i = 0; i < labels.size.x(); ++i) count += labels.at(i, j, k) == static_cast<float>(bone);
      }
      if (count > 200) with_bone.push_back(k);
    }
    for (const double share : {0.2, 0.5, 0.8}) {
      const int slice =
          with_bone[static_cast<std::size_t>(share * static_cast<double>(with_bone.size() - 1))];
      paint(
          slice, static_cast<std::uint8_t>(bone), 2.0, [&](int l) { return l == bone; }, 0, 1);
    }
  }
  const auto is_around = [&](int l) { return std::find(bones.begin(), bones.end(), l) == bones.end(); };
  paint(slices / 2, kBackground, 1.5, is_around, 0, 3);
  paint(slices / 2, kBackground, 0.8, is_around, 1, 3);
  paint(slices / 4, kBackground, 1.5, is_around, 2, 3);
  paint(3 * slices / 4, kBackground, 0.8, is_around, 1, 3);
  return painted;
}

}  // namespace arthronaut::test
