// The two bones of the phantom as implicit surfaces, in the anatomical frame: x lateral, y anterior, z
// superior, mm, the origin near the middle of the epicondylar axis. For a right knee this frame is the
// patient's RAS. Inner header.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "planning/phantom/implicit_shapes.h"

namespace arthronaut::phantom {

// What differs from knee to knee. Defaults are an average adult; vary() draws from the range of adults.
struct KneeParameters {
  double scale = 1.0;         // of all lengths
  double width_factor = 1.0;  // of medial-lateral lengths
  double notch_half_width_mm = 9.4;
  double roof_slope_deg = 37.0;  // Blumensaat's line against the long axis
  double groove_depth_mm = 6.5;
  double medial_distal_mm = 1.5;  // how much lower the medial condyle reaches
  double shaft_valgus_deg = 6.5;
  double plateau_slope_deg = 7.0;  // posterior slope of the tibia
  double eminence_height_mm = 8.5;
  std::array<double, 6> ripple_phases{1.0, -0.5, 0.3, 0.7, 2.1, -1.3};  // rad, of the low waves of the cortex
};
[[nodiscard]] KneeParameters vary(std::uint64_t seed);

class FemurShape {
 public:
  explicit FemurShape(const KneeParameters& parameters);
  [[nodiscard]] double operator()(const Eigen::Vector3d& p) const;
  [[nodiscard]] Eigen::Vector3d min_mm() const;
  [[nodiscard]] Eigen::Vector3d max_mm() const;
  // Blumensaat's line in the sagittal plane (anterior, superior): a point, the unit direction towards the
  // anterior outlet, and the unit normal into the notch.
  [[nodiscard]] Eigen::Vector2d roof_point() const;
  [[nodiscard]] Eigen::Vector2d roof_direction() const;
  [[nodiscard]] Eigen::Vector2d roof_normal() const;
  // x of the lateral wall of the notch, and of the notch's middle.
  [[nodiscard]] double notch_middle_x_mm() const;
  [[nodiscard]] const KneeParameters& parameters() const { return parameters_; }

 private:
  [[nodiscard]] double pulley_and_shaft(const Eigen::Vector3d& q) const;
  [[nodiscard]] double pulley(const Eigen::Vector3d& q) const;
  [[nodiscard]] double shaft(const Eigen::Vector3d& q) const;
  [[nodiscard]] double notch(const Eigen::Vector3d& q) const;

  KneeParameters parameters_;
  Eigen::Vector2d roof_direction_, roof_normal_;
  double shaft_lean_;  // lateral by superior
};

class TibiaShape {
 public:
  explicit TibiaShape(const KneeParameters& parameters);
  [[nodiscard]] double operator()(const Eigen::Vector3d& p) const;
  [[nodiscard]] Eigen::Vector3d min_mm() const;
  [[nodiscard]] Eigen::Vector3d max_mm() const;
  [[nodiscard]] const KneeParameters& parameters() const { return parameters_; }

 private:
  [[nodiscard]] double plateau_slope_mm(double anterior) const;
  [[nodiscard]] double plateau_height_mm(double lateral, double anterior) const;

  KneeParameters parameters_;
  double slope_;
};

}  // namespace arthronaut::phantom
