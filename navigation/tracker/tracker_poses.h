// Where an outside tracker sees each body at one moment, or why it does not: one frame's worth.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "navigation/tools/tool_set.h"
#include "planning/geometry/tracked_pose.h"

namespace arthronaut::tracker {

// Kept as numbers in recordings: new ones go to the end.
enum class BodyState {
  Tracked,
  NotConnected,
  NeverCame,     // no pose of it since the connection began
  Stale,         // the last one came too long ago
  Late,          // they come, but are of too long ago by the tracker's clock
  ClockUnknown,  // the connection is too young to know how the tracker's clock runs
  OtherMoment,   // of another moment than the bone's
  OtherFrame,    // in the tracker's frame, while the bone is known in none
  Repeats,       // the same to the last bit for too long
  NoRotation,    // the newest was no rigid pose
  ToldLost,      // the tracker says that it does not see it
  ErrorUnknown,  // nobody said how wrong the tracker's poses are
  OtherWorld,    // in a bone's world, while nothing says that it is this bone's
};
// "tracked", "no pose of it comes", ...
[[nodiscard]] std::string_view to_text(BodyState state);

struct BodyPose {
  int id = 0;  // the body's: marker_id of the tool or the world marker
  BodyState state = BodyState::NotConnected;
  // Meaningful when is_tracked(). One frame for all bodies: the tracker's or, where poses come in the bone's
  // world, that.
  geometry::RigidTransform tracker_from_body;
  double stamp_utc_s = 0;  // by the tracker's clock; 0: the message had none
  double age_s = 0;  // at the most, as far as the network goes; what the tracker itself took is not seen
  [[nodiscard]] bool is_tracked() const { return state == BodyState::Tracked; }
};

struct TrackerPoses {
  std::vector<BodyPose> bodies;     // the world markers' bodies, then the tools, in the order of the tool set
  bool times_are_arrivals = false;  // messages without a stamp: what the network took is not in their age
  // Of the oldest that is tracked; 0 without one.
  [[nodiscard]] double oldest_age_s() const;
};

// None of them, for the reason.
void set_all(const tools::ToolSet& tools, BodyState why, TrackerPoses& poses);

// With its error, in the frame of this time. Not valid where the body is not tracked or has an unknown error.
[[nodiscard]] geometry::TrackedPose pose_of(const TrackerPoses& poses, int id, std::int64_t timestamp_ns,
                                            const tools::OutsideTracker& tracker);
[[nodiscard]] BodyState state_of(const TrackerPoses& poses, int id);

}  // namespace arthronaut::tracker
