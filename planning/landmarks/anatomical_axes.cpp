#include "planning/landmarks/anatomical_axes.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::landmarks {

namespace {

using Eigen::Vector3d;

constexpr double kLeastElongation = 1.6;  // of variances, along the shaft and across it
constexpr double kLeastCosine = 0.5;      // to the scanner's axis of the same name

std::optional<Vector3d> find(const Landmarks& landmarks, const char* name) {
  const auto found = landmarks.find(name);
  return found == landmarks.end() ? std::nullopt : std::optional(found->second);
}

// Unit, from one landmark to the other; empty when one is missing or they lie closer than 5 mm.
std::optional<Vector3d> between(const std::optional<Vector3d>& from, const std::optional<Vector3d>& to) {
  constexpr double kLeastLength_mm = 5;
  if (!from || !to || (*to - *from).norm() < kLeastLength_mm) return std::nullopt;
  return Vector3d((*to - *from).normalized());
}

// The part of `v` across the unit vector `line`, unit; empty where hardly any is left.
std::optional<Vector3d> laid_across(const Vector3d& v, const Vector3d& line) {
  const Vector3d across = v - v.dot(line) * line;
  if (across.norm() < kLeastCosine) return std::nullopt;
  return Vector3d(across.normalized());
}

std::optional<Vector3d> middle(const std::optional<Vector3d>& a, const std::optional<Vector3d>& b) {
  if (!a || !b) return std::nullopt;
  return Vector3d((*a + *b) / 2);
}

// Of the surface's area, so that it does not matter how finely a part of it is triangulated.
struct Moments {
  double area = 0;
  Vector3d mean = Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  // about the origin, by area
};
std::optional<Moments> moments_of(const geometry::TriangleMesh& mesh) {
  Moments of;
  for (const auto& triangle : mesh.triangles) {
    const auto corner = [&](std::size_t k) -> const Vector3d& {
      return mesh.vertices_mm[static_cast<std::size_t>(triangle[k])];
    };
    const double area = 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
    const Vector3d center = (corner(0) + corner(1) + corner(2)) / 3;
    of.area += area;
    of.mean += area * center;
    // The second moment of a triangle: its corners' and nine times its centre's, over twelve.
    of.second += area / 12 *
                 (corner(0) * corner(0).transpose() + corner(1) * corner(1).transpose() +
                  corner(2) * corner(2).transpose() + 9 * center * center.transpose());
  }
  if (!(of.area > 0)) return std::nullopt;
  of.mean /= of.area;
  of.second /= of.area;
  return of;
}

// The longest principal axis of the surface, towards the head.
std::optional<Vector3d> shaft_of(const std::optional<Moments>& surface) {
  if (!surface) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(surface->second -
                                                                 surface->mean * surface->mean.transpose());
  if (!(principal.eigenvalues()[2] > kLeastElongation * principal.eigenvalues()[1])) return std::nullopt;
  const Vector3d longest = principal.eigenvectors().col(2);
  return longest.z() < 0 ? Vector3d(-longest) : longest;
}

// Right-handed for a left knee's (anterior, lateral, proximal), left-handed for a right one's: the third axis
// follows from two and the side.
Vector3d anterior_of(const Vector3d& proximal, const Vector3d& lateral, bones::Side side) {
  return side == bones::Side::Right ? Vector3d(proximal.cross(lateral)) : Vector3d(lateral.cross(proximal));
}

AnatomicalAxes axes_from(AnatomicalAxes::Origin origin, const Vector3d& proximal, const Vector3d& lateral,
                         bones::Side side) {
  return {origin, anterior_of(proximal, lateral, side), proximal, lateral};
}

bool agrees(const AnatomicalAxes& axes, const AnatomicalAxes& scanner) {
  return axes.anterior.dot(scanner.anterior) > kLeastCosine &&
         axes.proximal.dot(scanner.proximal) > kLeastCosine &&
         axes.lateral.dot(scanner.lateral) > kLeastCosine;
}

// The landmarks of the shaft, laid across `lateral`.
std::optional<Vector3d> along_shaft(const Landmarks& landmarks, const Vector3d& lateral) {
  const auto shaft = between(find(landmarks, "shaft_distal"), find(landmarks, "shaft_proximal"));
  return shaft ? laid_across(*shaft, lateral) : std::nullopt;
}

// The long axis across `lateral`: what the joint's end says, and the landmarks of the shaft as far as they
// lie apart.
std::optional<Vector3d> long_axis(const std::optional<Vector3d>& by_joint, double joint_sigma_deg,
                                  const Landmarks& landmarks, const Vector3d& lateral) {
  const auto by_shaft = along_shaft(landmarks, lateral);
  if (!by_shaft) return by_joint;
  if (!by_joint) return by_shaft;
  const double sigma =
      shaft_sigma_deg((landmarks.at("shaft_proximal") - landmarks.at("shaft_distal")).norm());
  const double weight = 1 / (sigma * sigma), joint_weight = 1 / (joint_sigma_deg * joint_sigma_deg);
  return Vector3d((weight * *by_shaft + joint_weight * *by_joint).normalized());
}

std::optional<AnatomicalAxes> from_landmarks(bones::BoneKind bone, bones::Side side,
                                             const Landmarks& landmarks,
                                             const std::optional<Vector3d>& shaft) {
  const bool is_femur = bone == bones::BoneKind::Femur;
  std::optional<Vector3d> medial, outer;
  for (const char* part : is_femur ? std::array{"condyle_center", "epicondyle", "condyle_posterior"}
                                   : std::array{"plateau", "plateau", "plateau"}) {
    const std::string name = part;
    medial = find(landmarks, (is_femur ? "medial_" + name : name + "_medial").c_str());
    outer = find(landmarks, (is_femur ? "lateral_" + name : name + "_lateral").c_str());
    if (medial && outer) break;
  }
  const auto lateral = between(medial, outer);
  if (!lateral) return std::nullopt;
  // Of an anterior direction in the joint, the proximal one at right angles to it.
  const auto above = [&](const std::optional<Vector3d>& forward) -> std::optional<Vector3d> {
    const auto anterior = forward ? laid_across(*forward, *lateral) : std::nullopt;
    if (!anterior) return std::nullopt;
    return side == bones::Side::Right ? Vector3d(lateral->cross(*anterior))
                                      : Vector3d(anterior->cross(*lateral));
  };
  const auto turned = [&](const Vector3d& proximal, double forward_deg) {
    const double angle = geometry::rad_from_deg(forward_deg);
    return Vector3d(std::cos(angle) * proximal + std::sin(angle) * anterior_of(proximal, *lateral, side));
  };
  std::optional<Vector3d> by_joint;
  double sigma_deg = kRoofSigma_deg;
  if (is_femur) {
    // Blumensaat's line runs forwards and, by 90 - 37 degrees, downwards.
    const auto roof =
        above(between(find(landmarks, "blumensaat_posterior"), find(landmarks, "blumensaat_anterior")));
    if (roof) by_joint = turned(*roof, -(90 - kRoofSlope_deg));
    const auto behind =
        middle(find(landmarks, "medial_condyle_posterior"), find(landmarks, "lateral_condyle_posterior"));
    const auto ahead = middle(find(landmarks, "medial_epicondyle"), find(landmarks, "lateral_epicondyle"));
    if (!by_joint) by_joint = above(between(behind, ahead));
  } else {
    sigma_deg = kSlopeSigma_deg;
    const auto plateau =
        above(between(find(landmarks, "plateau_posterior"), find(landmarks, "plateau_anterior")));
    if (plateau) by_joint = turned(*plateau, kPlateauSlope_deg);
  }
  // Medial and lateral mixed up turn over what the joint's end says and leave the shaft as it is: believing
  // the shaft would leave the bone upright, and every other word mirrored.
  const auto by_shaft = along_shaft(landmarks, *lateral);
  if (by_joint && by_shaft && by_joint->dot(*by_shaft) < kLeastCosine) return std::nullopt;
  auto proximal = long_axis(by_joint, sigma_deg, landmarks, *lateral);
  if (!proximal) proximal = laid_across(shaft.value_or(Vector3d::UnitZ()), *lateral);
  if (!proximal) return std::nullopt;
  return axes_from(AnatomicalAxes::Origin::FromLandmarks, *proximal, *lateral, side);
}

// Mixed-up landmarks turn a bone over: then most of it lies on the wrong side of its joint. Without a mesh,
// only the scanner is left to compare with.
bool is_upright(const AnatomicalAxes& axes, bones::BoneKind bone, bones::Side side,
                const Landmarks& landmarks, const std::optional<Moments>& surface) {
  if (!surface) return agrees(axes, scanner_axes(side));
  const bool is_femur = bone == bones::BoneKind::Femur;
  std::optional<Vector3d> joint;
  for (const char* part : {"condyle_posterior", "condyle_center", "epicondyle"}) {
    if (is_femur && !joint) {
      joint = middle(find(landmarks, (std::string("medial_") + part).c_str()),
                     find(landmarks, (std::string("lateral_") + part).c_str()));
    }
  }
  if (!is_femur) joint = middle(find(landmarks, "plateau_medial"), find(landmarks, "plateau_lateral"));
  if (!joint) return agrees(axes, scanner_axes(side));
  return (is_femur ? 1 : -1) * (surface->mean - *joint).dot(axes.proximal) > 0;
}

}  // namespace

