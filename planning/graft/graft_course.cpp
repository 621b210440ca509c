#include "planning/graft/graft_course.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "planning/geometry/error.h"

namespace arthronaut::graft {

namespace {

using Eigen::Vector3d;

void check(const FlexionRange& range) {
  if (!(range.to_deg >= 0 && range.to_deg <= 160))
    throw InvalidInput("flexion: to_deg must lie from 0 to 160");
  if (!(range.step_deg >= 0.5)) throw InvalidInput("flexion: step_deg must be 0.5 or more");
}

// The last one is the range's end, whatever the step.
std::vector<double> flexions_deg(const FlexionRange& range) {
  std::vector<double> flexions;
  for (double at = 0; at < range.to_deg - 1e-9; at += range.step_deg) flexions.push_back(at);
  flexions.push_back(range.to_deg);
  return flexions;
}

}  // namespace

GraftCourse graft_course(const GraftEnd& femur, const GraftEnd& tibia, const FlexionAxis& axis,
                         const FlexionRange& range) {
  check(range);
  GraftCourse course;
  course.shortest_mm = std::numeric_limits<double>::infinity();
  for (const double flexion_deg : flexions_deg(range)) {
    const auto turned = femur_from_tibia(axis, geometry::rad_from_deg(flexion_deg));
    const Vector3d graft = femur.opening_mm - turned * tibia.opening_mm;
    const Vector3d out_of_tibia = -(turned.rotation * tibia.into_bone);
    GraftState state{.flexion_deg = flexion_deg, .length_mm = graft.norm()};
    if (state.length_mm > 0) {
      state.femoral_bend_deg = geometry::deg_from_rad(geometry::angle_between_rad(graft, femur.into_bone));
      state.tibial_bend_deg = geometry::deg_from_rad(geometry::angle_between_rad(graft, out_of_tibia));
    }
    course.shortest_mm = std::min(course.shortest_mm, state.length_mm);
    if (state.length_mm > course.longest_mm) {
      course.longest_mm = state.length_mm;
      course.longest_at_deg = flexion_deg;
    }
    course.greatest_femoral_bend_deg = std::max(course.greatest_femoral_bend_deg, state.femoral_bend_deg);
    course.greatest_tibial_bend_deg = std::max(course.greatest_tibial_bend_deg, state.tibial_bend_deg);
    course.states.push_back(state);
  }
  return course;
}

}  // namespace arthronaut::graft
