// How the markers of a hard clip move: the scope by a hand that sways, the tools by hands of their own.
#pragma once

#include <vector>

#include "navigation/camera/camera_model.h"
#include "planning/geometry/rigid_transform.h"
#include "tests/benchmarks/hard_clips/draw.h"
#include "tests/benchmarks/hard_clips/recipe.h"

namespace arthronaut::hard_clips {

// A sum of two sines in each of the six directions.
class Sway {
 public:
  Sway() = default;
  // The largest speed of translation about speed_mm_s, of turning about the line of sight turn_rad_s; it goes
  // about reach_mm to either side.
  Sway(Draw& draw, double speed_mm_s, double turn_rad_s, double reach_mm);
  [[nodiscard]] geometry::Vector6d at(double time_s) const;

 private:
  geometry::Vector6d amplitude_[2]{geometry::Vector6d::Zero(), geometry::Vector6d::Zero()};
  geometry::Vector6d phase_[2]{geometry::Vector6d::Zero(), geometry::Vector6d::Zero()};
  double rate_[2]{0, 0};
};

class ClipMotion {
 public:
  static constexpr int kMarkers = 3;
  static constexpr int kIds[kMarkers] = {0, 2, 3};

  ClipMotion(const ClipRecipe& recipe, const camera::CameraModel& camera);
  [[nodiscard]] geometry::RigidTransform camera_from_marker(int marker, double time_s) const;

 private:
  Sway scope_;
  Sway hands_[kMarkers];
  geometry::RigidTransform rest_[kMarkers];
  double distance_mm_ = 25;
};

// The scope's camera of a clip: one lens angle, in saline.
[[nodiscard]] camera::Calibration calibration_of(const ClipRecipe& recipe);
[[nodiscard]] camera::CameraModel camera_of(const ClipRecipe& recipe);

}  // namespace arthronaut::hard_clips
