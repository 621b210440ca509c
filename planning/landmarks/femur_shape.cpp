#include "planning/landmarks/femur_shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "planning/files/format.h"
#include "planning/geometry/rigid_transform.h"
#include "planning/geometry/surface.h"
#include "planning/landmarks/condyles.h"
#include "planning/landmarks/long_axis.h"
#include "planning/landmarks/notch.h"
#include "planning/landmarks/rough_frame.h"
#include "planning/landmarks/shape_samples.h"

namespace arthronaut::landmarks {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kJointEnd_mm = 75;
// Of a tip: how far back of it counts. Backs of condyles are flat, and an extent is one along its own
// direction alone.
constexpr double kEpicondyle_mm = 0.5, kExtent_mm = 2;
// The shaft begins above the condyles by this share of their depth; it is straight for so far (the femur is
// bowed).
constexpr double kShaftFrom = 0.78, kShaftLength_mm = 110;

struct Shape {
  RoughFrame rough;
  std::vector<SurfaceSample> samples;
  double each_mm2 = kCoarse_mm2;  // of the samples
  // Upright by the roof of the notch alone: where landmarks lie does not depend on how much of the shaft is
  // there.
  Condyles condyles;
  Notch notch;
  std::optional<LongAxis> shaft;
  Matrix3d axes = Matrix3d::Identity();  // anatomical, with the shaft: x right, y anterior, z proximal
  std::stop_token stop;
};

double lowest(const Shape& shape, const Vector3d& z) {
  return (shape.condyles.distal_minus.dot(z) + shape.condyles.distal_plus.dot(z)) / 2;
}

// Proximal in the lateral view, as far as the roof of the notch tells it.
Vector3d proximal_by_roof(const Shape& shape) {
  const Vector3d forward = shape.notch.roof;
  const Vector3d into_bone =
      (shape.notch.flat.into_bone - shape.notch.flat.into_bone.dot(forward) * forward).normalized();
  const double slope = geometry::rad_from_deg(kRoofSlope_deg);
  return -std::cos(slope) * forward + std::sin(slope) * into_bone;
}

// The same with the shaft, as far as there is one.
Vector3d proximal_of(const Shape& shape) {
  const Vector3d x = shape.condyles.bone_from_frame.col(0), by_roof = proximal_by_roof(shape);
  if (!shape.shaft) return by_roof;
  const Vector3d away = shape.shaft->away();
  const Vector3d by_shaft = (away - away.dot(x) * x).normalized();
  const double sigma = shaft_sigma_deg(shape.shaft->length_mm());
  const double weight = 1 / (sigma * sigma), roof_weight = 1 / (kRoofSigma_deg * kRoofSigma_deg);
  return (weight * by_shaft + roof_weight * by_roof).normalized();
}

std::optional<LongAxis> find_shaft(const Shape& shape, const geometry::TriangleMesh& mesh) {
  const Condyles& condyles = shape.condyles;
  const Vector3d z = shape.axes.col(2);
  const Vector3d foot = condyles.center_mm + (lowest(shape, z) - condyles.center_mm.dot(z)) * z;
  const double first = kShaftFrom * condyles.depth_mm;
  return find_long_axis(mesh, shape.rough, foot, z, first, first + kShaftLength_mm);
}

// Condyles and notch in turn, until they agree: each as the other lets it be seen, and without the shaft, of
// which more or less may be there.
bool refine(Shape& shape, const geometry::Surface& surface, Matrix3d axes, Vector3d origin,
            std::string& reason) {
  constexpr int kRounds = 5;
  constexpr double kSettled = 0.001;  // of the axes' directions
  for (int round = 0; round < kRounds; ++round) {
    if (shape.stop.stop_requested()) return false;
    const auto condyles = find_condyles(shape.samples, shape.each_mm2, axes, origin);
    if (!condyles) {
      reason = "it has no two condyles at its joint's end";
      return false;
    }
    shape.condyles = *condyles;
    const auto notch = find_notch(surface, *condyles);
    if (!notch) {
      reason = "between its condyles is no notch with a roof";
      return false;
    }
    shape.notch = *notch;
    const Matrix3d before = axes;
    axes.col(0) = condyles->bone_from_frame.col(0);
    axes.col(2) = proximal_by_roof(shape);
    axes.col(1) = axes.col(2).cross(axes.col(0));
    origin = condyles->center_mm;
    if ((axes - before).norm() < kSettled) break;
  }
  return true;
}

void take_samples(Shape& shape, const geometry::TriangleMesh& mesh, double each_mm2) {
  const RoughFrame& rough = shape.rough;
  const Vector3d z = rough.bone_from_frame.col(2);
  shape.each_mm2 = each_mm2;
  shape.samples.clear();
  for (const auto& s : sample_surface(mesh, each_mm2)) {
    const bool is_cut = rough.cut_normal && s.normal.dot(*rough.cut_normal) > 0.7 &&
                        s.point_mm.dot(*rough.cut_normal) > rough.cut_offset_mm - 1.6;
    if (!is_cut && (s.point_mm - rough.origin_mm).dot(z) < kJointEnd_mm) shape.samples.push_back(s);
  }
}

std::optional<Shape> find_shape(const geometry::TriangleMesh& mesh, const geometry::Surface& surface,
                                const RoughFrame& rough, const std::stop_token& stop, std::string& reason) {
  Shape shape;
  shape.rough = rough;
  shape.stop = stop;
  take_samples(shape, mesh, kCoarse_mm2);
  // A slanting cut misleads about the long axis: the joint's end is looked at from in front and from behind,
  // too, and of what is found there the roof is taken that the outline shows best.
  std::optional<Shape> best;
  std::string reason_of_last;
  for (const double lean_deg : {0.0, 15.0, -15.0, 30.0, -30.0}) {
    if (std::abs(lean_deg) > 20 && best) break;
    const Eigen::AngleAxisd lean(geometry::rad_from_deg(lean_deg), Vector3d::UnitX());
    if (refine(shape, surface, rough.bone_from_frame * lean, rough.origin_mm, reason_of_last) &&
        (!best || shape.notch.cost < best->notch.cost))
      best = shape;
  }
  if (best) {
    take_samples(*best, mesh, kFine_mm2);
    const Condyles found = best->condyles;
    if (!refine(*best, surface, found.bone_from_frame, found.center_mm, reason_of_last)) best.reset();
  }
  if (!best) {
    reason = reason_of_last;
    return std::nullopt;
  }
  best->axes = best->condyles.bone_from_frame;
  for (int round = 0; round < 3; ++round) {
    best->shaft = find_shaft(*best, mesh);
    best->axes.col(2) = proximal_of(*best);
    best->axes.col(1) = best->axes.col(2).cross(best->axes.col(0));
  }
  return best;
}

// Positive: lateral is +x. The shaft stands lateral of the condyles' middle and leans that way, and the
// lateral flank of the groove reaches further forward.
double side_score(const Shape& shape, const geometry::TriangleMesh& mesh) {
  const Matrix3d& axes = shape.axes;
  const Vector3d x = axes.col(0), z = axes.col(2);
  const double low = lowest(shape, z), depth = shape.condyles.depth_mm;
  double front_minus = -1e9, front_plus = -1e9;
  for (const auto& s : shape.samples) {
    const Vector3d q = axes.transpose() * (s.point_mm - shape.condyles.center_mm);
    if (s.point_mm.dot(z) - low > 0.6 * depth) continue;
    if (q.x() > 4) front_plus = std::max(front_plus, q.y());
    if (q.x() < -4) front_minus = std::max(front_minus, q.y());
  }
  const Vector3d foot = shape.condyles.center_mm + (low - shape.condyles.center_mm.dot(z)) * z;
  const double last = std::min(0.75 * depth, whole_until(mesh, shape.rough, foot, z)), first = 0.55 * depth;
  double beside = 0, count = 0;
  if (last > first) {
    for (const auto& section :
         sections_across(mesh, z, low + first, 2, static_cast<std::size_t>((last - first) / 2) + 1)) {
      if (section.area_mm2 > 50) beside += (section.center_mm - shape.condyles.center_mm).dot(x), count += 1;
    }
  }
  double score = (front_plus - front_minus) / 4;
  if (count > 0) score += beside / count / 1.5;
  if (shape.shaft && shape.shaft->length_mm() > 15) score += shape.shaft->away().dot(x) / 0.1;
  return score;
}

// The outermost part about the condyles' centres.
std::optional<Vector3d> epicondyle(const Shape& shape, double sign) {
  const Matrix3d& axes = shape.condyles.bone_from_frame;
  const double depth = shape.condyles.depth_mm;
  std::vector<Vector3d> found;
  for (const auto& s : shape.samples) {
    const Vector3d q = axes.transpose() * (s.point_mm - shape.condyles.center_mm);
    // The articular margin, where osteophytes stand out further, lies below and behind.
    if (std::abs(q.y()) < 0.25 * depth && q.z() > -0.08 * depth && q.z() < 0.3 * depth)
      found.push_back(s.point_mm);
  }
  return furthest(found, sign * axes.col(0), shape.each_mm2, kEpicondyle_mm);
}

// Where the outline of one condyle below the line reaches furthest along `direction`.
std::optional<Vector3d> extent(const Shape& shape, const BlumensaatLine& line, double sign,
                               const Vector3d& direction) {
  const Vector3d x = shape.condyles.bone_from_frame.col(0);
  std::vector<Vector3d> found;
  for (const auto& s : shape.samples) {
    const Vector3d from_roof = s.point_mm - line.anterior_mm;
    if (sign * from_roof.dot(x) > 0 && from_roof.dot(line.into_bone) < 0) found.push_back(s.point_mm);
  }
  return furthest(found, direction, shape.each_mm2, kExtent_mm);
}

// Blumensaat's line, and how far the lateral condyle reaches along it and away from it. lateral: 1 where that
// is +x.
void put_roof(const Shape& shape, const BlumensaatLine& line, double lateral, Landmarks& marks) {
  marks["blumensaat_anterior"] = line.anterior_mm;
  marks["blumensaat_posterior"] = line.posterior_mm;
  const auto put = [&](const char* name, const std::optional<Vector3d>& at) {
    if (at) marks[name] = *at;
  };
  put("lateral_condyle_deep", extent(shape, line, lateral, -line.forward));
  put("lateral_condyle_shallow", extent(shape, line, lateral, line.forward));
  put("lateral_condyle_low", extent(shape, line, lateral, -line.into_bone));
}

}  // namespace

