#include "planning/landmarks/tibia_shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "planning/geometry/rigid_transform.h"
#include "planning/geometry/surface.h"
#include "planning/landmarks/long_axis.h"
#include "planning/landmarks/plateau.h"
#include "planning/landmarks/rough_frame.h"
#include "planning/landmarks/shape_samples.h"

namespace arthronaut::landmarks {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kShaftFrom_mm = 42, kShaftLength_mm = 160;
constexpr double kDrawnOut_mm = 25;
// Real tibiae score 1.7 and more.
constexpr double kSureForward = 0.8;
constexpr double kRim_mm = -6;  // over the plateau's plane: still the plateau
constexpr double kBeside_mm = 4, kSideEnd_mm = 2;
constexpr double kMiddle_mm = 12;  // to either side: eminences
constexpr double kTuberosityFrom_mm = 14, kTuberosityTo_mm = 58;
constexpr double kSureSide = 0.35;

struct Shape {
  RoughFrame rough;
  Plateau plateau;
  std::vector<SurfaceSample> samples;
  std::optional<LongAxis> shaft;
  double forward = 0;                    // forward_score, of the rough frame as it was found
  Matrix3d axes = Matrix3d::Identity();  // anatomical: x right, y anterior, z along the long axis
};

// A sample as the plateau sees it.
Vector3d over_plateau(const Shape& shape, const Vector3d& p) {
  return shape.plateau.bone_from_frame.transpose() * (p - shape.plateau.origin_mm);
}

// How far forward of the plateau's middle the shaft's axis, drawn out to it, passes: about 10 mm, as the
// plateau overhangs the shaft behind. Nothing for a shaft too short to be drawn out so far.
double shaft_forward_mm(const Plateau& plateau, const std::optional<LongAxis>& shaft) {
  if (!shaft || shaft->length_mm() < kDrawnOut_mm) return 0;
  const Matrix3d frame_from_bone = plateau.bone_from_frame.transpose();
  const Vector3d end = frame_from_bone * (shaft->joint_end_mm - plateau.origin_mm),
                 away = frame_from_bone * shaft->away();
  return end.y() - end.z() / away.z() * away.y();
}

// Positive when y of the plateau's frame is anterior: the eminences stand behind the middle, the rim is bent
// in behind, below the front edge the bone comes forward to the tuberosity, which one sees from above, and
// the shaft stands in front of the middle.
double forward_score(const Relief& relief, double shaft_forward_mm) {
  double eminence_y = 0, eminence = 0, seen_below = 0, front_bend = 0, back_bend = 0;
  double front_middle = -1e9, front_sides = -1e9, back_middle = -1e9, back_sides = -1e9;
  for (int row = -Relief::kHalf; row <= Relief::kHalf; ++row) {
    for (int column = -Relief::kHalf; column <= Relief::kHalf; ++column) {
      const double height = relief.at(column, row);
      if (height == Relief::kEmpty) continue;
      const double x = std::abs(column * Relief::kCell_mm), y = row * Relief::kCell_mm;
      if (x < 10 && height > 4) eminence_y += y * (height - 4), eminence += height - 4;
      if (x < 20 && height < -9 && std::abs(y) > 12) seen_below += y > 0 ? 1 : -1;
      if (height < kRim_mm) continue;
      if (x < 4) front_middle = std::max(front_middle, y), back_middle = std::max(back_middle, -y);
      if (x > 12 && x < 26) front_sides = std::max(front_sides, y), back_sides = std::max(back_sides, -y);
    }
  }
  front_bend = front_middle - front_sides;
  back_bend = back_middle - back_sides;
  const double stands_behind = eminence > 0 ? -eminence_y / eminence : 0;
  return stands_behind / 3 + (front_bend - back_bend) / 4 + std::clamp(seen_below / 30, -1.5, 1.5) +
         std::clamp(shaft_forward_mm / 4, -2.5, 2.5);
}

// Positive when x of the plateau's frame is lateral: the medial half is the larger, the rim's foremost part
// stands on the medial side of the middle, and the tuberosity on the lateral one.
double side_score(const Shape& shape, const std::optional<Vector3d>& tuberosity) {
  const Plateau& plateau = shape.plateau;
  const double minus = plateau.area_minus_mm2, plus = plateau.area_plus_mm2;
  double front = 0, front_x = 0, spread_minus = 0, spread_plus = 0;
  for (int row = -Relief::kHalf; row <= Relief::kHalf; ++row) {
    for (int column = -Relief::kHalf; column <= Relief::kHalf; ++column) {
      const double x = column * Relief::kCell_mm, y = row * Relief::kCell_mm;
      if (plateau.relief.at(column, row) < kRim_mm) continue;
      if (y > 15) front += 1, front_x += x;
      if (x < -4) spread_minus += y * y;
      if (x > 4) spread_plus += y * y;
    }
  }
  const double cell = Relief::kCell_mm * Relief::kCell_mm;
  const double longer = std::sqrt(spread_minus * cell / minus) - std::sqrt(spread_plus * cell / plus);
  double score = 8 * (minus - plus) / (minus + plus) + longer / 1.5;
  if (front > 0) score -= front_x / front / 8;
  if (tuberosity) score += over_plateau(shape, *tuberosity).x() / 6;
  return score;
}

// Of the samples that `among` admits.
template <typename Predicate>
std::optional<Vector3d> furthest_of(const Shape& shape, const Vector3d& direction, Predicate among,
                                    double cap_mm = 1.0) {
  std::vector<Vector3d> found;
  for (const auto& s : shape.samples) {
    if (among(over_plateau(shape, s.point_mm))) found.push_back(s.point_mm);
  }
  return furthest(found, direction, kFine_mm2, cap_mm);
}

Matrix3d anatomical(const Shape& shape) {
  const Matrix3d& plateau = shape.plateau.bone_from_frame;
  const double slope = geometry::rad_from_deg(kPlateauSlope_deg);
  const Vector3d x = plateau.col(0);
  Vector3d z = std::cos(slope) * plateau.col(2) + std::sin(slope) * plateau.col(1);
  if (shape.shaft) {
    const Vector3d up = -shape.shaft->away();
    const double sigma = shaft_sigma_deg(shape.shaft->length_mm());
    const double weight = 1 / (sigma * sigma), usual = 1 / (kSlopeSigma_deg * kSlopeSigma_deg);
    z = (weight * (up - up.dot(x) * x).normalized() + usual * z).normalized();
  }
  Matrix3d axes;
  axes << x, z.cross(x), z;
  return axes;
}

std::optional<Shape> find_shape(const geometry::TriangleMesh& mesh, const geometry::Surface& surface,
                                const RoughFrame& rough, std::string& reason) {
  Shape shape;
  shape.rough = rough;
  auto plateau = find_plateau(surface, rough);
  if (plateau) {
    const auto shaft = find_long_axis(mesh, rough, plateau->origin_mm, -plateau->bone_from_frame.col(2),
                                      kShaftFrom_mm, kShaftFrom_mm + kShaftLength_mm);
    shape.forward = forward_score(plateau->relief, shaft_forward_mm(*plateau, shaft));
  }
  if (plateau && shape.forward < 0) {
    shape.rough.bone_from_frame.col(0) *= -1;
    shape.rough.bone_from_frame.col(1) *= -1;
    plateau = find_plateau(surface, shape.rough);
  }
  if (!plateau) {
    reason = "its joint's end has no plateau of two halves";
    return std::nullopt;
  }
  shape.plateau = *plateau;
  const Vector3d normal = shape.plateau.bone_from_frame.col(2);
  for (const auto& s : sample_surface(mesh, kFine_mm2)) {
    const bool is_cut = rough.cut_normal && s.normal.dot(*rough.cut_normal) > 0.7 &&
                        s.point_mm.dot(*rough.cut_normal) > rough.cut_offset_mm - 1.6;
    if (!is_cut && (s.point_mm - shape.plateau.origin_mm).dot(normal) > -80) shape.samples.push_back(s);
  }
  for (int round = 0; round < 3; ++round) {
    shape.axes = anatomical(shape);
    shape.shaft = find_long_axis(mesh, rough, shape.plateau.origin_mm, -shape.axes.col(2), kShaftFrom_mm,
                                 kShaftFrom_mm + kShaftLength_mm);
  }
  shape.axes = anatomical(shape);
  return shape;
}

// The top of the ridge on one side: the middle of what lies within 0.8 mm of the highest cell, near to it.
std::optional<Vector3d> eminence(const Shape& shape, double sign) {
  const Relief& relief = shape.plateau.relief;
  double highest = -1e9, at_x = 0, at_y = 0;
  const auto each = [&](const auto& visit) {
    for (int row = -16; row <= 12; ++row) {
      for (int column = 1; column * Relief::kCell_mm <= kMiddle_mm; ++column) {
        const int c = sign > 0 ? column : -column;
        visit(c * Relief::kCell_mm, row * Relief::kCell_mm, relief.at(c, row));
      }
    }
  };
  each([&](double x, double y, double height) {
    if (height > highest) highest = height, at_x = x, at_y = y;
  });
  if (highest < 2) return std::nullopt;
  Vector3d sum = Vector3d::Zero();
  double count = 0;
  each([&](double x, double y, double height) {
    if (height < highest - 0.8 || std::hypot(x - at_x, y - at_y) > 4) return;
    sum += Vector3d(x, y, height);
    count += 1;
  });
  return Vector3d(shape.plateau.origin_mm + shape.plateau.bone_from_frame * (sum / count));
}

std::optional<Vector3d> tuberosity_of(const Shape& shape) {
  const auto below = [](const Vector3d& q) {
    return std::abs(q.x()) < 18 && q.y() > 0 && q.z() < -kTuberosityFrom_mm && q.z() > -kTuberosityTo_mm;
  };
  return furthest_of(shape, shape.axes.col(1), below);
}

}  // namespace

