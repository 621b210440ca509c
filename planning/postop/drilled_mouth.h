// Whether a bore opens through the bone's surface. Inner header of postop.
#pragma once

#include <optional>

#include "planning/geometry/rigid_transform.h"
#include "planning/geometry/surface.h"
#include "planning/images/volume_sampler.h"

namespace arthronaut::postop {

// Where a line runs within the bone.
struct Passage {
  Eigen::Vector3d entry_mm, exit_mm;
  double square_cos = 1;  // of the line to the surface's normal at the entry
  [[nodiscard]] double length_mm() const { return (exit_mm - entry_mm).norm(); }
  // By how many times an entry is farther off than its line is across itself, rms: in one of the two
  // directions across the surface slants away. More than 10 times is not told.
  [[nodiscard]] double entry_per_across() const;
};
// The line's entry into the bone that is nearest to `near_mm`, and the next exit. nullopt when it does not
// enter within 10 mm of it.
[[nodiscard]] std::optional<Passage> passage_of(const geometry::Surface& bone, const Eigen::Vector3d& near_mm,
                                                const Eigen::Vector3d& direction);

inline constexpr double kLeastOpen = 0.75, kLeastClosed = 0.6, kLeastCortex_hu = 150;

struct SeenMouth {
  double open_share = 0;    // of the bore's opening: no cortex under the bone's surface, or metal
  double closed_share = 0;  // of what lies 0.8 to 2.4 mm beside it: there is cortex
  double step_hu = 0;       // of the cortex beside it above what lies outside

  [[nodiscard]] bool is_open() const {
    return open_share >= kLeastOpen && closed_share >= kLeastClosed && step_hu >= kLeastCortex_hu;
  }
};

// `place_mm`: on the bone's surface. `inward`: unit, along the bore into the bone.
[[nodiscard]] SeenMouth mouth_at(const images::VolumeSampler& postop,
                                 const geometry::RigidTransform& postop_from_plan,
                                 const geometry::Surface& bone, const Eigen::Vector3d& place_mm,
                                 const Eigen::Vector3d& inward, double radius_mm);

}  // namespace arthronaut::postop
