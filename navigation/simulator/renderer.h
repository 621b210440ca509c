// Draws one frame of a simulated scene through the exact camera model, on raw pixels, on the CPU.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "navigation/camera/camera_model.h"
#include "navigation/camera/frame.h"
#include "navigation/simulator/bone_view.h"
#include "navigation/simulator/ground.h"
#include "navigation/simulator/parallel_rows.h"
#include "navigation/simulator/sensor.h"
#include "navigation/simulator/solid_layer.h"
#include "navigation/simulator/solids.h"

namespace arthronaut::simulator {

struct Scene {
  std::vector<std::unique_ptr<Solid>> solids;  // in the camera frame
  bool has_bone = false;
  geometry::RigidTransform camera_from_bone;
  float exposure =
      300;  // linear light of a white surface that faces the light at 1 mm; at d mm it is 1 / d^2 of that
};

class Renderer {
 public:
  // bone may be null: then scenes have none. It must outlive the renderer.
  Renderer(BoneView* bone, const SensorOptions& sensor);

  // Everything about the frame but its index and timestamp. The same arguments give the same bytes.
  void render(const Scene& scene, const camera::CameraModel& camera, double mark_angle_deg,
              std::uint64_t noise_seed, camera::Frame& frame);

 private:
  // Kept from frame to frame for their memory.
  struct ThreadMemory {
    BoneRows bone_rows;
    Ground::Memory ground;
    SolidLayer::Memory solids;
  };

  BoneView* bone_;
  double vignette_share_;
  Sensor sensor_;
  std::array<ThreadMemory, kMostThreads> memory_;
  std::vector<float> light_;
};

}  // namespace arthronaut::simulator
