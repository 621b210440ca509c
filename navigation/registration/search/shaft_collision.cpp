#include "navigation/registration/search/shaft_collision.h"

#include <algorithm>
#include <array>

namespace arthronaut::registration {

ShaftCollision::ShaftCollision(const SurfaceIndex::Data& bone, const WeightedPoints& points)
    : field_(bone.coarse_field) {
  constexpr std::size_t kMaxCount = 24;
  const std::size_t count = std::min(points.shaft_directions.size(), kMaxCount);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t chosen = i * points.shaft_directions.size() / count;
    if (!points.shaft_directions[chosen]) continue;
    shafts_.push_back(
        {points.positions_mm[chosen].cast<float>(), points.shaft_directions[chosen]->cast<float>()});
  }
}

bool ShaftCollision::leads_through_bone(const Shaft& shaft, const Eigen::Matrix3f& rotation,
                                        const Eigen::Vector3f& translation_mm) const {
  constexpr std::array<float, 7> kAlong_mm{4, 7, 11, 16, 22, 28, 35};
  constexpr float kForgiven_mm = 1.5f;
  const Eigen::Vector3f tip = rotation * shaft.tip_mm + translation_mm,
                        direction = rotation * shaft.direction;
  return std::any_of(kAlong_mm.begin(), kAlong_mm.end(), [&](float along_mm) {
    return field_.nearest_mm(tip + along_mm * direction) < -kForgiven_mm;
  });
}

double ShaftCollision::share_through_bone(const Eigen::Matrix3f& rotation,
                                          const Eigen::Vector3f& translation_mm) const {
  if (shafts_.empty()) return 0;
  const auto count = std::count_if(shafts_.begin(), shafts_.end(), [&](const Shaft& shaft) {
    return leads_through_bone(shaft, rotation, translation_mm);
  });
  return static_cast<double>(count) / static_cast<double>(shafts_.size());
}

bool ShaftCollision::is_possible(const Eigen::Matrix3f& rotation,
                                 const Eigen::Vector3f& translation_mm) const {
  constexpr double kMaxShare = 0.5;
  return share_through_bone(rotation, translation_mm) <= kMaxShare;
}

}  // namespace arthronaut::registration
