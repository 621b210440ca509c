#include "navigation/operation/tunnel_meter.h"

#include <algorithm>

namespace arthronaut::operation {

namespace {

constexpr double kLeastDepth_mm = -1.5, kWindow_mm = 1;
constexpr std::size_t kLeastPoses = 15;

template <typename Value>
double median_of(const std::vector<guidance::GuidanceNumbers>& poses, const Value& value) {
  std::vector<double> values;
  values.reserve(poses.size());
  for (const guidance::GuidanceNumbers& pose : poses) values.push_back(value(pose));
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

template <typename Vector>
Eigen::Vector3d median_vector(const std::vector<guidance::GuidanceNumbers>& poses, const Vector& vector) {
  Eigen::Vector3d result;
  for (int axis = 0; axis < 3; ++axis)
    result[axis] =
        median_of(poses, [&](const guidance::GuidanceNumbers& pose) { return vector(pose)[axis]; });
  return result;
}

Eigen::Vector3d crossing_of(const guidance::GuidanceNumbers& pose, const tunnels::Tunnel& planned) {
  const double advance = pose.guide_direction.dot(planned.direction);
  return pose.guide_point_mm +
         (planned.entry_mm - pose.guide_point_mm).dot(planned.direction) / advance * pose.guide_direction;
}

}  // namespace

void TunnelMeter::add(const guidance::GuidanceNumbers& guidance) {
  if (!guidance.is_valid() || guidance.depth_mm < kLeastDepth_mm) return;
  double deepest = guidance.depth_mm;
  for (const guidance::GuidanceNumbers& pose : deepest_) deepest = std::max(deepest, pose.depth_mm);
  if (guidance.depth_mm < deepest - kWindow_mm) return;
  std::erase_if(deepest_,
                [&](const guidance::GuidanceNumbers& pose) { return pose.depth_mm < deepest - kWindow_mm; });
  deepest_.push_back(guidance);
}

bool TunnelMeter::has_evidence() const { return deepest_.size() >= kLeastPoses; }

std::optional<AchievedTunnel> TunnelMeter::measured(const tunnels::Tunnel& planned) const {
  if (!has_evidence()) return std::nullopt;
  AchievedTunnel achieved;
  achieved.planned = planned;
  achieved.measured = planned;  // bone and diameter: the drill is the planned one
  achieved.measured.direction = median_vector(deepest_, [](const guidance::GuidanceNumbers& pose) {
                                  return pose.guide_direction;
                                }).normalized();
  achieved.measured.entry_mm = median_vector(
      deepest_, [&](const guidance::GuidanceNumbers& pose) { return crossing_of(pose, planned); });
  achieved.depth_mm =
      median_of(deepest_, [](const guidance::GuidanceNumbers& pose) { return pose.depth_mm; });
  achieved.timestamp_ns = deepest_.back().timestamp_ns;
  achieved.pose_count = static_cast<int>(deepest_.size());
  achieved.sigma_offset_mm =
      median_of(deepest_, [](const guidance::GuidanceNumbers& pose) { return pose.sigma_offset_mm; });
  achieved.sigma_angle_deg =
      median_of(deepest_, [](const guidance::GuidanceNumbers& pose) { return pose.sigma_angle_deg; });
  return achieved;
}

}  // namespace arthronaut::operation
