#include "app/widgets/picture_placement.h"

namespace arthronaut::widgets {

Rect shown_part(const camera::Boundary& view, int width_px, int height_px) {
  const float width = static_cast<float>(width_px), height = static_cast<float>(height_px);
  if (view.radius_px <= 0) return {0, 0, width, height};
  constexpr double kMargin = 1.03;
  const float half = static_cast<float>(kMargin * view.radius_px);
  const float x = static_cast<float>(view.center_px.x()), y = static_cast<float>(view.center_px.y());
  const float left = std::max(x - half, 0.F), right = std::min(x + half, width);
  const float top = std::max(y - half, 0.F), bottom = std::min(y + half, height);
  return {left, top, std::max(right - left, 1.F), std::max(bottom - top, 1.F)};
}

PicturePlacement::PicturePlacement(const Rect& area, const Rect& part) : area_(area), part_(part) {}

PicturePlacement::PicturePlacement(const Rect& area, const camera::CameraModel& camera,
                                   const camera::UndistortedView& view)
    : area_(area), camera_(&camera), view_(&view) {}

std::optional<ImVec2> PicturePlacement::on_screen(const Eigen::Vector2d& raw_pixel) const {
  if (camera_ == nullptr) {
    // A pixel's middle is half a pixel inside its edge.
    const float zoom = area_.width / part_.width;
    return ImVec2{area_.x + (static_cast<float>(raw_pixel.x()) + 0.5F - part_.x) * zoom,
                  area_.y + (static_cast<float>(raw_pixel.y()) + 0.5F - part_.y) * zoom};
  }
  const auto place = view_->view_from_pixel(*camera_, raw_pixel);
  if (!place) return std::nullopt;
  return ImVec2{area_.x + static_cast<float>(place->x() + 1) / 2 * area_.width,
                area_.y + static_cast<float>(place->y() + 1) / 2 * area_.height};
}

}  // namespace arthronaut::widgets
