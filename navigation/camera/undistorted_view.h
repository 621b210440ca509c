// The picture as a camera without distortion would show it: what is straight in space is straight on the
// screen. A square about the optical axis; places in it are "view coordinates" from (-1, -1), top left, to
// (1, 1), bottom right: tangent coordinates (X/Z, Y/Z) over half_extent().
//
// The lookup table holds, for a grid of places, where they are seen in the raw picture, measured from the
// principal point. Turning the lens turns the principal point alone, so one table serves every
// lens angle; zoom, another scope or another medium needs a new one.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "navigation/camera/camera_model.h"

namespace arthronaut::camera {

class UndistortedView {
 public:
  // Places along one side of the table. Between them it is linear: within 0.1 px of the model at the standard
  // scope.
  static constexpr int kNodes = 257;
  // Wider views are cut: a plane shows the last degrees before 90 at any size but none that is useful.
  static constexpr double kMaxHalfExtent = 1.73;  // 60 degrees

  // Shows the whole round view, or the whole image where the calibration has no boundary.
  explicit UndistortedView(const CameraModel& camera);

  // Whether the table holds for this camera: the same lens and medium, at whatever lens angle.
  [[nodiscard]] bool fits(const CameraModel& camera) const;
  [[nodiscard]] double half_extent() const {
    return half_extent_;
  }  // tangent of the angle to the edges' middles

  // Exact, by the model and not by the table. nullopt where the model has no ray.
  [[nodiscard]] std::optional<Eigen::Vector2d> view_from_pixel(const CameraModel& camera,
                                                               const Eigen::Vector2d& pixel) const;
  // By the table: the raw pixel that is shown at this place, clamped to the square. `camera` must fit.
  [[nodiscard]] Eigen::Vector2d pixel_from_view(const CameraModel& camera, const Eigen::Vector2d& view) const;

  // kNodes x kNodes pairs (x, y), top row first: raw pixel less principal point, px. The outermost places lie
  // on the edges of the square. Where the model has no ray: far outside the round view.
  [[nodiscard]] const std::vector<float>& table_px() const { return table_px_; }

 private:
  [[nodiscard]] static double half_extent_of(const CameraModel& camera);

  CameraModel camera_;  // that the table was made for
  double half_extent_ = 1;
  std::vector<float> table_px_;
};

}  // namespace arthronaut::camera
