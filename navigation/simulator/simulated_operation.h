// A simulated arthroscope in a phantom knee, moved by a scripted surgeon: one more frame source, with the
// truth beside it. Deterministic by seed. It renders on the CPU and needs no display.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "navigation/camera/camera_model.h"
#include "navigation/simulator/surroundings.h"
#include "navigation/sources/frame_source.h"
#include "navigation/tools/tool_set.h"
#include "planning/phantom/phantom_knee.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::simulator {

enum class Phase {
  Calibrate,  // stills of a checkerboard in air, the lens turned in between
  Pivot,      // the probe pivots in a dimple of the femur, in saline, world marker in view
  Scratch,    // the probe walks over the notch wall
  Drill,      // the guide approaches the plan and drills
};

struct SimulationOptions {
  phantom::PhantomKnee knee;
  camera::Calibration camera;  // the true one; standard_camera() for the built-in scope
  tools::ToolSet tools;        // true geometry
  bones::BoneKind bone = bones::BoneKind::Femur;
  tunnels::Tunnel plan;              // what the scripted surgeon aims at in Drill
  double refractive_index = 1.3345;  // in all phases but Calibrate
  std::uint64_t seed = 1;
  int frames_per_second = 30;
  int frame_count = 0;  // 0: the phase's own length; else its motion sampled in so many frames
  int rest_count = 0;   // Scratch: places where the tip rests for 4 s after the strokes, to touch them
  bool draws = true;    // Scratch: false, with a rest_count: no strokes, the places alone
  double drill_error_mm = 0.6, drill_error_deg = 1.0;  // how well the scripted surgeon aims
  double square_mm = 1.5;                              // of the checkerboard
  SurroundingsOptions surroundings;                    // in all phases but Calibrate
};

// What was true in a frame; poses are exact.
struct FrameTruth {
  std::int64_t frame_index = 0;
  double mark_angle_deg = 0;
  struct Marker {
    int id = 0;
    geometry::RigidTransform camera_from_marker;
  };
  std::vector<Marker> markers;  // those in the scene, seen or not
  geometry::RigidTransform camera_from_bone;
  bool tip_touches_bone = false;
  double drilled_depth_mm = 0;  // Drill: how deep the drill is beyond the bone's surface
};

[[nodiscard]] camera::Calibration standard_camera();  // 1920 x 1080

class SimulatedOperation : public sources::FrameSource {
 public:
  SimulatedOperation(const SimulationOptions& options, Phase phase);
  ~SimulatedOperation() override;
  [[nodiscard]] const sources::SourceInfo& info() const override;
  [[nodiscard]] camera::FramePtr next() override;

  // Truth of the frame that next() gave last; and of the whole scene.
  [[nodiscard]] const FrameTruth& truth() const;
  [[nodiscard]] geometry::RigidTransform marker_from_bone() const;
  [[nodiscard]] tunnels::Tunnel drilled_tunnel()
      const;  // Drill: where the tunnel truly went, in the bone's frame

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::simulator
