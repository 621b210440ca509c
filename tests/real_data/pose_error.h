// How far a pose is from the truth, and what it took.
#pragma once

#include <ctime>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::real_data {

struct PoseError {
  double rotation_deg = 0, translation_mm = 0;
  // Not inexact but something else.
  [[nodiscard]] bool is_wrong() const { return rotation_deg > 5 || translation_mm > 1; }
};
[[nodiscard]] inline PoseError pose_error(const geometry::RigidTransform& measured,
                                          const geometry::RigidTransform& truth) {
  return {
      geometry::deg_from_rad(geometry::rotation_angle_rad(measured.rotation.conjugate() * truth.rotation)),
      (measured.translation_mm - truth.translation_mm).norm()};
}

// Processor time of this thread in ms: what a quiet core would take, whatever else the machine does.
[[nodiscard]] inline double thread_cpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

}  // namespace arthronaut::real_data
