// The simulated arthroscope in somebody's hands: one more frame source, moved frame by frame by what a
// trainee, a script or another program pushes (hand_control.h), with faults that come when it matters, and
// with the truth of every frame beside it.
//
// In real time it waits for the clock and asks the hand where it is now; without, frames are as far apart as
// frames_per_second says and come as fast as they can be drawn: the same options and the same pushes then
// give the same pictures to the last byte.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "navigation/simulator/fault.h"
#include "navigation/simulator/hand_control.h"
#include "navigation/simulator/simulated_operation.h"

namespace arthronaut::simulator {

// What was true in a frame, and what was pushed before it.
struct HandTruth {
  std::int64_t frame = 0;
  double time_s = 0;
  HandInput input;
  HandState hand;
  geometry::RigidTransform marker_from_bone;  // as it is now, bumped or not
  double slid_mm = 0;                         // of the tip on the bone, so far
  unsigned faults = 0;                        // 1 << FaultKind of those that act; a bump once it has happened
  [[nodiscard]] bool has(FaultKind kind) const { return (faults >> static_cast<unsigned>(kind)) & 1U; }
};

// Written by the source's thread, read by any.
class HandLog {
 public:
  void add(const HandTruth& truth);
  [[nodiscard]] std::optional<HandTruth> at(std::int64_t frame) const;  // empty: not made yet
  [[nodiscard]] std::vector<HandTruth> all() const;
  [[nodiscard]] std::optional<HandTruth> newest() const;

 private:
  mutable std::mutex mutex_;
  std::vector<HandTruth> frames_;
};

// What the scene is, for whoever moves the hand by the truth.
struct HandScene {
  HandStart start;
  tunnels::Tunnel plan;
  double plan_length_mm = 0;                          // inside bone
  std::vector<std::vector<Eigen::Vector3d>> strokes;  // on the bone, where the probe can be seen
  std::vector<std::vector<Eigen::Vector3d>> handles;  // of their probe, unit, tip to handle
  Eigen::Vector3d dimple_mm =
      Eigen::Vector3d::Zero();  // on the bone, where the probe can be turned about its tip
  Eigen::Vector3d dimple_handle = Eigen::Vector3d::UnitZ();  // in the middle of such turns
};
// Asked before each frame; null: the exercise is over and the source ends.
using Hand = std::function<std::optional<HandInput>(const HandScene& scene, const HandState& state)>;

struct HandOptions {
  Hand hand;
  Held held = Held::Probe;        // at the beginning
  bool starts_at_dimple = false;  // the probe, and the view of the scope that goes with it
  std::vector<Fault> faults;
  HandLimits limits;
  // Of the camera's picture, each way: what a frame costs goes with its square.
  double picture_share = 0.5;
  bool in_real_time = false;
  std::shared_ptr<HandLog> log;  // may be null
};

// The same scope with fewer pixels, each way `share` of them; what is known of its errors is left out.
// Throws InvalidInput unless 0.2 <= share <= 1.
[[nodiscard]] camera::Calibration with_fewer_pixels(const camera::Calibration& calibration, double share);

class HandOperation : public sources::FrameSource {
 public:
  // Staged as SimulatedOperation stages the same options, by the camera in them and its full picture. Throws
  // InvalidInput where there is no such place, without a hand, and for broken options.
  HandOperation(const SimulationOptions& options, HandOptions hand);
  ~HandOperation() override;
  [[nodiscard]] const sources::SourceInfo& info() const override;
  [[nodiscard]] camera::FramePtr next() override;

  [[nodiscard]] const HandScene& scene() const;
  // Before anything was bumped.
  [[nodiscard]] geometry::RigidTransform marker_from_bone() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::simulator
