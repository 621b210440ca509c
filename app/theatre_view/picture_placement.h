// Where a raw pixel of the arthroscope's picture stands on the screen: as it came, cut to the round view, or
// without the lens' distortion. What is drawn over the picture asks here, so that it lies on the picture in
// either mode.
#pragma once

#include <optional>

#include "app/widgets/layout.h"
#include "navigation/camera/undistorted_view.h"

namespace arthronaut::theatre_view {

// The part of the raw picture that is shown: the square about the round view at lens angle 0, inside the
// image. The rim moves a little as the lens turns, so a margin is left.
[[nodiscard]] widgets::Rect shown_part(const camera::Calibration& calibration, int width_px, int height_px);

class PicturePlacement {
 public:
  // As it came: `part` of the raw picture fills `area`, which has the same aspect.
  PicturePlacement(const widgets::Rect& area, const widgets::Rect& part);
  // Undistorted: the view's square fills `area`, also a square. Camera and view outlive this.
  PicturePlacement(const widgets::Rect& area, const camera::CameraModel& camera,
                   const camera::UndistortedView& view);

  // nullopt where the model has no ray.
  [[nodiscard]] std::optional<ImVec2> on_screen(const Eigen::Vector2d& raw_pixel) const;

 private:
  widgets::Rect area_, part_;
  const camera::CameraModel* camera_ = nullptr;  // null: as it came
  const camera::UndistortedView* view_ = nullptr;
};

}  // namespace arthronaut::theatre_view
