// A graft between two tunnels' openings: its length and how sharply it bends at either, over flexion.
//
// The graft is a straight string between the two openings' middles. It does not wrap around the posterior
// cruciate ligament or the notch, so that a real graft is a little longer.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "planning/graft/flexion_axis.h"

namespace arthronaut::graft {

// Where a graft leaves a bone: the opening in the joint and the tunnel's direction from there into the bone,
// unit.
struct GraftEnd {
  Eigen::Vector3d opening_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d into_bone = Eigen::Vector3d::UnitZ();
};

struct GraftState {
  double flexion_deg = 0;
  double length_mm = 0;  // between the openings
  // Between the graft and the tunnel that it goes on into: 0 is straight. At the femur this is the graft
  // bending angle of the literature (65 to 85 deg for drilling at 100 to 130 deg of flexion; BioMed Res Int
  // 2018, 2643247).
  double femoral_bend_deg = 0, tibial_bend_deg = 0;
};

struct GraftCourse {
  std::vector<GraftState> states;  // from extension on
  double shortest_mm = 0, longest_mm = 0, longest_at_deg = 0;
  double greatest_femoral_bend_deg = 0, greatest_tibial_bend_deg = 0;
  [[nodiscard]] double change_mm() const { return longest_mm - shortest_mm; }
};

struct FlexionRange {
  double to_deg = 120, step_deg = 5;  // from 0
};

// Both ends as imaged, in the same frame. Throws InvalidInput when the range is not from 0 up in steps of 0.5
// deg or more.
[[nodiscard]] GraftCourse graft_course(const GraftEnd& femur, const GraftEnd& tibia, const FlexionAxis& axis,
                                       const FlexionRange& range = {});

}  // namespace arthronaut::graft
