#include "planning/tunnels/knee_pose.h"

#include <Eigen/Geometry>
#include <cmath>
#include <optional>

#include "planning/geometry/rigid_transform.h"
#include "planning/tunnels/place_checks.h"

namespace arthronaut::tunnels {

namespace {

using Eigen::Vector3d;

struct Condyles {
  Vector3d middle_mm, along;  // the hinge, or what is nearest to it
  double scale = 1;
};

std::optional<Condyles> condyles_of(const KneeSurroundings& knee) {
  if (knee.axis) return Condyles{knee.axis->point_mm, knee.axis->direction, knee.axis->scale()};
  // The roof of the notch runs past the condyles' centres some mm above them.
  const auto& marks = knee.femur_landmarks;
  const auto anterior = marks.find("blumensaat_anterior"), posterior = marks.find("blumensaat_posterior");
  if (anterior == marks.end() || posterior == marks.end()) return std::nullopt;
  return Condyles{0.5 * (anterior->second + posterior->second), knee.femur_axes->lateral};
}

}  // namespace

std::string why_apart(const KneeSurroundings& knee) {
  if (knee.is_of_two_frames) return "the images of the two are of different frames of reference";
  if (!knee.femur_axes || !knee.plateau_middle_mm) return "";
  const auto condyles = condyles_of(knee);
  if (!condyles) return "";
  const Vector3d from_condyles = (*knee.plateau_middle_mm - condyles->middle_mm) / condyles->scale;
  const double along_mm = from_condyles.dot(condyles->along);
  const Vector3d across = from_condyles - along_mm * condyles->along;
  const double flexed_deg = geometry::deg_from_rad(
      std::atan2(-across.dot(knee.femur_axes->anterior), -across.dot(knee.femur_axes->proximal)));
  const bool is_within = std::abs(along_mm) <= kFurthestAlong_mm && across.norm() >= kNearestAcross_mm &&
                         across.norm() <= kFurthestAcross_mm && flexed_deg >= kMostExtended_deg &&
                         flexed_deg <= kMostFlexed_deg;
  if (!is_within) {
    const auto& axes = *knee.femur_axes;
    const Vector3d off_mm = *knee.plateau_middle_mm - condyles->middle_mm;
    const auto part = [&](const Vector3d& axis, const char* forth, const char* back) {
      const double mm = off_mm.dot(axis);
      return limit_text(std::round(std::abs(mm)), "mm") + " " + (mm < 0 ? back : forth);
    };
    return "the plateau's middle lies " + part(axes.proximal, "above", "below") + ", " +
           part(axes.anterior, "in front of", "behind") + " and " + part(axes.lateral, "lateral", "medial") +
           " of the condyles' middle";
  }
  if (knee.tibia_axes) {
    const double turned_deg = geometry::deg_from_rad(
        geometry::angle_between_rad(knee.femur_axes->lateral, knee.tibia_axes->lateral));
    if (turned_deg > kMostTurned_deg)
      return "the tibia is turned against the femur by " + limit_text(std::round(turned_deg), "deg");
  }
  return "";
}

}  // namespace arthronaut::tunnels
