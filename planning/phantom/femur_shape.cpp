#include "planning/geometry/rigid_transform.h"
#include "planning/phantom/knee_shape.h"

namespace arthronaut::phantom {

namespace {

constexpr double kTopMm = 66.0;  // above the epicondylar axis: about 90 mm above the joint
// The anterior outlet of the notch, where Blumensaat's line meets the trochlea, in the sagittal plane.
const Eigen::Vector2d kRoofOutlet{12.5, -17.5};
constexpr double kNotchMiddleX = 0.0;

// The joint surface seen from the side: posterior condyle, distal condyle, trochlear ridge, as hulls of
// circles.
struct SagittalProfile {
  Circle posterior, distal, trochlear;

  [[nodiscard]] double distance(const Eigen::Vector2d& p) const {
    return smooth_union(hull_of_circles(p, posterior, distal), hull_of_circles(p, distal, trochlear), 5.0);
  }
};

const SagittalProfile kLateral{{{-9.5, -3.0}, 19.5}, {{6.0, -1.5}, 23.5}, {{15.5, 6.0}, 18.5}};
const SagittalProfile kMedial{{{-10.5, -3.5}, 20.5}, {{3.0, -1.5}, 23.5}, {{12.0, 3.0}, 18.0}};

// The profiles lie below this, the fill of their creases too; q.z() above it is a distance from the pulley at
// least.
constexpr double kProfilesTopMm = 26.0;
constexpr double kShaftFromMm = -8.0;
// A surface further off than the crease is wide is not looked at: a union is the other one's then, to the
// last bit. The margin is that of rounding.
constexpr double kShaftCreaseMm = 10.0, kFurtherMm = kShaftCreaseMm + 1e-6;

// 0 far below zero, x far above, without a kink.
double ramp(double x) { return 0.5 * (x + std::sqrt(x * x + 36.0)); }

}  // namespace

FemurShape::FemurShape(const KneeParameters& parameters) : parameters_(parameters) {
  const double slope = geometry::rad_from_deg(parameters.roof_slope_deg);
  roof_direction_ = {std::sin(slope), -std::cos(slope)};
  roof_normal_ = {-std::cos(slope), -std::sin(slope)};
  shaft_lean_ = std::tan(geometry::rad_from_deg(parameters.shaft_valgus_deg));
}

Eigen::Vector3d FemurShape::min_mm() const { return parameters_.scale * Eigen::Vector3d(-50, -40, -36); }
Eigen::Vector3d FemurShape::max_mm() const { return parameters_.scale * Eigen::Vector3d(50, 44, kTopMm + 4); }
Eigen::Vector2d FemurShape::roof_point() const { return parameters_.scale * kRoofOutlet; }
Eigen::Vector2d FemurShape::roof_direction() const { return roof_direction_; }
Eigen::Vector2d FemurShape::roof_normal() const { return roof_normal_; }
double FemurShape::notch_middle_x_mm() const {
  return parameters_.scale * parameters_.width_factor * kNotchMiddleX;
}

// Both condyles and the trochlea as one pulley: the sagittal profile, lowered by the groove, between slanted
// sides.
double FemurShape::pulley(const Eigen::Vector3d& q) const {
  const Eigen::Vector2d sagittal(q.y(), q.z());
  const double lateral = kLateral.distance(sagittal);
  const double medial = kMedial.distance(sagittal - Eigen::Vector2d(0.0, -parameters_.medial_distal_mm));
  const double share = smooth_step(-13.0, 13.0, q.x());
  const double off_groove = std::min(std::abs(q.x() - 1.5) / 20.0, 1.0);
  const double groove =
      off_groove < 1 ? 0.5 * parameters_.groove_depth_mm * (1.0 + std::cos(geometry::kPi * off_groove)) : 0;
  const double surface = (1.0 - share) * medial + share * lateral + groove;

  // Seen from below the condyles are a trapezium: the sides come together towards the front, the medial one
  // more, and they come together a little towards the joint.
  const double front = ramp(q.y() + 6.0), back = ramp(-q.y() - 12.0), low = ramp(-q.z());
  const double lateral_side = (q.x() - 35.0 + 0.17 * front + 0.10 * back + 0.06 * low) / 1.02;
  const double medial_side = (-q.x() - 37.0 + 0.36 * front + 0.06 * back + 0.08 * low) / 1.06;
  return filleted_intersection(surface, std::max(lateral_side, medial_side), 11.0);
}

// An arch under Blumensaat's line, open in front, below and behind; wider towards its mouth.
double FemurShape::notch(const Eigen::Vector3d& q) const {
  const double under_roof = roof_normal_.dot(Eigen::Vector2d(q.y(), q.z()) - kRoofOutlet);
  const double half_width = parameters_.notch_half_width_mm / parameters_.width_factor +
                            0.05 * (under_roof - 9.0) + 0.08 * ramp(-q.y() - 14.0);
  return filleted_intersection(std::abs(q.x() - kNotchMiddleX) - half_width, -under_roof, 8.5);
}

// Metaphysis and shaft: a flare that turns from a wide oval into a tube, leaning laterally.
double FemurShape::shaft(const Eigen::Vector3d& q) const {
  const double flare = 1.0 / (1.0 + std::exp((q.z() - 22.0) / 9.5));
  const double lean = shaft_lean_ * std::max(q.z(), -10.0);
  const double half_width = 16.8 + 18.0 * flare, half_depth = 16.2 + 0.8 * flare;
  const double tube = superellipse(q.x() - lean, q.y() - 8.5, half_width, half_depth, 2.0 + 0.9 * flare);
  return filleted_intersection(tube, kShaftFromMm - q.z(), 3.0);
}

double FemurShape::pulley_and_shaft(const Eigen::Vector3d& q) const {
  if (q.z() > kProfilesTopMm) {
    const double tube = shaft(q);
    return q.z() - kProfilesTopMm > tube + kFurtherMm ? tube : smooth_union(pulley(q), tube, kShaftCreaseMm);
  }
  const double joint = pulley(q);
  return kShaftFromMm - q.z() > joint + kFurtherMm ? joint : smooth_union(joint, shaft(q), kShaftCreaseMm);
}

double FemurShape::operator()(const Eigen::Vector3d& p) const {
  Eigen::Vector3d q = p / parameters_.scale;
  q.x() /= parameters_.width_factor;

  double bone = pulley_and_shaft(q);
  bone = smooth_union(bone, ellipsoid(q, {29.0, -3.0, 1.0}, {9.0, 13.0, 12.0}), 12.0);   // lateral epicondyle
  bone = smooth_union(bone, ellipsoid(q, {-30.0, -3.5, 1.5}, {9.5, 14.0, 12.0}), 12.0);  // medial epicondyle
  bone = smooth_union(bone, ellipsoid(q, {-26.5, -6.0, 13.5}, {6.0, 6.0, 6.0}), 12.0);   // adductor tubercle
  bone = filleted_difference(bone, notch(q), 3.5);

  const auto& phase = parameters_.ripple_phases;
  bone += 0.2 * std::sin(0.31 * q.x() + 0.2 * q.z() + phase[0]) * std::sin(0.27 * q.y() + phase[1]) +
          0.15 * std::sin(0.42 * q.z() + 0.3 * q.x() + phase[2]) * std::cos(0.39 * q.y() + phase[3]);
  return parameters_.scale * filleted_intersection(bone, q.z() - kTopMm, 1.0);
}

}  // namespace arthronaut::phantom
