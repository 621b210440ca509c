// A pose that knows when it was true, whether it is valid, and how wrong it may be. Every pose that crosses a
// module's border in the operation is one of these; a bare RigidTransform is for things that do not move.
#pragma once

#include <cstdint>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::geometry {

struct TrackedPose {
  RigidTransform target_from_source;
  std::int64_t timestamp_ns = 0;  // of the frame it was measured in
  bool is_valid = false;          // false: everything else here is meaningless and must not be shown
  // Covariance of the body-frame twist (v mm, w rad) of T * exp(d).
  Matrix6d covariance = Matrix6d::Zero();

  // A pose older than max_age_ns is stale: as good as none.
  [[nodiscard]] bool is_usable_at(std::int64_t now_ns, std::int64_t max_age_ns) const {
    return is_valid && now_ns - timestamp_ns >= 0 && now_ns - timestamp_ns <= max_age_ns;
  }
};

// middle_from_source seen from target: both must be valid and of the same instant, else the result is
// invalid. First-order covariance, errors independent: S = Ad(B^-1) S_A Ad(B^-1)^T + S_B for A * B.
[[nodiscard]] TrackedPose compose(const TrackedPose& target_from_middle,
                                  const TrackedPose& middle_from_source);
[[nodiscard]] TrackedPose inverse(const TrackedPose& target_from_source);

}  // namespace arthronaut::geometry
