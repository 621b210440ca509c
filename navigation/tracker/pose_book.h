// What an outside tracker has told lately, body by body, and what of it may be used at a given moment.
//
// A body's messages are known by name: as tools.json says ("tracker", "devices"), or else by the usual ones
// that named_transforms.h gives out, too:
//
//   WorldFemur, WorldTibia        the bone's body in the tracker's frame
//   Probe, Guide, Drill, NAME     the tool's body in the tracker's frame; NAME: what tools.json calls it
//   Probe_World, Guide_World, ... the same in the bone's world
//   ProbeTip_World                likewise, with its origin at the tip
//
// A server may send one body under several of them. The first that comes is the body's for as long as the
// connection lasts, and the others are passed over: poses of two frames are never compared or mixed.
//
// Poses in the bone's world go without the bone's own only where nobody could mean another world by it:
// tools.json declares this bone and no other, and of no bone anything was ever told, on whichever connection.
// A world that was told by the bone's own poses is not known any more without them.
//
// A pose is used when it came and was taken within the last tenth of a second, and only together with a pose
// of the bone of the same moment: the tracker may be carried, and the bone moves.
//
// A value, without threads and clocks: the same calls give the same answers.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "navigation/tracker/clock_match.h"
#include "navigation/tracker/tracker_poses.h"
#include "planning/bones/bone.h"

namespace arthronaut::tracker {

// What the names of a tracker's messages are held against.
struct TrackedBodies {
  tools::ToolSet tools;
  bones::BoneKind bone = bones::BoneKind::Femur;  // whose body is the world
  std::string probe_name, guide_name;
};

struct ReceivedPose {
  std::string_view device;
  std::optional<geometry::RigidTransform> target_from_source;  // LPS; empty: what came is no rigid pose
  double stamp_utc_s = 0;                                      // 0: the message has none
  std::int64_t arrival_ns = 0;                                 // steady clock
};

class PoseBook {
 public:
  // The limit that pictures have, too (theatre::kLateAfter_s).
  static constexpr double kMaxAge_s = 0.1;

  explicit PoseBook(const TrackedBodies& bodies);

  // Another connection: all that came before is forgotten. longest_transit_s: see ClockMatch.
  void begin(double longest_transit_s);
  void end();
  // False: nobody here goes by that name. A name that is passed over (above) is known all the same.
  bool take(const ReceivedPose& received);
  // The tracker says that it does not see the device, until a pose of it comes.
  void take_lost(std::string_view device);

  void poses_at(std::int64_t now_ns, TrackerPoses& poses) const;
  // The newest pose is too late to be used by the tracker's clock. Where all of them are for seconds, that
  // clock was set anew, or they wait somewhere: a new connection tells which.
  [[nodiscard]] bool is_late() const { return is_connected_ && is_late_; }

 private:
  struct Name {
    std::string device;
    bool is_in_world = false, is_at_tip = false;
  };
  struct Sample {
    geometry::RigidTransform pose;
    double stamp_utc_s = 0;
    std::int64_t arrival_ns = 0, same_since_ns = 0;
    bool is_in_world = false;
  };
  struct Body {
    int id = 0;
    std::vector<Name> names;
    std::optional<std::size_t> in_use;  // of names
    std::optional<Eigen::Vector3d> tip_mm;
    std::array<Sample, 6> kept;  // newest first
    std::size_t count = 0;
    bool is_told_lost = false, is_broken = false, is_bone = false;
  };

  void forget_poses();
  void keep(Body& body, const Name& name, const ReceivedPose& received);
  [[nodiscard]] BodyState standing_of(const Body& body, std::int64_t now_ns) const;
  [[nodiscard]] double age_s(const Sample& sample, std::int64_t now_ns) const;
  [[nodiscard]] const Sample* of_moment(const Body& body, double moment_s) const;
  [[nodiscard]] double moment_of(const Sample& sample) const;
  [[nodiscard]] const Sample& best_world(const TrackerPoses& poses) const;
  void place(std::int64_t now_ns, TrackerPoses& poses) const;

  std::vector<Body> bodies_;  // in the order of TrackerPoses
  std::optional<std::size_t> world_;
  bool may_repeat_ = false, has_known_error_ = false;
  bool is_in_world_alone_ = false;  // whatever is in a world is in this bone's
  bool is_connected_ = false, has_stamps_ = true, is_late_ = false;
  ClockMatch clock_;
};

}  // namespace arthronaut::tracker
