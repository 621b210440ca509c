#include "planning/geometry/rigid_transform.h"
#include "planning/phantom/knee_shape.h"

namespace arthronaut::phantom {

namespace {

constexpr double kPlateauZ = -30.5;  // bone only: the cartilage of both bones fills the gap to the femur
constexpr double kBottomMm = -112.0;
constexpr double kHollowMm = 2.2;  // below the slope; all else stands above it

double bump(double x, double y, double sigma_x, double sigma_y) {
  return std::exp(-0.5 * (std::pow(x / sigma_x, 2) + std::pow(y / sigma_y, 2)));
}

double mix(double a, double b, double share) { return a + share * (b - a); }

}  // namespace

TibiaShape::TibiaShape(const KneeParameters& parameters)
    : parameters_(parameters), slope_(std::tan(geometry::rad_from_deg(parameters.plateau_slope_deg))) {}

Eigen::Vector3d TibiaShape::min_mm() const {
  return parameters_.scale * Eigen::Vector3d(-48, -40, kBottomMm - 4);
}
Eigen::Vector3d TibiaShape::max_mm() const {
  return parameters_.scale * Eigen::Vector3d(48, 38, kPlateauZ + 20);
}

double TibiaShape::plateau_slope_mm(double anterior) const { return kPlateauZ + slope_ * (anterior + 3.0); }

// The top: sloping backwards, hollow medially, slightly domed laterally, with the two spines between.
double TibiaShape::plateau_height_mm(double lateral, double anterior) const {
  double height = plateau_slope_mm(anterior);
  height -= kHollowMm * bump(lateral + 20.0, anterior + 3.0, 9.0, 12.0);
  height += 0.8 * bump(lateral - 20.0, anterior + 6.0, 9.0, 11.0);
  height += (parameters_.eminence_height_mm - 0.5) * bump(lateral + 6.5, anterior + 6.0, 4.4, 8.0);
  height += (parameters_.eminence_height_mm - 1.5) * bump(lateral - 6.0, anterior + 9.0, 4.2, 7.0);
  height += 1.5 * bump(lateral, anterior + 7.0, 10.0, 11.0);
  return height;
}

double TibiaShape::operator()(const Eigen::Vector3d& p) const {
  Eigen::Vector3d q = p / parameters_.scale;
  q.x() /= parameters_.width_factor;

  // Two condyles and a middle that flow together into a three-sided shaft.
  const double down = std::max(kPlateauZ + 2.0 - q.z(), 0.0);
  const double flow = smooth_step(5.0, 66.0, down);
  const double narrow = smooth_step(7.0, 58.0, down);
  const double back = mix(0.0, -2.0, flow);
  const double medial = superellipse(q.x() - mix(-17.5, -4.5, narrow), q.y() - mix(-3.5, -5.0, flow) - back,
                                     mix(20.0, 11.5, narrow), mix(24.5, 11.0, flow), 2.2);
  const double lateral = superellipse(q.x() - mix(18.0, 5.5, narrow), q.y() - mix(-4.5, -5.0, flow) - back,
                                      mix(19.5, 11.0, narrow), mix(22.0, 11.0, flow), 2.2);
  const double middle = superellipse(q.x() - 1.0, q.y() - mix(3.0, 1.0, flow), mix(18.0, 8.0, narrow),
                                     mix(17.5, 15.0, flow), 2.0);
  double bone = smooth_union(smooth_union(medial, lateral, 7.0), middle, 9.0);
  bone =
      smooth_union(bone, ellipsoid(q, {4.0, 13.5, kPlateauZ - 30.0}, {8.5, 8.5, 15.0}), 10.0);  // tuberosity
  // Far below the top nothing is cut off: no bit depends on how far.
  constexpr double kFillet_mm = 3.0;
  const double top_at_most = (q.z() - plateau_slope_mm(q.y()) + kHollowMm + 1e-6) / 1.15;
  const double top = top_at_most < std::min(bone, -kFillet_mm)
                         ? top_at_most
                         : (q.z() - plateau_height_mm(q.x(), q.y())) / 1.15;
  bone = filleted_intersection(bone, top, kFillet_mm);

  const auto& phase = parameters_.ripple_phases;
  bone += 0.22 * std::sin(0.29 * q.x() + 0.22 * q.z() + phase[4]) * std::sin(0.31 * q.y() + phase[5]) +
          0.15 * std::sin(0.45 * q.z() - 0.3 * q.x() + phase[2]) * std::cos(0.37 * q.y() + phase[0]);
  return parameters_.scale * filleted_intersection(bone, kBottomMm - q.z(), 1.0);
}

}  // namespace arthronaut::phantom
