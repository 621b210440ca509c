#include "navigation/tracker/tracker_poses.h"

#include <algorithm>

namespace arthronaut::tracker {

std::string_view to_text(BodyState state) {
  switch (state) {
    case BodyState::Tracked:
      return "tracked";
    case BodyState::NotConnected:
      return "the tracker is not connected";
    case BodyState::NeverCame:
      return "no pose of it comes from the tracker";
    case BodyState::Stale:
      return "the tracker sends no new pose of it";
    case BodyState::Late:
      return "its poses come late";
    case BodyState::ClockUnknown:
      return "the tracker's clock is being compared";
    case BodyState::OtherMoment:
      return "its pose is of another moment than the bone's";
    case BodyState::OtherFrame:
      return "no pose of the bone in its frame";
    case BodyState::Repeats:
      return "the tracker repeats the same pose";
    case BodyState::NoRotation:
      return "what came is no rigid pose";
    case BodyState::ToldLost:
      return "the tracker says that it does not see it";
    case BodyState::ErrorUnknown:
      return "the tracker's error is not said in tools.json";
    case BodyState::OtherWorld:
      return "poses come in a world that nothing says is this bone's";
  }
  return "unknown";
}

double TrackerPoses::oldest_age_s() const {
  double oldest_s = 0;
  for (const BodyPose& body : bodies)
    if (body.is_tracked()) oldest_s = std::max(oldest_s, body.age_s);
  return oldest_s;
}

void set_all(const tools::ToolSet& tools, BodyState why, TrackerPoses& poses) {
  poses.times_are_arrivals = false;
  poses.bodies.resize(tools.world_markers.size() + tools.tools.size());
  auto body = poses.bodies.begin();
  const auto set = [&](int id) {
    *body = {};
    body->id = id;
    body->state = why;
    ++body;
  };
  for (const tools::WorldMarker& world : tools.world_markers) set(world.marker_id);
  for (const tools::Tool& tool : tools.tools) set(tool.marker_id);
}

geometry::TrackedPose pose_of(const TrackerPoses& poses, int id, std::int64_t timestamp_ns,
                              const tools::OutsideTracker& tracker) {
  geometry::TrackedPose pose;
  pose.timestamp_ns = timestamp_ns;
  if (!tracker.has_known_error()) return pose;
  for (const BodyPose& body : poses.bodies) {
    if (body.id != id || !body.is_tracked()) continue;
    pose.is_valid = true;
    pose.target_from_source = body.tracker_from_body;
    const double sigma_rad = geometry::rad_from_deg(*tracker.sigma_deg);
    pose.covariance.diagonal() << Eigen::Vector3d::Constant(*tracker.sigma_mm * *tracker.sigma_mm),
        Eigen::Vector3d::Constant(sigma_rad * sigma_rad);
  }
  return pose;
}

BodyState state_of(const TrackerPoses& poses, int id) {
  for (const BodyPose& body : poses.bodies)
    if (body.id == id) return body.state;
  return BodyState::NeverCame;
}

}  // namespace arthronaut::tracker
