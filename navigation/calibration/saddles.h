// Where two black and two white squares meet, a picture has a saddle of brightness. Inside the module.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "navigation/camera/frame.h"

namespace arthronaut::calibration {

// A picture as floats, lightly smoothed; rows packed.
struct SmoothPicture {
  int width = 0, height = 0;
  std::vector<float> value;
  [[nodiscard]] float at(int x, int y) const { return value[static_cast<std::size_t>(y) * width + x]; }
  [[nodiscard]] float bilinear(double x, double y) const;  // (x, y) must have a pixel on every side
  [[nodiscard]] bool has(double x, double y, double margin) const {
    return x >= margin && y >= margin && x < width - 1 - margin && y < height - 1 - margin;
  }
};
[[nodiscard]] SmoothPicture smoothed(const camera::GrayView& picture, double sigma_px);

struct Saddle {
  Eigen::Vector2d pixel;
  double ixx = 0, ixy = 0, iyy = 0;  // second derivatives, grey values per px^2
  double strength = 0;               // ixy^2 - ixx iyy
  // Unit vectors along the two edges that cross here.
  Eigen::Vector2d edge[2];
  // Below 0 for the neighbours of a checkerboard: black and white change places from corner to corner.
  [[nodiscard]] double likeness(const Saddle& other) const {
    return (ixx - iyy) * (other.ixx - other.iyy) + 4 * ixy * other.ixy;
  }
};

// All saddles with the four-fold look of a checkerboard corner, strongest first.
[[nodiscard]] std::vector<Saddle> find_saddles(const camera::GrayView& picture);

// A ring of brightness about a corner is cut exactly four times, alike on opposite sides. contrast: grey
// values.
[[nodiscard]] bool looks_like_corner(const SmoothPicture& picture, const Eigen::Vector2d& at,
                                     double radius_px, double least_contrast);

struct RefinedCorner {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sigma_px = 0;  // what noise of the gradients makes of the place, along the worse axis
};

// Sub-pixel place of a corner: the point that the brightness gradients around it are square to (Foerstner).
// Only accepted when the neighbourhood is its own picture under half a turn, which glare, the view's rim and
// an instrument spoil: the correlation of the two must reach least_likeness. half_window_px must stay below
// 0.45 of the distance to the next corner.
[[nodiscard]] std::optional<RefinedCorner> refine_corner(const SmoothPicture& picture,
                                                         const Eigen::Vector2d& start, double half_window_px,
                                                         double least_likeness = 0.7);

}  // namespace arthronaut::calibration
