#include "planning/import/label_choice.h"

#include <algorithm>
#include <cmath>

namespace arthronaut::importing {

std::vector<FoundLabel> found_labels(const images::Volume& volume) {
  constexpr double kMm3PerCm3 = 1000;
  const double voxel_cm3 = std::abs(volume.lps_from_index.linear().determinant()) / kMm3PerCm3;
  std::map<int, FoundLabel> found;
  for (const auto& [label, count] : images::labels_of(volume))
    if (label != 0) found[label] = {.label = label, .volume_cm3 = static_cast<double>(count) * voxel_cm3};
  std::map<int, bool> was_seen;
  std::size_t at = 0;
  for (int k = 0; k < volume.size.z() && !found.empty(); ++k)
    for (int j = 0; j < volume.size.y(); ++j)
      for (int i = 0; i < volume.size.x(); ++i, ++at) {
        const auto label = static_cast<int>(volume.values[at]);
        if (label == 0) continue;
        const Eigen::Vector3d center_mm = volume.lps_from_index * Eigen::Vector3d(i, j, k);
        FoundLabel& of = found.at(label);
        if (!was_seen[label]) of.lowest_mm = of.highest_mm = center_mm;
        was_seen[label] = true;
        of.lowest_mm = of.lowest_mm.cwiseMin(center_mm);
        of.highest_mm = of.highest_mm.cwiseMax(center_mm);
      }
  std::vector<FoundLabel> labels;
  for (const auto& [label, of] : found) labels.push_back(of);
  return labels;
}

std::map<bones::BoneKind, int> likely_labels(const std::vector<FoundLabel>& labels) {
  if (labels.size() < 2) return {};
  std::vector<FoundLabel> largest = labels;
  std::partial_sort(largest.begin(), largest.begin() + 2, largest.end(),
                    [](const FoundLabel& a, const FoundLabel& b) { return a.volume_cm3 > b.volume_cm3; });
  const auto height = [](const FoundLabel& of) { return of.lowest_mm.z() + of.highest_mm.z(); };
  if (height(largest[0]) < height(largest[1])) std::swap(largest[0], largest[1]);
  return {{bones::BoneKind::Femur, largest[0].label}, {bones::BoneKind::Tibia, largest[1].label}};
}

}  // namespace arthronaut::importing
