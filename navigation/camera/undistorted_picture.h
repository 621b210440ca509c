// The undistorted view of a frame, made on the CPU: for machines whose graphics can't, and to test those that
// can.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "navigation/camera/frame.h"
#include "navigation/camera/undistorted_view.h"

namespace arthronaut::camera {

class UndistortedPicture {
 public:
  // The square of the view as size_px x size_px BGR pixels, rows packed; black outside the round view.
  // `camera` must fit the view. Valid until the next call. Memory is taken when view or size change, not from
  // frame to frame.
  const std::vector<std::uint8_t>& draw(const Frame& frame, const CameraModel& camera,
                                        const std::shared_ptr<const UndistortedView>& view, int size_px);

 private:
  void enlarge_table(const std::shared_ptr<const UndistortedView>& view, int size_px);
  void turn(const CameraModel& camera);

  std::shared_ptr<const UndistortedView> view_;
  int size_px_ = 0;
  std::vector<float> arms_px_;  // pairs (x, y): the view's table for every pixel of the picture
  std::vector<float> map_px_;   // the same from the raw picture's corner, at the lens angle drawn last
  Eigen::Vector2d principal_point_px_ = Eigen::Vector2d::Zero(), circle_px_ = Eigen::Vector2d::Zero();
  std::vector<std::uint8_t> bgr_, colours_;
};

}  // namespace arthronaut::camera
