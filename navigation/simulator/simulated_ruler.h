// The scene of the paper's first experiment: a ruler with two markers in fluid, while the lens turns.
// Deterministic by seed.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "navigation/simulator/simulated_operation.h"
#include "navigation/simulator/solids.h"

namespace arthronaut::simulator {

struct RulerOptions {
  camera::Calibration camera;        // the true one
  double refractive_index = 1.3345;  // of the fluid
  std::uint64_t seed = 1;
  int frame_count = 500;
  int frames_per_second = 30;
  double rotation_deg = 140;        // of the lens, from one end to the other
  int first_id = 5, second_id = 6;  // the markers, x along the ruler
  double size_mm = 2.89;
  double spacing_mm = 10;  // between the markers' centres
  // What is printed for an id; the project's own markers when empty.
  std::function<MarkerCells(int id)> printed;
};

class SimulatedRuler : public sources::FrameSource {
 public:
  // Throws InvalidInput when the options break their contract.
  explicit SimulatedRuler(const RulerOptions& options);
  ~SimulatedRuler() override;
  [[nodiscard]] const sources::SourceInfo& info() const override;
  [[nodiscard]] camera::FramePtr next() override;

  // Of the frame that next() gave last; camera_from_bone is without meaning.
  [[nodiscard]] const FrameTruth& truth() const;
  [[nodiscard]] geometry::RigidTransform first_from_second() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::simulator
