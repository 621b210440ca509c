#include "navigation/simulator/simulated_operation.h"

namespace arthronaut::simulator {

camera::Calibration standard_camera() {
  camera::Calibration camera;
  camera.image_size_px = {1920, 1080};
  camera.focal_px = 578.4;
  camera.principal_point_px = {964.8, 533.6};
  camera.distortion_xi = -0.284;
  camera.rotation_center_px = {957.1, 541.9};
  camera.reference_mark_angle_deg = 278.0;
  camera.boundary = {{962.3, 537.4}, 522.0};
  return camera;
}

}  // namespace arthronaut::simulator
