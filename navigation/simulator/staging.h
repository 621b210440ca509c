// Where things stand in the simulated operation: finds by search where the world marker sits on the bone,
// where the scope looks from in each phase and how the tools are held, so that every marker is large, free
// and not too oblique. All poses in the bone's frame (LPS, mm). Deterministic by seed.
#pragma once

#include <optional>
#include <vector>

#include "navigation/simulator/simulated_operation.h"
#include "planning/geometry/surface.h"

namespace arthronaut::simulator {

// One stop of the probe: where its tip is, and how it is held.
struct ProbePose {
  Eigen::Vector3d tip_mm;
  geometry::RigidTransform bone_from_marker;
};

struct Staging {
  geometry::RigidTransform bone_from_world_marker;
  geometry::RigidTransform bone_from_camera_pivot, bone_from_camera_scratch, bone_from_camera_drill;
  std::vector<ProbePose> pivot;                 // a closed swing about one tip; on the femur alone
  double pivot_cone_deg = 0;                    // half-angle
  std::vector<std::vector<ProbePose>> strokes;  // tip on the surface, steps of 0.5 mm
};

// Throws InvalidInput when the bone offers no such place (a plan that misses the notch, a marker that is too
// large).
[[nodiscard]] Staging stage_operation(const SimulationOptions& options, const geometry::Surface& bone);

[[nodiscard]] const tools::Tool& probe_of(
    const tools::ToolSet& tools);  // throws InvalidInput: none with a tip
[[nodiscard]] const tools::Tool& guide_of(
    const SimulationOptions& options);  // throws InvalidInput: none with an axis
[[nodiscard]] const tools::WorldMarker& world_marker_of(const SimulationOptions& options);

}  // namespace arthronaut::simulator