double shaft_sigma_deg(double length_mm) {
  constexpr double kStraight_deg = 2.5, kOverLength_deg_mm = 70;
  return std::hypot(kStraight_deg, kOverLength_deg_mm / length_mm);
}

std::string_view to_text(AnatomicalAxes::Origin origin) {
  switch (origin) {
    case AnatomicalAxes::Origin::FromLandmarks:
      return "the bone's landmarks";
    case AnatomicalAxes::Origin::FromShaft:
      return "the bone's shaft";
    case AnatomicalAxes::Origin::FromScanner:
      return "the scanner's axes";
  }
  return "unknown";
}

AnatomicalAxes scanner_axes(bones::Side side) {
  return axes_from(AnatomicalAxes::Origin::FromScanner, Vector3d::UnitZ(),
                   side == bones::Side::Right ? Vector3d(-Vector3d::UnitX()) : Vector3d::UnitX(), side);
}

AnatomicalAxes anatomical_axes(bones::BoneKind bone, bones::Side side, const Landmarks& landmarks,
                               const geometry::TriangleMesh& mesh) {
  const AnatomicalAxes scanner = scanner_axes(side);
  const std::optional<Moments> surface = moments_of(mesh);
  const std::optional<Vector3d> shaft = shaft_of(surface);
  const std::optional<AnatomicalAxes> named = from_landmarks(bone, side, landmarks, shaft);
  if (named && is_upright(*named, bone, side, landmarks, surface)) return *named;
  if (!shaft) return scanner;
  const std::optional<Vector3d> lateral = laid_across(scanner.lateral, *shaft);
  if (!lateral) return scanner;
  const AnatomicalAxes by_shape = axes_from(AnatomicalAxes::Origin::FromShaft, *shaft, *lateral, side);
  return agrees(by_shape, scanner) ? by_shape : scanner;
}

