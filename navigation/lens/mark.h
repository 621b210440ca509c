// The lens mark as a dent in the rim: candidates in one profile, and the shape that is learnt of the true
// one. Inside the module; users of the lens take lens_tracker.h.
#pragma once

#include <array>

#include "navigation/lens/lens_tracker.h"
#include "navigation/lens/rim.h"

namespace arthronaut::lens {

// A triangle on the rim: half its base in degrees of the circle, its height as a share of the radius.
struct MarkShape {
  double half_width_deg = 0;
  double height = 0;
};

struct MarkCandidate {
  MarkPolarity polarity = MarkPolarity::Unknown;
  double angle_deg = 0;  // of the tip about the circle's centre, [0, 360)
  double sigma_deg = 0;
  MarkShape shape;
  double score = 0;       // normalised correlation with the triangle over mark and flanks, at most 1
  double seen_share = 0;  // of the rays over mark and flanks
};

// How far the rim lies inside (+) or outside (-) the circle, along each ray of the profile.
struct DentProfile {
  std::array<float, kRayCount> depth_px{};
  std::array<bool, kRayCount> seen{};
  std::array<float, kRayCount> light{};                // of the scene inside the rim, linear
  Eigen::Vector2d shift_px = Eigen::Vector2d::Zero();  // of the circle's centre against the rays' centre
  double radius_px = 0;
  // What to add to the angle of a ray that meets the rim to have its angle about the circle's centre.
  [[nodiscard]] double angle_correction_deg(double angle_deg) const;
};

void dents_of(const RimProfile& profile, const camera::Boundary& circle, DentProfile& dents);

// The candidates of one profile, best score first.
struct MarkCandidates {
  static constexpr int kMost = 8;
  std::array<MarkCandidate, kMost> items;
  int count = 0;
};
// Everything that could be a mark, nothing assumed about where; `known` (a learnt shape) sharpens the choice.
[[nodiscard]] MarkCandidates find_marks(const DentProfile& dents, MarkPolarity polarity,
                                        const MarkShape* known);

// The learnt shape within search_deg of an expected angle, even when one flank is in the dark. A score of 0:
// nothing.
[[nodiscard]] MarkCandidate follow_mark(const DentProfile& dents, MarkPolarity polarity,
                                        const MarkShape& known, double expected_deg, double search_deg);

// What stands at a place of the rim where the mark was expected but not found.
[[nodiscard]] MarkState judge_place(const DentProfile& dents, double angle_deg, double half_width_deg);

[[nodiscard]] double wrapped_deg(double angle_deg);       // to [0, 360)
[[nodiscard]] double difference_deg(double a, double b);  // a - b to (-180, 180]

}  // namespace arthronaut::lens
