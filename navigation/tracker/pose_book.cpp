#include "navigation/tracker/pose_book.h"

#include <algorithm>
#include <cmath>

namespace arthronaut::tracker {

namespace {

// Bodies that a tracker measures together bear one stamp, or stamps of one exposure. A tool that is led by
// hand goes 0.3 mm in that time.
constexpr double kSameMoment_s = 0.005;
// As old as any pose may be: what is the same to the last bit for so long was measured before that. Six
// samples at 60 a second, so that one that a server sends twice or thrice is none that was lost.
constexpr double kRepeatsAfter_s = PoseBook::kMaxAge_s;

double seconds_of(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

bool is_same(const geometry::RigidTransform& a, const geometry::RigidTransform& b) {
  return a.rotation.coeffs() == b.rotation.coeffs() && a.translation_mm == b.translation_mm;
}

std::string device_of(const tools::OutsideTracker& tracker, const std::string& body) {
  const auto found = tracker.devices.find(body);
  return found != tracker.devices.end() ? found->second : "";
}

}  // namespace

PoseBook::PoseBook(const TrackedBodies& with) {
  const tools::OutsideTracker tracker = with.tools.tracker.value_or(tools::OutsideTracker());
  may_repeat_ = tracker.may_repeat;
  has_known_error_ = tracker.has_known_error();
  for (const tools::WorldMarker& world : with.tools.world_markers) {
    Body body;
    body.id = world.marker_id;
    body.is_bone = true;
    const std::string said = device_of(tracker, std::string(bones::to_text(world.bone)));
    const bool is_femur = world.bone == bones::BoneKind::Femur;
    body.names = {{!said.empty() ? said : is_femur ? "WorldFemur" : "WorldTibia"}};
    if (world.bone == with.bone) world_ = bodies_.size();
    bodies_.push_back(std::move(body));
  }
  is_in_world_alone_ = world_ && bodies_.size() == 1;
  for (const tools::Tool& tool : with.tools.tools) {
    Body body;
    body.id = tool.marker_id;
    body.tip_mm = tool.tip_mm;
    const std::string usual = tool.name == with.probe_name          ? "Probe"
                              : tool.name == with.guide_name        ? "Guide"
                              : tool.kind == tools::ToolKind::Drill ? "Drill"
                                                                    : tool.name;
    if (const std::string said = device_of(tracker, tool.name); !said.empty()) {
      const bool is_in_world = said.ends_with("_World");
      body.names = {{said, is_in_world, said.ends_with("Tip_World")}};
    } else {
      body.names = {{usual}, {usual + "_World", true}, {usual + "Tip_World", true, true}};
    }
    bodies_.push_back(std::move(body));
  }
}

void PoseBook::begin(double longest_transit_s) {
  forget_poses();
  for (Body& body : bodies_) body.is_told_lost = body.is_broken = false;
  clock_ = ClockMatch(longest_transit_s);
  is_connected_ = has_stamps_ = true;
  is_late_ = false;
}

void PoseBook::end() {
  is_connected_ = false;
  forget_poses();
}

void PoseBook::forget_poses() {
  for (Body& body : bodies_) {
    body.count = 0;
    body.in_use.reset();
  }
}

bool PoseBook::take(const ReceivedPose& received) {
  for (Body& body : bodies_) {
    for (std::size_t n = 0; n < body.names.size(); ++n) {
      const Name& name = body.names[n];
      if (name.device != received.device) continue;
      if (body.is_bone) is_in_world_alone_ = false;
      if (!body.in_use) body.in_use = n;
      if (*body.in_use != n) return true;
      body.is_broken = !received.target_from_source || (name.is_at_tip && !body.tip_mm);
      if (!body.is_broken) keep(body, name, received);
      return true;
    }
  }
  return false;
}

void PoseBook::keep(Body& body, const Name& name, const ReceivedPose& received) {
  body.is_told_lost = false;
  // One message without a stamp: from then on the rest is not compared with a clock either.
  if (!(received.stamp_utc_s > 0)) has_stamps_ = false;
  if (has_stamps_) {
    clock_.add(received.stamp_utc_s, received.arrival_ns);
    is_late_ = clock_.age_s(received.stamp_utc_s, received.arrival_ns) > kMaxAge_s;
  }
  Sample sample;
  sample.pose = *received.target_from_source;
  if (name.is_at_tip) sample.pose.translation_mm -= sample.pose.rotate(*body.tip_mm);
  sample.stamp_utc_s = received.stamp_utc_s;
  sample.arrival_ns = sample.same_since_ns = received.arrival_ns;
  sample.is_in_world = name.is_in_world;
  if (body.count > 0 && is_same(body.kept.front().pose, sample.pose))
    sample.same_since_ns = body.kept.front().same_since_ns;
  std::move_backward(body.kept.begin(), body.kept.end() - 1, body.kept.end());
  body.kept.front() = sample;
  body.count = std::min(body.count + 1, body.kept.size());
}

void PoseBook::take_lost(std::string_view device) {
  for (Body& body : bodies_) {
    for (const Name& name : body.names) {
      if (name.device != device) continue;
      body.is_told_lost = true;
      if (body.is_bone) is_in_world_alone_ = false;
    }
  }
}

double PoseBook::age_s(const Sample& sample, std::int64_t now_ns) const {
  const double since_arrival_s = seconds_of(now_ns - sample.arrival_ns);
  return has_stamps_ ? std::max(since_arrival_s, clock_.age_s(sample.stamp_utc_s, now_ns)) : since_arrival_s;
}

double PoseBook::moment_of(const Sample& sample) const {
  return has_stamps_ ? sample.stamp_utc_s : seconds_of(sample.arrival_ns);
}

BodyState PoseBook::standing_of(const Body& body, std::int64_t now_ns) const {
  if (!is_connected_) return BodyState::NotConnected;
  if (body.is_broken) return BodyState::NoRotation;
  if (body.is_told_lost) return BodyState::ToldLost;
  if (body.count == 0) return BodyState::NeverCame;
  const Sample& newest = body.kept.front();
  if (seconds_of(now_ns - newest.arrival_ns) > kMaxAge_s) return BodyState::Stale;
  if (has_stamps_ && !clock_.is_known()) return BodyState::ClockUnknown;
  if (age_s(newest, now_ns) > kMaxAge_s) return BodyState::Late;
  if (!may_repeat_ && seconds_of(newest.arrival_ns - newest.same_since_ns) > kRepeatsAfter_s)
    return BodyState::Repeats;
  return has_known_error_ ? BodyState::Tracked : BodyState::ErrorUnknown;
}

const PoseBook::Sample* PoseBook::of_moment(const Body& body, double moment_s) const {
  for (std::size_t i = 0; i < body.count; ++i)
    if (std::abs(moment_of(body.kept[i]) - moment_s) <= kSameMoment_s) return &body.kept[i];
  return nullptr;
}

// The newest of the bone's poses that most of the tools have one of the same moment for: the bone's newest
// may have come a moment before the tools'.
const PoseBook::Sample& PoseBook::best_world(const TrackerPoses& poses) const {
  const Body& world = bodies_[*world_];
  std::size_t best = 0, most = 0;
  for (std::size_t i = 0; i < world.count; ++i) {
    std::size_t matched = 0;
    for (std::size_t b = 0; b < bodies_.size(); ++b)
      matched += b != *world_ && poses.bodies[b].is_tracked() &&
                 of_moment(bodies_[b], moment_of(world.kept[i])) != nullptr;
    if (matched <= most) continue;
    best = i;
    most = matched;
  }
  return world.kept[best];
}

void PoseBook::poses_at(std::int64_t now_ns, TrackerPoses& poses) const {
  poses.times_are_arrivals = !has_stamps_;
  poses.bodies.resize(bodies_.size());
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    poses.bodies[i] = {};
    poses.bodies[i].id = bodies_[i].id;
    poses.bodies[i].state = standing_of(bodies_[i], now_ns);
  }
  if (world_) place(now_ns, poses);
}

void PoseBook::place(std::int64_t now_ns, TrackerPoses& poses) const {
  const auto set = [&](BodyPose& body, const geometry::RigidTransform& pose, const Sample& of) {
    body.tracker_from_body = pose;
    body.stamp_utc_s = of.stamp_utc_s;
    body.age_s = age_s(of, now_ns);
    if (body.age_s > kMaxAge_s) body.state = BodyState::Late;
  };
  BodyPose& world = poses.bodies[*world_];
  const Sample* world_sample = nullptr;
  if (world.is_tracked()) {
    world_sample = &best_world(poses);
    set(world, world_sample->pose, *world_sample);
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    BodyPose& body = poses.bodies[i];
    if (i == *world_ || !body.is_tracked()) continue;
    const Sample& newest = bodies_[i].kept.front();
    if (newest.is_in_world && is_in_world_alone_) {
      set(body, newest.pose, newest);
      if (!body.is_tracked() || world.is_tracked()) continue;
      set(world, geometry::RigidTransform(), newest);
      world.state = BodyState::Tracked;
    } else if (world_sample == nullptr) {
      body.state = newest.is_in_world ? BodyState::OtherWorld : BodyState::OtherFrame;
      if (newest.is_in_world && world.state == BodyState::NeverCame) world.state = BodyState::OtherWorld;
    } else if (newest.is_in_world) {
      set(body, world_sample->pose * newest.pose, newest);
    } else if (const Sample* const together = of_moment(bodies_[i], moment_of(*world_sample))) {
      set(body, together->pose, *together);
    } else {
      body.state = BodyState::OtherMoment;
    }
  }
}

}  // namespace arthronaut::tracker
