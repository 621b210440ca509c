#include "app/scene/overlay_picture.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <opencv2/imgproc.hpp>

namespace arthronaut::scene {

namespace {

using Colour = std::array<std::uint8_t, 3>;

void dot(Image& picture, const Eigen::Vector2i& at, const Colour& colour) {
  for (int y = std::max(0, at.y() - 1); y <= std::min(picture.height - 1, at.y() + 1); ++y)
    for (int x = std::max(0, at.x() - 1); x <= std::min(picture.width - 1, at.x() + 1); ++x)
      std::copy(colour.begin(), colour.end(),
                picture.rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(y) * picture.width + x));
}

}  // namespace

void draw_overlay(Image& picture, const PlanOverlay& overlay, const FrameCut& cut) {
  constexpr double kBetweenDots_px = 7;
  for (const OverlayLine& line : overlay) {
    if (line.kind == OverlayLine::Kind::TunnelFace) continue;
    const Colour colour =
        line.kind == OverlayLine::Kind::BoneOutline ? Colour{90, 200, 255} : Colour{120, 255, 120};
    const double step_px = line.is_hidden ? kBetweenDots_px : 1;
    for (std::size_t i = 1; i < line.points_px.size(); ++i) {
      const Eigen::Vector2d from = (line.points_px[i - 1] - cut.corner_px) / cut.scale,
                            to = (line.points_px[i] - cut.corner_px) / cut.scale;
      const int count = std::max(1, static_cast<int>((to - from).norm() / step_px));
      for (int k = 0; k <= count; ++k)
        dot(picture, (from + (to - from) * k / count).array().round().cast<int>(), colour);
    }
  }
}

void mark_simulated(Image& picture) {
  cv::Mat pixels(picture.height, picture.width, CV_8UC3, picture.rgb.data());
  const int bar_px = std::max(1, picture.height / 16);
  pixels.rowRange(0, bar_px).setTo(cv::Scalar(0, 0, 0));
  constexpr double kHeightAtScaleOne_px = 21;  // of OpenCV's plain letters
  const double scale = 0.5 * bar_px / kHeightAtScaleOne_px;
  cv::putText(pixels, "SIMULATION: nobody's knee", {bar_px / 2, bar_px * 7 / 10}, cv::FONT_HERSHEY_SIMPLEX,
              scale, cv::Scalar(255, 200, 60), std::max(1, bar_px / 20), cv::LINE_AA);
}

}  // namespace arthronaut::scene