Proposal propose_tibia(const geometry::TriangleMesh& mesh, const geometry::Surface& surface,
                       const ProposalOptions& options) {
  Proposal proposal;
  proposal.outcome = Proposal::Outcome::NotThisBone;
  proposal.reason.clear();
  std::optional<Shape> shape;
  proposal.reason = "the surface has no joint's end that comes near to its own mirror image";
  for (const RoughFrame& rough : rough_frames(mesh, surface, bones::BoneKind::Tibia, options.stop)) {
    if (options.stop.stop_requested()) break;
    shape = find_shape(mesh, surface, rough, proposal.reason);
    if (shape && (eminence(*shape, 1) || eminence(*shape, -1))) break;
    if (shape) proposal.reason = "between the halves of its joint's end stand no eminences";
    shape.reset();
  }
  if (!shape) return proposal;
  proposal.reason.clear();
  const auto tuberosity = tuberosity_of(*shape);
  const double score = side_score(*shape, tuberosity);
  if (std::abs(score) > kSureSide)
    proposal.side_by_shape = score > 0 ? bones::Side::Right : bones::Side::Left;
  const bones::Side side = options.side.value_or(score > 0 ? bones::Side::Right : bones::Side::Left);
  const double lateral = side == bones::Side::Right ? 1 : -1;
  const Matrix3d& axes = shape->axes;
  const auto on_plateau = [](const Vector3d& q) { return q.z() > kRim_mm && q.z() < 5; };
  Landmarks& marks = proposal.landmarks;
  const auto put = [&](const char* name, const std::optional<Vector3d>& at) {
    if (at) marks[name] = *at;
  };
  put("plateau_anterior", furthest_of(*shape, axes.col(1), on_plateau));
  put("plateau_posterior", furthest_of(*shape, -axes.col(1), on_plateau));
  // Side ends are flat: beside the halves' middles, so that the line through both runs straight across.
  const auto beside = [&](const Vector3d& q) { return on_plateau(q) && std::abs(q.y()) < kBeside_mm; };
  put("plateau_lateral", furthest_of(*shape, lateral * axes.col(0), beside, kSideEnd_mm));
  put("plateau_medial", furthest_of(*shape, -lateral * axes.col(0), beside, kSideEnd_mm));
  if (marks.size() < 4) {
    proposal.landmarks.clear();
    proposal.reason = "the plateau has no rim";
    return proposal;
  }
  proposal.outcome = Proposal::Outcome::Proposed;
  if (std::abs(shape->forward) < kSureForward)
    proposal.doubts.push_back(
        "front and back of the plateau look almost alike: they may be taken for each other");
  proposal.axes = {AnatomicalAxes::Origin::FromLandmarks, axes.col(1), axes.col(2), lateral * axes.col(0)};
  put("lateral_eminence", eminence(*shape, lateral));
  put("medial_eminence", eminence(*shape, -lateral));
  put("tuberosity", tuberosity);
  if (shape->shaft) {
    marks["shaft_proximal"] = shape->shaft->joint_end_mm;
    marks["shaft_distal"] = shape->shaft->far_end_mm;
  }
  return proposal;
}

}  // namespace arthronaut::landmarks
