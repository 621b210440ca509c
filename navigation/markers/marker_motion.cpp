#include "navigation/markers/marker_motion.h"

#include <algorithm>

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

Vector6d MarkerMotion::twist_to(const RigidTransform& pose, std::int64_t timestamp_ns,
                                std::int64_t interval_ns) const {
  if (!last_ || timestamp_ns <= last_->timestamp_ns || timestamp_ns - last_->timestamp_ns > kMotionNs) {
    return Vector6d::Zero();
  }
  const double frames =
      static_cast<double>(timestamp_ns - last_->timestamp_ns) / static_cast<double>(interval_ns);
  return geometry::log(last_->camera_from_marker.inverse() * pose) / std::max(1.0, frames);
}

std::optional<Vector6d> MarkerMotion::change_to(const RigidTransform& pose, std::int64_t timestamp_ns,
                                                std::int64_t interval_ns) const {
  if (!last_ || !before_ || timestamp_ns <= last_->timestamp_ns ||
      timestamp_ns - before_->timestamp_ns > 2 * kMotionNs)
    return std::nullopt;
  const double step = static_cast<double>(timestamp_ns - last_->timestamp_ns);
  const double step_before = static_cast<double>(last_->timestamp_ns - before_->timestamp_ns);
  if (!(step_before > 0)) return std::nullopt;
  const double interval = std::min(static_cast<double>(interval_ns), std::min(step, step_before));
  const Vector6d before = geometry::log(before_->camera_from_marker.inverse() * last_->camera_from_marker);
  const Vector6d now = geometry::log(last_->camera_from_marker.inverse() * pose);
  // Two mean speeds, half of both steps apart.
  return interval * interval / (0.5 * (step + step_before)) * (now / step - before / step_before);
}

void MarkerMotion::follow(const RigidTransform& camera_from_marker, std::int64_t timestamp_ns,
                          const std::optional<SeenMotion>& over_exposure) {
  before_ = last_;
  last_ = Sighting{camera_from_marker, timestamp_ns, over_exposure};
}

}  // namespace arthronaut::markers
