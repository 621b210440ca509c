#include "navigation/registration/bone/reachable_region.h"

#include <algorithm>
#include <cmath>

namespace arthronaut::registration {

namespace {

constexpr double kFar_mm = 40, kFreeWay_mm = 40, kMaxAngle_deg = 80, kMaxEntryDistance_mm = 10;
constexpr int kDirectionCount = 32;

// Evenly over the cap about the axis (a spiral of equal areas), nearest to it first.
std::vector<Eigen::Vector3f> directions_about(const Eigen::Vector3d& axis) {
  const Eigen::Vector3d across = axis.unitOrthogonal(), beside = axis.cross(across);
  const double golden_rad = geometry::kPi * (3 - std::sqrt(5.0));
  std::vector<Eigen::Vector3f> directions;
  for (int k = 0; k < kDirectionCount; ++k) {
    const double share = (k + 0.5) / kDirectionCount;
    const double cosine = 1 - share * (1 - std::cos(geometry::rad_from_deg(kMaxAngle_deg)));
    const double sine = std::sqrt(1 - cosine * cosine), turn = k * golden_rad;
    directions.push_back(
        (cosine * axis + sine * (std::cos(turn) * across + std::sin(turn) * beside)).cast<float>());
  }
  return directions;
}

// By steps as long as the distance to the bone allows.
bool is_free_way(const CoarseDistanceField& field, const SurfaceSample& sample,
                 const Eigen::Vector3f& direction) {
  constexpr float kLeast_mm = 1.5f;  // the field's nodes are off by up to 0.9 mm
  float way_mm = 2 * kLeast_mm;
  while (way_mm < static_cast<float>(kFreeWay_mm)) {
    const float room_mm = field.nearest_mm(sample.point_mm + kLeast_mm * sample.normal + way_mm * direction);
    if (room_mm < 0.5f * kLeast_mm) return false;
    way_mm += std::max(kLeast_mm, room_mm);
  }
  return true;
}

}  // namespace

std::vector<bool> find_reachable_samples(const SurfaceIndex::Data& bone,
                                         const Eigen::Vector3d& entry_in_bone_mm) {
  const std::vector<SurfaceSample>& samples = bone.pairs.samples();
  const geometry::SurfacePoint entry = bone.surface.closest_point(entry_in_bone_mm);
  if ((entry.point_mm - entry_in_bone_mm).norm() > kMaxEntryDistance_mm) return {};
  std::vector<bool> reachable(samples.size(), false);
  const std::vector<Eigen::Vector3f> directions = directions_about(entry.normal);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const SurfaceSample& sample = samples[i];
    if ((sample.point_mm.cast<double>() - entry.point_mm).norm() > kFar_mm) continue;
    reachable[i] = std::any_of(directions.begin(), directions.end(), [&](const Eigen::Vector3f& direction) {
      return direction.dot(sample.normal) > 0 && is_free_way(bone.coarse_field, sample, direction);
    });
  }
  return reachable;
}

}  // namespace arthronaut::registration
