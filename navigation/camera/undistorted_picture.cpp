#include "navigation/camera/undistorted_picture.h"

#include <opencv2/imgproc.hpp>

namespace arthronaut::camera {

void UndistortedPicture::enlarge_table(const std::shared_ptr<const UndistortedView>& view, int size_px) {
  view_ = view;
  size_px_ = size_px;
  const std::size_t pixels = static_cast<std::size_t>(size_px) * static_cast<std::size_t>(size_px);
  arms_px_.clear();
  arms_px_.reserve(2 * pixels);
  map_px_.assign(2 * pixels, 0);
  bgr_.resize(3 * pixels);
  const CameraModel at_origin;  // the table's arms as they are
  for (int row = 0; row < size_px; ++row) {
    for (int column = 0; column < size_px; ++column) {
      // A pixel's middle is half a pixel inside its edge.
      const Eigen::Vector2d place((2 * column + 1.0) / size_px - 1, (2 * row + 1.0) / size_px - 1);
      const Eigen::Vector2d arm = view->pixel_from_view(at_origin, place);
      arms_px_.push_back(static_cast<float>(arm.x()));
      arms_px_.push_back(static_cast<float>(arm.y()));
    }
  }
}

void UndistortedPicture::turn(const CameraModel& camera) {
  principal_point_px_ = camera.principal_point_px();
  circle_px_ = camera.boundary().center_px;
  const Eigen::Vector2f center = principal_point_px_.cast<float>(), circle = circle_px_.cast<float>();
  const float radius =
      camera.boundary().radius_px > 0 ? static_cast<float>(camera.boundary().radius_px) : 1e9F;
  for (std::size_t i = 0; i < map_px_.size(); i += 2) {
    const float x = arms_px_[i] + center.x(), y = arms_px_[i + 1] + center.y();
    const float dx = x - circle.x(), dy = y - circle.y();
    const bool is_seen = dx * dx + dy * dy <= radius * radius;
    map_px_[i] = is_seen ? x : -100;  // black
    map_px_[i + 1] = is_seen ? y : -100;
  }
}

const std::vector<std::uint8_t>& UndistortedPicture::draw(const Frame& frame, const CameraModel& camera,
                                                          const std::shared_ptr<const UndistortedView>& view,
                                                          int size_px) {
  const bool is_new = view_ != view || size_px_ != size_px;
  if (is_new) enlarge_table(view, size_px);
  if (is_new || principal_point_px_ != camera.principal_point_px() ||
      circle_px_ != camera.boundary().center_px)
    turn(camera);
  const cv::Mat raw(frame.height, frame.width, CV_8UC3,
                    const_cast<std::uint8_t*>(bgr_of(frame, colours_).data()));
  const cv::Mat map(size_px, size_px, CV_32FC2, map_px_.data());
  cv::Mat picture(size_px, size_px, CV_8UC3, bgr_.data());
  cv::remap(raw, picture, map, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar());
  return bgr_;
}

}  // namespace arthronaut::camera