std::string_view to_text(AnatomicalDirection direction, bool is_positive) {
  switch (direction) {
    case AnatomicalDirection::Anterior:
      return is_positive ? "anterior" : "posterior";
    case AnatomicalDirection::Proximal:
      return is_positive ? "proximal" : "distal";
    case AnatomicalDirection::Lateral:
      return is_positive ? "lateral" : "medial";
  }
  return "unknown";
}

PlaneAxes axes_across(const AnatomicalAxes& axes, const Vector3d& line) {
  const double along_anterior = std::abs(axes.anterior.dot(line)),
               along_proximal = std::abs(axes.proximal.dot(line)),
               along_lateral = std::abs(axes.lateral.dot(line));
  PlaneAxes plane;
  Vector3d up = axes.proximal, side = axes.anterior;
  if (along_proximal >= along_anterior && along_proximal >= along_lateral) {
    plane.up_is = AnatomicalDirection::Anterior;
    up = axes.anterior;
    plane.side_is = AnatomicalDirection::Lateral;
    side = axes.lateral;
  } else if (along_anterior >= along_lateral) {
    plane.side_is = AnatomicalDirection::Lateral;
    side = axes.lateral;
  }
  plane.up = (up - up.dot(line) * line).normalized();
  plane.side = line.cross(plane.up);
  if (plane.side.dot(side) < 0) plane.side = -plane.side;
  return plane;
}

}  // namespace arthronaut::landmarks
