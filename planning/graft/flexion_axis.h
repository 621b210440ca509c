// How the tibia moves about the femur, as far as planning needs it: a hinge.
//
// The model: the tibia turns about one axis that is fixed in the femur, through the centres of the posterior
// condyles, from 0 (the knee as it was imaged, taken for full extension) to 120 deg. Both bones lie in the
// same frame of the case (LPS), as imaged. What it leaves out: the lateral condyle rolls back by 10 to 20 mm
// in deep flexion, the tibia turns inwards by up to 20 deg, mostly within the first 20 deg, and loads move it
// by mm. Lengths over flexion are therefore good for comparing entries with each other, not for the last mm
// of one; where the images were taken in some flexion, the angle counts from there.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>

#include "planning/geometry/rigid_transform.h"
#include "planning/geometry/triangle_mesh.h"
#include "planning/landmarks/anatomical_axes.h"
#include "planning/landmarks/landmarks.h"

namespace arthronaut::graft {

struct FlexionAxis {
  // The best first. Epicondyles: the transepicondylar axis, 2 to 6 deg off the condyles' own.
  enum class Origin { CondyleCenters, PosteriorCondyles, Epicondyles } origin = Origin::Epicondyles;
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();  // half way between the condyles, bone frame
  // Unit: turning by a positive angle about it, right-handed, flexes the knee. It points to the patient's
  // left.
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();
  // Between the condyles' centres: how large the knee is. Of an average one where the epicondyles, which
  // stand further apart, are all that is known.
  static constexpr double kAverageApart_mm = 48;
  double condyles_apart_mm = kAverageApart_mm;
  [[nodiscard]] double scale() const { return condyles_apart_mm / kAverageApart_mm; }
};
[[nodiscard]] std::string_view to_text(FlexionAxis::Origin origin);

// By the first that is there: lateral_condyle_center and medial_condyle_center; spheres fitted to the femur's
// surface within 12 mm of lateral_condyle_posterior and medial_condyle_posterior, where both have radii of 10
// to 35 mm; the epicondyles. The axes tell which way is flexion. nullopt when none is there, or two points
// lie closer than 20 mm.
[[nodiscard]] std::optional<FlexionAxis> flexion_axis(const landmarks::Landmarks& femur_landmarks,
                                                      const geometry::TriangleMesh& femur,
                                                      const landmarks::AnatomicalAxes& axes);

// Takes a point of the extended tibia to where it is at a flexion, both in the femur's frame.
[[nodiscard]] geometry::RigidTransform femur_from_tibia(const FlexionAxis& axis, double flexion_rad);

}  // namespace arthronaut::graft
