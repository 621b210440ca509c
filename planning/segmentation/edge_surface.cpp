#include "planning/segmentation/edge_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "planning/images/contour.h"
#include "planning/segmentation/box_blur.h"
#include "planning/segmentation/cortex_profile.h"

namespace arthronaut::segmentation {

namespace {

using images::Field;
using images::Volume;
using images::VoxelMask;

// A profile that falls by this much is past its peak, one that rises by it past the dark beside the bone:
// more than the noise of a CT.
constexpr float kTurn_hu = 75;
// What is within the solid by its threshold and outside by the local one is a rim that the scanner's blur
// makes: never thicker.
constexpr double kThickestRim_mm = 1.2;
// Values inside, where the grey says nothing: marrow, closed gaps.
constexpr float kSurelyInside = 300;
// Thick slices leave steps, which are smoothed away. Of fine voxels the edge is between them already, and any
// smoothing of the mesh moves it by more (0.03 to 0.08 mm on known bones) than the noise is.
constexpr double kThickSlice_mm = 1.2;
constexpr images::Smoothing kOfThickSlices{20, 0.08}, kNoSmoothing{0, 1};
// Normals and half-way values are taken over so much of the surface.
constexpr double kNormalRadius_mm = 0.8, kLevelRadius_mm = 1.0;

// What the steps below share: the field is the box with one voxel more on each side.
struct Work {
  const Volume& volume;
  const Box& box;
  const EdgeOptions& options;
  Eigen::Vector3d spacing_mm;
  Field grey;                        // of the volume; below any bone where there is none
  std::vector<std::uint8_t> solid;   // of the field
  std::vector<std::uint8_t> is_cut;  // of the field: no voxel of the volume
};

bool is_of_thick_slices(const Volume& volume) { return volume.spacing_mm().maxCoeff() > kThickSlice_mm; }

template <typename Visit>
void for_each_inner_voxel(const Field& field, const Visit& visit) {
  for (int k = 1; k + 1 < field.size.z(); ++k) {
    for (int j = 1; j + 1 < field.size.y(); ++j) {
      std::size_t at = field.index(1, j, k);
      for (int i = 1; i + 1 < field.size.x(); ++i) visit(Eigen::Vector3i(i, j, k), at++);
    }
  }
}

std::array<std::size_t, 3> steps_of(const Field& field) {
  const auto nx = static_cast<std::size_t>(field.size.x());
  return {1, nx, nx * static_cast<std::size_t>(field.size.y())};
}

Work prepared(const Volume& volume, const Box& box, const VoxelMask& solid, const VoxelMask& others,
              const EdgeOptions& options) {
  Work work{volume, box, options, volume.spacing_mm(), {}, {}, {}};
  const auto below = static_cast<float>(options.threshold) - kSurelyInside;
  work.grey.first_index = box.first.array() - 1;
  work.grey.size = box.size.array() + 2;
  const auto count = static_cast<std::size_t>(work.grey.size.cast<std::int64_t>().prod());
  work.grey.values.assign(count, below);
  work.solid.assign(count, 0);
  work.is_cut.assign(count, 1);
  images::for_each_shared_voxel(work.grey, volume.size, [&](std::size_t here, std::size_t there) {
    work.grey.values[here] = volume.values[there];
    work.is_cut[here] = 0;
  });
  Field of_box;
  of_box.first_index = box.first;
  of_box.size = box.size;
  std::size_t v = 0;
  for (int k = 0; k < box.size.z(); ++k) {
    for (int j = 0; j < box.size.y(); ++j) {
      std::size_t here = work.grey.index(1, j + 1, k + 1);
      for (int i = 0; i < box.size.x(); ++i, ++here, ++v) {
        work.solid[here] = solid.inside[v];
        // Another bone right beside this one is neither edge nor outside.
        if (others.inside[v] && !solid.inside[v])
          work.grey.values[here] =
              std::min(work.grey.values[here], static_cast<float>(options.threshold) - 1);
      }
    }
  }
  return work;
}

class Sampler {
 public:
  explicit Sampler(const Field& field) : field_(field), steps_(steps_of(field)) {}
  // Trilinear; nullopt outside.
  [[nodiscard]] std::optional<float> at(const Eigen::Vector3d& p) const {
    const Eigen::Vector3i low = p.array().floor().cast<int>();
    if ((low.array() < 0).any() || (low.array() + 1 >= field_.size.array()).any()) return std::nullopt;
    const Eigen::Vector3f f = (p - low.cast<double>()).cast<float>();
    const float* v = field_.values.data() + field_.index(low.x(), low.y(), low.z());
    const auto line = [&](std::size_t o) { return v[o] + f.x() * (v[o + 1] - v[o]); };
    const auto plane = [&](std::size_t o) {
      const float a = line(o);
      return a + f.y() * (line(o + steps_[1]) - a);
    };
    const float a = plane(0);
    return a + f.z() * (plane(steps_[2]) - a);
  }

