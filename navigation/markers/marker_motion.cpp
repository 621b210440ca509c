#include "navigation/markers/marker_motion.h"

namespace arthronaut::markers {
namespace {

using geometry::RigidTransform;
using geometry::Vector6d;

constexpr std::int64_t kForgetNs = 400'000'000;
// Two sightings farther apart than this say nothing about the motion now.
constexpr std::int64_t kMotionNs = 70'000'000;

}  // namespace

bool MarkerMotion::is_known_at(std::int64_t timestamp_ns) const {
  return last_ && timestamp_ns - last_->timestamp_ns <= kMotionNs;
}

std::optional<RigidTransform> MarkerMotion::predicted(std::int64_t timestamp_ns) const {
  if (!last_ || timestamp_ns - last_->timestamp_ns > kForgetNs || timestamp_ns < last_->timestamp_ns)
    return std::nullopt;
  const std::int64_t step = before_ ? last_->timestamp_ns - before_->timestamp_ns : 0;
  if (step <= 0 || step > kMotionNs || timestamp_ns - last_->timestamp_ns > kMotionNs)
    return last_->camera_from_marker;
  const Vector6d twist = geometry::log(before_->camera_from_marker.inverse() * last_->camera_from_marker);
  const double share = static_cast<double>(timestamp_ns - last_->timestamp_ns) / static_cast<double>(step);
  return last_->camera_from_marker * geometry::exp(share * twist);
}

Vector6d MarkerMotion::twist_to(const RigidTransform& pose, std::int64_t timestamp_ns) const {
  if (!last_ || timestamp_ns <= last_->timestamp_ns || timestamp_ns - last_->timestamp_ns > kMotionNs) {
    return Vector6d::Zero();
  }
  return geometry::log(last_->camera_from_marker.inverse() * pose);
}

std::optional<Vector6d> MarkerMotion::change_to(const RigidTransform& pose, std::int64_t timestamp_ns) const {
  if (!last_ || !before_ || timestamp_ns <= last_->timestamp_ns ||
      timestamp_ns - before_->timestamp_ns > 2 * kMotionNs)
    return std::nullopt;
  const double step = static_cast<double>(timestamp_ns - last_->timestamp_ns);
  const double step_before = static_cast<double>(last_->timestamp_ns - before_->timestamp_ns);
  if (!(step_before > 0)) return std::nullopt;
  const Vector6d before = geometry::log(before_->camera_from_marker.inverse() * last_->camera_from_marker);
  return twist_to(pose, timestamp_ns) - step / step_before * before;
}

void MarkerMotion::follow(const RigidTransform& camera_from_marker, std::int64_t timestamp_ns) {
  before_ = last_;
  last_ = Sighting{camera_from_marker, timestamp_ns};
}

}  // namespace arthronaut::markers
