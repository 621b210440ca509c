// What the scripted surgeon does, moment by moment: one file a phase. Poses in the bone's frame (LPS, mm)
// unless said.
#pragma once

#include <optional>
#include <vector>

#include "navigation/simulator/staging.h"

namespace arthronaut::simulator {

// One frame's scene.
struct Moment {
  double mark_angle_deg = 0;
  geometry::RigidTransform bone_from_camera;
  std::optional<geometry::RigidTransform> bone_from_probe,
      bone_from_guide;                                        // markers of the tools in the scene
  std::optional<geometry::RigidTransform> camera_from_board;  // Calibrate: the board alone
  bool tip_touches_bone = false;
  double drilled_depth_mm = 0;
};
using Script = std::vector<Moment>;

// Five pictures of the board from all sides, the lens turned by 50 degrees from each to the next.
[[nodiscard]] Script calibrate_script(const SimulationOptions& options);
// The probe swings about its tip, which rests in a dimple of the bone.
[[nodiscard]] Script pivot_script(const SimulationOptions& options, const Staging& staging);
// The tip draws stroke after stroke on the bone, and is lifted from each to the next; then it rests at a few
// places far from one another, and at the first of them once more.
[[nodiscard]] Script scratch_script(const SimulationOptions& options, const Staging& staging);
// The guide comes from 9 mm off and 11 degrees aslant to `aim`, rests, and the drill goes in.
[[nodiscard]] Script drill_script(const SimulationOptions& options, const Staging& staging,
                                  const tunnels::Tunnel& aim, double length_mm);

// A hand's slow unrest: a fraction of a millimetre and of a degree, smooth over frames. The same for a seed.
[[nodiscard]] geometry::RigidTransform tremor(std::uint64_t seed, double frame, double amplitude_mm,
                                              double amplitude_deg);
// From a to b, rotation along the shortest arc.
[[nodiscard]] geometry::RigidTransform between(const geometry::RigidTransform& a,
                                               const geometry::RigidTransform& b, double share);

}  // namespace arthronaut::simulator
