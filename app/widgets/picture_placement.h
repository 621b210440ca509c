// Where a raw pixel of the arthroscope's picture stands on the screen: as it came, cut to the round view, or
// without the lens' distortion. What is drawn over the picture asks here, so that it lies on the picture in
// either mode.
#pragma once

#include <optional>

#include "app/widgets/layout.h"
#include "navigation/camera/undistorted_view.h"

namespace arthronaut::widgets {

// The part of the raw picture that is shown: the square about the round view, inside the image; all of it for
// a view of radius 0. The rim moves a little as the lens turns, so a margin is left.
[[nodiscard]] Rect shown_part(const camera::Boundary& view, int width_px, int height_px);

class PicturePlacement {
 public:
  // As it came: `part` of the raw picture fills `area`, which has the same aspect.
  PicturePlacement(const Rect& area, const Rect& part);
  // Undistorted: the view's square fills `area`, also a square. Camera and view outlive this.
  PicturePlacement(const Rect& area, const camera::CameraModel& camera, const camera::UndistortedView& view);

  // nullopt where the model has no ray.
  [[nodiscard]] std::optional<ImVec2> on_screen(const Eigen::Vector2d& raw_pixel) const;
  [[nodiscard]] const Rect& area() const { return area_; }

 private:
  Rect area_, part_;
  const camera::CameraModel* camera_ = nullptr;  // null: as it came
  const camera::UndistortedView* view_ = nullptr;
};

}  // namespace arthronaut::widgets