Proposal propose_femur(const geometry::TriangleMesh& mesh, const geometry::Surface& surface,
                       const ProposalOptions& options) {
  Proposal proposal;
  proposal.outcome = Proposal::Outcome::NotThisBone;
  proposal.reason.clear();
  std::optional<Shape> shape;
  proposal.reason =
      "the surface has no joint's end that comes near to its own mirror image; is it cut off through the "
      "joint's end?";
  for (const RoughFrame& rough : rough_frames(mesh, surface, bones::BoneKind::Femur, options.stop)) {
    shape = find_shape(mesh, surface, rough, options.stop, proposal.reason);
    if (shape) break;
  }
  if (!shape) return proposal;
  proposal.reason.clear();
  proposal.outcome = Proposal::Outcome::Proposed;
  const double score = side_score(*shape, mesh);
  if (std::abs(score) > 0.5) proposal.side_by_shape = score > 0 ? bones::Side::Right : bones::Side::Left;
  const bones::Side side = options.side.value_or(score > 0 ? bones::Side::Right : bones::Side::Left);
  const double lateral = side == bones::Side::Right ? 1 : -1;
  const Matrix3d& axes = shape->axes;
  proposal.axes = {AnatomicalAxes::Origin::FromLandmarks, axes.col(1), axes.col(2), lateral * axes.col(0)};
  const bool is_plus = lateral > 0;
  const Condyles& condyles = shape->condyles;
  Landmarks& marks = proposal.landmarks;
  const bool by_ends = options.roof == RoofConvention::Ends;
  put_roof(*shape, by_ends ? shape->notch.ends : shape->notch.flat, lateral, marks);
  put_roof(*shape, by_ends ? shape->notch.flat : shape->notch.ends, lateral, proposal.by_other_roof);
  marks["notch_apex"] = shape->notch.apex_mm;
  marks["lateral_condyle_posterior"] = is_plus ? condyles.posterior_plus : condyles.posterior_minus;
  marks["medial_condyle_posterior"] = is_plus ? condyles.posterior_minus : condyles.posterior_plus;
  marks["lateral_condyle_center"] =
      condyles.center_mm +
      (marks["lateral_condyle_posterior"] - condyles.center_mm).dot(axes.col(0)) * axes.col(0);
  marks["medial_condyle_center"] =
      condyles.center_mm +
      (marks["medial_condyle_posterior"] - condyles.center_mm).dot(axes.col(0)) * axes.col(0);
  const auto put = [&](const char* name, const std::optional<Vector3d>& at) {
    if (at) marks[name] = *at;
  };
  put("lateral_epicondyle", epicondyle(*shape, lateral));
  put("medial_epicondyle", epicondyle(*shape, -lateral));
  if (shape->shaft) {
    marks["shaft_distal"] = shape->shaft->joint_end_mm;
    marks["shaft_proximal"] = shape->shaft->far_end_mm;
  }
  proposal.roof = shape->notch.shape;
  proposal.hill_mm = shape->notch.hill_mm;
  return proposal;
}

}  // namespace arthronaut::landmarks
