#include "planning/images/bone_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "planning/geometry/error.h"
#include "planning/images/contour.h"
#include "planning/images/voxel_mask.h"

namespace arthronaut::images {

namespace {

// Blur of a label's mask, in voxels: without it marching cubes finds nothing but half-way points.
constexpr double kMaskBlur_voxels = 0.6;
// What stands for "surely bone" and "surely not" beside the threshold: about the step from soft tissue to
// cortex.
constexpr float kSureStep = 300;

template <typename IsInside>
Field field_around(const Volume& volume, int margin, const IsInside& is_inside) {
  Eigen::Vector3i low = volume.size, high = Eigen::Vector3i::Constant(-1);
  for (int k = 0; k < volume.size.z(); ++k) {
    for (int j = 0; j < volume.size.y(); ++j) {
      for (int i = 0; i < volume.size.x(); ++i) {
        if (!is_inside(volume.index(i, j, k))) continue;
        low = low.cwiseMin(Eigen::Vector3i(i, j, k));
        high = high.cwiseMax(Eigen::Vector3i(i, j, k));
      }
    }
  }
  Field field;
  field.first_index = low.array() - margin;
  field.size = (high - low).array() + 1 + 2 * margin;
  field.values.assign(static_cast<std::size_t>(field.size.cast<std::int64_t>().prod()), 0.0F);
  return field;
}

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

int axis_nearest_to_superior(const Volume& volume) {
  Eigen::Index axis = 0;
  volume.lps_from_index.linear().colwise().normalized().row(2).cwiseAbs().maxCoeff(&axis);
  return static_cast<int>(axis);
}

// Fragments, and the small bones where a large one is asked for, are not in question.
constexpr double kLeastPieceFraction = 0.15;
constexpr double kDeepestParting_mm = 8;

bool is_large(const VoxelPiece& piece, const VoxelPiece& largest) {
  return static_cast<double>(piece.count) >= kLeastPieceFraction * static_cast<double>(largest.count);
}

const VoxelPiece& chosen_piece(const std::vector<VoxelPiece>& pieces, const Volume& volume, Piece wanted) {
  const auto height = [&](const VoxelPiece& piece) {
    return (volume.lps_from_index * piece.center_index).z();
  };
  const VoxelPiece* best = &pieces.front();
  for (const VoxelPiece& piece : pieces) {
    if (!is_large(piece, pieces.front())) continue;
    if (wanted == Piece::Superior && height(piece) > height(*best)) best = &piece;
    if (wanted == Piece::Inferior && height(piece) < height(*best)) best = &piece;
  }
  return *best;
}

VoxelMask filled(const VoxelPiece& piece, const Volume& volume, double closing_radius_mm) {
  VoxelMask mask(volume.size);
  for (const std::size_t v : piece.voxels) mask.inside[v] = 1;
  if (closing_radius_mm > 0) close_gaps(mask, volume.spacing_mm(), closing_radius_mm);
  fill_enclosed(mask, axis_nearest_to_superior(volume));
  return mask;
}

std::pair<double, double> height_range_mm(const VoxelPiece& piece, const Volume& volume) {
  const auto nx = static_cast<std::size_t>(volume.size.x()), ny = static_cast<std::size_t>(volume.size.y());
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const std::size_t v : piece.voxels) {
    const Eigen::Vector3d index(static_cast<double>(v % nx), static_cast<double>(v / nx % ny),
                                static_cast<double>(v / (nx * ny)));
    const double z = (volume.lps_from_index * index).z();
    low = std::min(low, z);
    high = std::max(high, z);
  }
  return {low, high};
}

// Femur and tibia stand one above the other: a cut that leaves two pieces side by side went through a bone.
constexpr double kMostOverlap_fraction = 0.25;

bool stand_above_each_other(const VoxelPiece& a, const VoxelPiece& b, const Volume& volume) {
  const auto [a_low, a_high] = height_range_mm(a, volume);
  const auto [b_low, b_high] = height_range_mm(b, volume);
  const double overlap = std::min(a_high, b_high) - std::max(a_low, b_low);
  return overlap <= kMostOverlap_fraction * std::min(a_high - a_low, b_high - b_low);
}

// Bones that touch are joined by necks thinner than themselves: worn down until two large pieces are left,
// each of which then takes the voxels that are nearer to it. Returns false, and leaves the mask, when it does
// not fall apart.
bool part_from_others(VoxelMask& bone, const Volume& volume, Piece wanted) {
  const Eigen::Vector3d spacing = volume.spacing_mm();
  for (double radius = 1; radius <= kDeepestParting_mm; radius += 1) {
    VoxelMask worn = bone;
    erode(worn, spacing, radius);
    const auto pieces = connected_pieces(worn, 50);
    if (pieces.size() < 2 || !is_large(pieces[1], pieces[0])) continue;
    if (!stand_above_each_other(pieces[0], pieces[1], volume)) continue;
    const VoxelPiece& kept = chosen_piece(pieces, volume, wanted);
    std::vector<std::size_t> others;
    for (const VoxelPiece& piece : pieces) {
      if (&piece != &kept) others.insert(others.end(), piece.voxels.begin(), piece.voxels.end());
    }
    const auto to_kept = distances_mm(volume.size, kept.voxels, spacing);
    const auto to_others = distances_mm(volume.size, others, spacing);
    for (std::size_t i = 0; i < bone.inside.size(); ++i) bone.inside[i] &= to_kept[i] < to_others[i];
    // Crumbs that were cut off by the parting.
    const auto left = connected_pieces(bone, 1);
    std::fill(bone.inside.begin(), bone.inside.end(), std::uint8_t{0});
    for (const std::size_t v : left.front().voxels) bone.inside[v] = 1;
    return true;
  }
  return false;
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
  const auto is_label = [&](std::size_t voxel) { return volume.values[voxel] == static_cast<float>(label); };
  Field field = field_around(volume, 2, is_label);
  for_each_shared_voxel(field, volume.size, [&](std::size_t here, std::size_t there) {
    field.values[here] = is_label(there) ? 1.0F : 0.0F;
  });
  blur(field);
  BoneSurface surface;
  surface.mesh = contour(field, 0.5F, volume.lps_from_index);
  if (surface.mesh.empty())
    throw InvalidInput("label " + std::to_string(label) + " is too small for a surface");
  surface.notes.push_back("label " + std::to_string(label) + ": " + std::to_string(wanted->second) +
                          " voxels");
  return surface;
}

BoneSurface surface_above_threshold(const Volume& volume, const ThresholdOptions& options) {
  const auto threshold = static_cast<float>(options.threshold);
  VoxelMask above(volume.size);
  for (std::size_t i = 0; i < volume.values.size(); ++i) above.inside[i] = volume.values[i] >= threshold;
  const auto pieces = connected_pieces(above, 50);
  if (pieces.empty()) {
    const auto [low, high] = std::minmax_element(volume.values.begin(), volume.values.end());
    throw InvalidInput("nothing of the volume is above the threshold of " +
                       std::to_string(std::lround(threshold)) + ": its values run from " +
                       std::to_string(std::lround(*low)) + " to " + std::to_string(std::lround(*high)));
  }
  const VoxelPiece& piece = chosen_piece(pieces, volume, options.piece);
  VoxelMask bone = filled(piece, volume, options.closing_radius_mm);
  BoneSurface surface;
  surface.notes.push_back("threshold " + std::to_string(std::lround(threshold)) + ": " +
                          std::to_string(pieces.size()) + (pieces.size() == 1 ? " piece" : " pieces"));
  const bool stands_alone = pieces.size() > 1 && is_large(pieces[1], pieces[0]);
  if (options.piece != Piece::Largest && !stands_alone) {
    // Closing gaps widens the neck as well: it is looked for without first.
    VoxelMask unclosed = filled(piece, volume, 0);
    bool is_parted = part_from_others(unclosed, volume, options.piece);
    if (is_parted) {
      bone = unclosed;
      close_gaps(bone, volume.spacing_mm(), options.closing_radius_mm);
      fill_enclosed(bone, axis_nearest_to_superior(volume));
    } else {
      is_parted = part_from_others(bone, volume, options.piece);
    }
    if (is_parted) {
      surface.notes.push_back("bones that touched were parted where they were thinnest");
    } else {
      surface.doubts.push_back(
          "there is one large piece only: if it shows femur and tibia, they touch, and this is both");
    }
  }
  const auto voxel_ml = std::abs(volume.lps_from_index.linear().determinant()) / 1000;
  surface.notes.push_back(std::to_string(std::lround(voxel_ml * static_cast<double>(bone.count()))) +
                          " ml, marrow filled in");

  Field field = field_around(volume, 1, [&](std::size_t v) { return bone.inside[v] != 0; });
  std::fill(field.values.begin(), field.values.end(), threshold - kSureStep);
  // Beside the bone the grey values say where within a voxel its surface runs; other bones and the marrow
  // must not.
  for_each_shared_voxel(field, volume.size, [&](std::size_t here, std::size_t there) {
    const float grey = volume.values[there];
    if (bone.inside[there]) {
      field.values[here] = grey >= threshold ? std::min(grey, threshold + kSureStep) : threshold + kSureStep;
    } else {
      // Bone of another piece right beside it: half-way.
      field.values[here] =
          grey >= threshold ? threshold - 0.5F * kSureStep : std::max(grey, threshold - kSureStep);
    }
  });
  surface.mesh = contour(field, threshold, volume.lps_from_index);
  if (surface.mesh.empty()) throw InvalidInput("what is above the threshold is too small for a surface");
  return surface;
}

}  // namespace arthronaut::images
