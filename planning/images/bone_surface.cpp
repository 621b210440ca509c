#include "planning/images/bone_surface.h"

#include <algorithm>
#include <cmath>

#include "planning/geometry/error.h"
#include "planning/images/contour.h"
#include "planning/images/thick_slices.h"

namespace arthronaut::images {

namespace {

// Blur of a label's mask, in voxels: without it marching cubes finds nothing but half-way points.
constexpr double kMaskBlur_voxels = 0.6;

void blur(Field& field) {
  const double side = std::exp(-0.5 / (kMaskBlur_voxels * kMaskBlur_voxels));
  const auto center_weight = static_cast<float>(1 / (1 + 2 * side)),
             side_weight = static_cast<float>(side / (1 + 2 * side));
  std::size_t step = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const auto n = static_cast<std::size_t>(field.size[axis]);
    std::vector<float> row(n);
    for (std::size_t start = 0; start < field.values.size(); ++start) {
      if (start / step % n != 0) continue;
      for (std::size_t i = 0; i < n; ++i) row[i] = field.values[start + i * step];
      for (std::size_t i = 0; i < n; ++i) {
        const float before = row[i > 0 ? i - 1 : i], after = row[i + 1 < n ? i + 1 : i];
        field.values[start + i * step] = center_weight * row[i] + side_weight * (before + after);
      }
    }
    step *= n;
  }
}

// Precondition: the volume holds the label.
geometry::TriangleMesh surface_of_even_grid(const Volume& volume, int label) {
  const auto bounds = bounds_of_label(volume, label);
  constexpr int kMargin = 2;
  Field field;
  field.first_index = bounds->low.array() - kMargin;
  field.size = (bounds->high - bounds->low).array() + 1 + 2 * kMargin;
  field.values.assign(static_cast<std::size_t>(field.size.cast<std::int64_t>().prod()), 0.0F);
  for_each_shared_voxel(field, volume.size, [&](std::size_t here, std::size_t there) {
    field.values[here] = volume.values[there] == static_cast<float>(label) ? 1.0F : 0.0F;
  });
  blur(field);
  return contour(field, 0.5F, volume.lps_from_index);
}

}  // namespace

BoneSurface surface_of_label(const Volume& volume, int label) {
  const auto labels = labels_of(volume);
  if (labels.empty())
    throw InvalidInput("the volume is no label map: its values are not a few whole numbers");
  const auto wanted =
      std::find_if(labels.begin(), labels.end(), [&](const auto& l) { return l.first == label; });
  if (wanted == labels.end()) {
    std::string list;
    for (const auto& [value, count] : labels) list += (list.empty() ? "" : ", ") + std::to_string(value);
    throw InvalidInput("the volume holds no label " + std::to_string(label) + ", but " + list);
  }
  BoneSurface surface;
  if (const auto axis = axis_of_thick_slices(volume)) {
    const LabelDepths depths = depths_between_slices(volume, label, *axis);
    surface.mesh = contour(depths.field, 0, depths.lps_from_index);
  } else {
    surface.mesh = surface_of_even_grid(volume, label);
  }
  if (surface.mesh.empty())
    throw InvalidInput("label " + std::to_string(label) + " is too small for a surface");
  surface.notes.push_back("label " + std::to_string(label) + ": " + std::to_string(wanted->second) +
                          " voxels");
  return surface;
}

}  // namespace arthronaut::images
