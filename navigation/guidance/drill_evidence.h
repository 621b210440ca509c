// What navigation saw of a tunnel that the surgeon says he drilled. Whether a tunnel was drilled is his word
// alone; this says where the guide, or a drill with a marker of its own, stood meanwhile, or why nothing can
// be said. A guide's end stays on the bone while the drill runs through it: its axis is the tunnel's, its
// depth is not.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "navigation/guidance/guidance.h"

namespace arthronaut::guidance {

struct DrillEvidenceLimits {
  // A guide stands on the bone when its end is between these, along the plan from the planned entry. The
  // lower one allows for guidance's own error before contact; the upper one for a bone that falls away beside
  // the entry: a guide deeper than that went where there is bone, so the numbers are not of a guide that was
  // held on it.
  double least_depth_mm = -1.5, most_depth_mm = 4;
  // And when its end is no farther from the plan's axis than this. Depth alone holds anywhere on the plane
  // through the entry, on the bone or beside it; farther off than a tunnel is wide it is another place.
  double most_lateral_mm = 5;
  // A drill counts from this depth on: less than that is a scratch.
  double least_drilled_mm = 2;
  // The poses that count lie this near to the deepest (the 90 % quantile, so that one jump decides nothing).
  double window_mm = 1;
  // And together stand for so long: each for the time since the frame before it, a lost picture's at most.
  double least_s = 0.5;
};

enum class EvidenceOutcome {
  NoGuidance,    // no valid numbers in the whole time
  NeverTouched,  // the guide's end never came to the bone
  BesideEntry,   // it stood as deep as the bone, but not at the planned entry
  TooShort,      // it stood there, too shortly
  Seen,
  NoPicture,  // none that showed anything came when it was said: nobody saw what was done since the last
};
[[nodiscard]] std::string_view to_text(EvidenceOutcome outcome);  // plain words

struct DrillEvidenceSummary {
  EvidenceOutcome outcome = EvidenceOutcome::NoGuidance;
  bool is_of_drill = false;  // of a drill with a marker of its own; else of the guide
  int pose_count = 0;        // that the axis rests on; also when they are of too short a time
  // The nearest that the guide's end came to the planned entry, whatever the outcome but NoGuidance.
  double nearest_mm = 0;
  // Meaningful when is_usable(). Medians, bone frame: where the axis crosses the plane through the planned
  // entry across the plan, and its direction.
  Eigen::Vector3d entry_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  double depth_mm = 0;                              // median: of the drill's tip, or of the guide's end
  double spread_mm = 0;                             // root mean square of the crossings about theirs
  double sigma_offset_mm = 0, sigma_angle_deg = 0;  // predicted, medians
  std::int64_t timestamp_ns = 0;                    // of the last pose that counts
  [[nodiscard]] bool is_usable() const { return outcome == EvidenceOutcome::Seen; }
};

// Thread-free. add() allocates nothing: the store has a fixed size, and thins itself out when it is full.
class DrillEvidence {
 public:
  // The plan that is drilled. Throws InvalidInput when a limit makes no sense (a window or a time that is not
  // above 0).
  explicit DrillEvidence(const tunnels::Tunnel& planned, const DrillEvidenceLimits& limits = {});
  // Every frame's numbers, in the order of time; those that are not valid are passed over.
  void add(const GuidanceNumbers& numbers);
  // For the next hole.
  void clear();
  // What was seen of the guide; a drill's own poses stay.
  void forget_guide();
  [[nodiscard]] DrillEvidenceSummary summary() const;
  [[nodiscard]] const tunnels::Tunnel& planned() const { return planned_; }

 private:
  struct Pose {
    Eigen::Vector3d point_mm, direction;
    double depth_mm = 0, sigma_offset_mm = 0, sigma_angle_deg = 0;
    std::int64_t timestamp_ns = 0, stands_for_ns = 0;
  };
  // Of fixed capacity; full, it keeps every other pose and from then on takes every other one, each with the
  // time of those that it stands for.
  class Store {
   public:
    Store();
    void add(Pose pose);
    void clear();
    [[nodiscard]] const std::vector<Pose>& poses() const { return poses_; }

   private:
    std::vector<Pose> poses_;
    std::size_t stride_ = 1, passed_over_ = 0;
    std::int64_t passed_over_ns_ = 0;
  };
  void summarise(const std::vector<Pose>& poses, DrillEvidenceSummary& summary) const;

  tunnels::Tunnel planned_;
  DrillEvidenceLimits limits_;
  Store guide_, drill_;
  std::size_t valid_count_ = 0, deep_enough_count_ = 0;
  double nearest_mm_ = 0;
  std::optional<std::int64_t> newest_ns_;  // of the frames that were looked at, whatever they held
};

}  // namespace arthronaut::guidance
