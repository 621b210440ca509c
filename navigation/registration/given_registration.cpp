#include "navigation/registration/given_registration.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "planning/files/format.h"

namespace arthronaut::registration {

namespace {

// Signed, of the marker that lies best: of several on a body one may stand out from the bone.
double marker_off_bone_mm(const RegistrationSummary& given, const GivenUse& use) {
  const tools::WorldMarker* const world = use.tools.find_world_marker(use.kind);
  const geometry::RigidTransform bone_from_marker = given.marker_from_bone.inverse();
  double nearest_mm = std::numeric_limits<double>::infinity();
  for (const tools::BodyMarker& marker : tools::markers_of(world ? *world : tools::WorldMarker{})) {
    const double off_mm =
        use.bone.signed_distance_mm(bone_from_marker * marker.body_from_marker.translation_mm);
    if (std::abs(off_mm) < std::abs(nearest_mm)) nearest_mm = off_mm;
  }
  return nearest_mm;
}

// The error is convex over space: nowhere in the box is it larger than at a corner.
double largest_error_mm(const RegistrationSummary& given, const geometry::Bounds& box) {
  double largest_mm = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d at_mm = Eigen::Vector3d(corner & 1 ? box.max_mm.x() : box.min_mm.x(),
                                                  corner & 2 ? box.max_mm.y() : box.min_mm.y(),
                                                  corner & 4 ? box.max_mm.z() : box.min_mm.z());
    largest_mm = std::max(largest_mm, predicted_error_mm(given, at_mm));
  }
  return largest_mm;
}

}  // namespace

void judge_given(RegistrationSummary& given, const GivenUse& use) {
  if (!given.has_pose) return;
  const auto doubt = [&given](const std::string& reason) {
    given.reliable = false;
    given.reasons.push_back(reason);
  };
  const std::string bone(bones::to_text(use.kind));
  const double off_mm = marker_off_bone_mm(given, use);
  if (off_mm > (use.tools.tracker ? kFarthestOutside_mm : kFarthestMarker_mm))
    doubt(files::format("it puts the %s %.0f mm away from the marker that sits on it", bone.c_str(), off_mm));
  if (!use.tools.tracker && off_mm < -kDeepestMarker_mm)
    doubt(files::format("it puts the %s's marker %.0f mm inside the bone", bone.c_str(), -off_mm));
  if (given.rms_mm > kMaxError_mm)
    doubt(
        files::format("its points miss the bone by %.2f mm, more than %.1f mm", given.rms_mm, kMaxError_mm));
  if (given.predicted_tre_mm > kMaxError_mm)
    doubt(files::format("its predicted error is %.2f mm, more than %.1f mm", given.predicted_tre_mm,
                        kMaxError_mm));
  if (use.target_in_bone_mm) {
    const double at_entry_mm = predicted_error_mm(given, *use.target_in_bone_mm);
    if (at_entry_mm > kMaxError_mm && given.predicted_tre_mm <= kMaxError_mm)
      doubt(files::format("its predicted error at the planned entry is %.2f mm, more than %.1f mm",
                          at_entry_mm, kMaxError_mm));
  }
  // A target beside the bone is predicted worse than any place on it, and numbers are rounded.
  constexpr double kSlack = 2, kRounded_mm = 0.05;
  const double largest_mm = largest_error_mm(given, geometry::bounds_of(use.bone.mesh()));
  if (given.predicted_tre_mm > kSlack * largest_mm + kRounded_mm)
    doubt(files::format("it predicts an error of %.2f mm, and its covariance none above %.2f mm on the bone",
                        given.predicted_tre_mm, largest_mm));
}

}  // namespace arthronaut::registration