 private:
  const Field& field_;
  std::array<std::size_t, 3> steps_;
};

// The dark outside and the peak of the cortex along a line from inside out; nullopt without an edge.
std::optional<CortexProfile> profile_along(const Sampler& grey, const Eigen::Vector3d& start,
                                           const Eigen::Vector3d& outward_step, int reach, float least_step) {
  // From outside in.
  CortexProfile found;
  std::vector<float>& values = found.values;
  values.reserve(static_cast<std::size_t>(2 * reach + 1));
  for (int s = reach; s >= -reach; --s) {
    const auto value = grey.at(start + s * outward_step);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  const auto middle = static_cast<std::size_t>(reach);
  const auto mean_at = [&](std::size_t s) {
    const std::size_t low = s > 0 ? s - 1 : 0, high = std::min(values.size() - 1, s + 1);
    float sum = 0;
    for (std::size_t i = low; i <= high; ++i) sum += values[i];
    return sum / static_cast<float>(high - low + 1);
  };
  std::size_t top = middle, bottom = middle;
  for (std::size_t s = middle; s < values.size(); ++s) {
    if (values[s] > values[top]) top = s;
    if (values[s] < values[top] - kTurn_hu) break;
  }
  for (std::size_t s = middle + 1; s-- > 0;) {
    if (values[s] < values[bottom]) bottom = s;
    if (values[s] > values[bottom] + kTurn_hu) break;
  }
  found.high = mean_at(top);
  found.low = mean_at(bottom);
  if (found.high - found.low < least_step) return std::nullopt;
  const float half = 0.5F * (found.high + found.low);
  std::size_t edge = top;
  while (edge > bottom && values[edge] >= half) --edge;
  if (values[edge] >= half || values[edge + 1] < half) return std::nullopt;
  const float beyond = (half - values[edge]) / std::max(values[edge + 1] - values[edge], 1e-3F);
  found.edge_mm =
      static_cast<float>((static_cast<double>(edge) + static_cast<double>(beyond)) * kProfileStep_mm);
  return found;
}

// The value at the edge near the surface, the threshold elsewhere.
std::vector<float> local_levels(const Work& work) {
  const Field& grey = work.grey;
  const auto steps = steps_of(grey);
  Field soft = grey;
  for (std::size_t v = 0; v < soft.values.size(); ++v) soft.values[v] = work.solid[v];
  blur_with_box(soft, work.spacing_mm, kNormalRadius_mm);
  Field sum = grey, weight = grey;
  std::fill(sum.values.begin(), sum.values.end(), 0.0F);
  std::fill(weight.values.begin(), weight.values.end(), 0.0F);
  const Sampler sampler(grey);
  const Eigen::Matrix3d index_from_mm = work.volume.lps_from_index.linear().inverse();
  const int reach = static_cast<int>(std::lround(work.options.reach_mm / kProfileStep_mm));
  std::vector<CortexProfile> profiles;
  for_each_inner_voxel(grey, [&](const Eigen::Vector3i& at, std::size_t v) {
    if (!work.solid[v]) return;
    bool is_at_surface = false;
    Eigen::Vector3d gradient;
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t step = steps[static_cast<std::size_t>(axis)];
      is_at_surface = is_at_surface || (!work.solid[v + step] && !work.is_cut[v + step]) ||
                      (!work.solid[v - step] && !work.is_cut[v - step]);
      gradient[axis] = soft.values[v + step] - soft.values[v - step];
    }
    if (!is_at_surface) return;
    // Along the patient's direction in which the solid ends.
    const Eigen::Vector3d outward = -(index_from_mm.transpose() * gradient);
    const double length = outward.norm();
    if (!(length > 1e-6)) return;
    const Eigen::Vector3d step = index_from_mm * (outward * (kProfileStep_mm / length));
    auto profile =
        profile_along(sampler, at.cast<double>(), step, reach, static_cast<float>(work.options.least_step));
    if (!profile) return;
    sum.values[v] = profile->low;
    weight.values[v] = profile->high - profile->low;
    profiles.push_back(std::move(*profile));
  });
  // Of thick slices the blur is another one in every direction.
  const EdgeShare share = is_of_thick_slices(work.volume) ? EdgeShare() : EdgeShare::of(std::move(profiles));
  for (std::size_t v = 0; v < sum.values.size(); ++v) {
    const float rise = weight.values[v];
    if (!(rise > 0)) continue;
    sum.values[v] += share.at(rise) * rise;
    weight.values[v] = 1;
  }
  for (int pass = 0; pass < 2; ++pass) {
    blur_with_box(sum, work.spacing_mm, kLevelRadius_mm);
    blur_with_box(weight, work.spacing_mm, kLevelRadius_mm);
  }
  for (std::size_t v = 0; v < sum.values.size(); ++v) {
    sum.values[v] = weight.values[v] > 1e-5F ? sum.values[v] / weight.values[v]
                                             : static_cast<float>(work.options.threshold);
  }
  return std::move(sum.values);
}

// Where the outermost layer is about as bright as the threshold, noise puts some of its voxels above it, and
// closing fills in the others. They are no gap of the cortex: before them it is dark, and right behind them
// bright.
void take_back_what_noise_closed(Work& work, const std::vector<float>& levels) {
  const auto steps = steps_of(work.grey);
  const auto threshold = static_cast<float>(work.options.threshold);
  std::vector<std::size_t> outside;
  for_each_inner_voxel(work.grey, [&](const Eigen::Vector3i&, std::size_t v) {
    if (!work.solid[v] || work.grey.values[v] >= std::min(threshold, levels[v])) return;
    const auto lies_before = [&](std::size_t outer, std::size_t inner) {
      return !work.solid[outer] && !work.is_cut[outer] && work.grey.values[outer] < threshold - kTurn_hu &&
             work.solid[inner] && work.grey.values[inner] >= threshold;
    };
    if (std::ranges::any_of(steps, [&](std::size_t step) {
          return lies_before(v - step, v + step) || lies_before(v + step, v - step);
        }))
      outside.push_back(v);
  });
  for (const std::size_t v : outside) work.solid[v] = 0;
}

// Takes the rim away that lies between the threshold's surface and the edge: what is below the local level
// and can be reached from outside. A closed gap of the cortex, which is below the threshold itself, stays.
void take_rim_away(Work& work, const std::vector<float>& levels) {
  const auto steps = steps_of(work.grey);
  std::vector<float> depth_mm(work.solid.size(), std::numeric_limits<float>::infinity());
  std::vector<std::size_t> front;
  for_each_inner_voxel(work.grey, [&](const Eigen::Vector3i&, std::size_t v) {
    if (work.solid[v]) return;
    depth_mm[v] = 0;
    front.push_back(v);
  });
  const auto threshold = static_cast<float>(work.options.threshold);
  for (std::size_t at = 0; at < front.size(); ++at) {
    const std::size_t v = front[at];
    for (int axis = 0; axis < 3; ++axis) {
      const float depth = depth_mm[v] + static_cast<float>(work.spacing_mm[axis]);
      if (depth > kThickestRim_mm + work.spacing_mm[axis] * 0.5) continue;
      for (const std::size_t next :
           {v + steps[static_cast<std::size_t>(axis)], v - steps[static_cast<std::size_t>(axis)]}) {
        const float grey = work.grey.values[next];
        if (!work.solid[next] || grey >= levels[next] || grey < threshold || depth_mm[next] <= depth)
          continue;
        depth_mm[next] = depth;
        front.push_back(next);
      }
    }
  }
  for (std::size_t v = 0; v < work.solid.size(); ++v) {
    if (depth_mm[v] < std::numeric_limits<float>::infinity()) work.solid[v] = 0;
  }
}

}  // namespace

geometry::TriangleMesh edge_surface(const Volume& volume, const Box& box, const VoxelMask& solid,
                                    const VoxelMask& others, const EdgeOptions& options) {
  Work work = prepared(volume, box, solid, others, options);
  const std::vector<float> levels = local_levels(work);
  // A voxel of thick slices is more than what noise adds.
  if (!is_of_thick_slices(volume)) take_back_what_noise_closed(work, levels);
  take_rim_away(work, levels);
  Field field = std::move(work.grey);
  for (std::size_t v = 0; v < field.values.size(); ++v) {
    const float above = field.values[v] - levels[v];
    if (work.is_cut[v]) {
      field.values[v] = -kSurelyInside;
    } else if (work.solid[v]) {
      field.values[v] = above > 0 ? above : kSurelyInside;
    } else {
      field.values[v] = above < 0 ? above : -0.5F * kSurelyInside;
    }
  }
  return images::contour(field, 0, volume.lps_from_index,
                         is_of_thick_slices(volume) ? kOfThickSlices : kNoSmoothing);
}

}  // namespace arthronaut::segmentation
