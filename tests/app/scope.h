// An arthroscope for tests of what is drawn over its picture.
#pragma once

#include "navigation/camera/camera_model.h"

namespace arthronaut::test {

// 1920 x 1080 pixels times `scale`, with strong distortion, its round view whole. Optical axis, rotation
// centre and middle of the view lie apart, so that none can pass for another.
inline camera::Calibration scope(double scale = 1) {
  camera::Calibration calibration;
  calibration.image_size_px = (scale * Eigen::Vector2d(1920, 1080)).cast<int>();
  calibration.focal_px = scale * 590;
  calibration.principal_point_px = scale * Eigen::Vector2d(962, 541);
  calibration.rotation_center_px = scale * Eigen::Vector2d(958, 538);
  calibration.distortion_xi = -0.3;
  calibration.boundary = {scale * Eigen::Vector2d(960, 540), scale * 500};
  return calibration;
}

}  // namespace arthronaut::test
