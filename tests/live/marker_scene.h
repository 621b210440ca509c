// Pictures of a bone's marker and a guide's marker that face a plain camera, in motion and with a sensor's
// noise: what a sender sends and what whoever receives it must find.
#pragma once

#include <cstdint>
#include <vector>

#include "navigation/camera/camera_model.h"
#include "navigation/tools/tool_set.h"

namespace arthronaut::test {

inline constexpr int kSceneWidth = 640, kSceneHeight = 480;

[[nodiscard]] camera::Calibration scene_camera();
// World marker 0 of the femur; the femoral guide, 3, measured.
[[nodiscard]] tools::ToolSet scene_tools();

// Grey pictures, packed; made once, so that sending them costs nothing.
class MarkerScene {
 public:
  MarkerScene();
  // The scene at that frame's moment; no two within a second are alike.
  [[nodiscard]] const std::vector<std::uint8_t>& live(long frame) const;
  // No light: a sensor's noise alone.
  [[nodiscard]] const std::vector<std::uint8_t>& black(long frame) const;
  // This frame's upper half over the lower half of the one before.
  [[nodiscard]] std::vector<std::uint8_t> torn(long frame) const;

 private:
  std::vector<std::vector<std::uint8_t>> live_, black_;
};

}  // namespace arthronaut::test
