// Pictures of markers with known poses: area-sampled, blurred in light, then gamma, noise and 8 bits. Shares
// nothing with what the product knows about how edges look.
#pragma once

#include <cstdint>
#include <vector>

#include "navigation/camera/camera_model.h"
#include "navigation/camera/frame.h"
#include "navigation/markers/marker_pattern.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::markers {

struct PlacedMarker {
  MarkerCode code;
  double size_mm = 4;
  geometry::RigidTransform camera_from_marker;
  // While the shutter is open it stands at camera_from_marker * exp(t velocity + t^2 / 2 change), t from -0.5
  // to 0.5. Body twists.
  geometry::Vector6d velocity = geometry::Vector6d::Zero(), change = geometry::Vector6d::Zero();
};

struct PictureOptions {
  double blur_px = 1.1;  // sigma of the optics
  double gamma = 2.2;
  double noise_grey = 1.5;  // sigma, in grey levels
  unsigned seed = 1;
  // When the rows are exposed, counted in exposures from the row of each marker's centre: the last row after
  // the first, and the odd rows after the even ones, those half before and half after.
  double readout = 0, fields = 0;
};

// The body twist that moves a marker by this much in the picture, at its centre.
[[nodiscard]] geometry::Vector6d motion_of(const camera::CameraModel& camera,
                                           const geometry::RigidTransform& camera_from_marker,
                                           const Eigen::Vector2d& motion_px);

class RenderedPicture {
 public:
  RenderedPicture(const camera::CameraModel& camera, const std::vector<PlacedMarker>& markers,
                  const PictureOptions& options = {});

  [[nodiscard]] camera::GrayView view() const { return {grey_.data(), width_, height_, width_}; }
  // Adds light of a Gaussian spot, in grey levels at its middle.
  void shine(double x, double y, double sigma_px, double grey);
  // Paints over everything within these bounds (pixels).
  void cover(int left, int top, int right, int bottom, std::uint8_t grey);
  // Lays something over it that lets this share of the grey levels through and adds some.
  void veil(int left, int top, int right, int bottom, double share, double grey);

 private:
  int width_, height_;
  std::vector<std::uint8_t> grey_;
};

// A small wet arthroscope, 800 x 600, lens turned by 30 degrees.
[[nodiscard]] camera::CameraModel small_scope();
// A marker that faces the camera, tilted about x and then y and turned about its normal.
[[nodiscard]] geometry::RigidTransform facing_pose(double x_mm, double y_mm, double z_mm, double tilt_x_deg,
                                                   double tilt_y_deg, double turn_deg);

}  // namespace arthronaut::markers
