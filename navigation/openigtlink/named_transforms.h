// What of an operation goes out to other programs, under the names that they know it by.
//
//   WorldFemur, WorldTibia   the world marker in the camera
//   ProbeTip_World           the probe in the world, origin at its tip, axes of its marker
//   Guide_World, Drill_World the guide's and the drill's marker frame in the world (tools.json says where
//                            their axes and tips lie in it); of several drills the first one declared
//   Drill2_World             the second drill that is declared
//   Bone_World               the registration: the bone's frame in the world, while it may guide
//   Plan                     POINT: entry and end of the planned tunnel in the bone's frame
//   Arthroscope              IMAGE, to who asks for it: columns along the camera's x, rows along its y,
//                            a pixel a millimetre, its middle at the origin; upright in Slicer's axial view
//
// The world is the frame of the bone's world marker; all of it goes out in RAS (ras_from_lps.h), so that the
// bone as Slicer shows it, put under Bone_World, lies right to everything else.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "navigation/operation/operation_state.h"

namespace arthronaut::openigtlink {

struct NamedTransform {
  std::string name;
  geometry::RigidTransform target_from_source;  // in RAS
};

// What is valid in the newest frame, and nothing else.
[[nodiscard]] std::vector<NamedTransform> named_transforms(const operation::OperationState& state);

// Every name that a transform may go out under.
inline constexpr std::string_view kSecondDrill = "Drill2_World";
inline constexpr std::array<std::string_view, 7> kTransformNames{
    "WorldFemur", "WorldTibia", "ProbeTip_World", "Guide_World", "Drill_World", "Bone_World", kSecondDrill};
// Nobody who works with one drill is told of another one.
[[nodiscard]] bool has_second_drill(const operation::OperationState& state);
// Why named_transforms() has none under one of those names: "not seen", "registration: void".
[[nodiscard]] std::string why_without(const operation::OperationState& state, std::string_view name);

// The plan in force, in the bone's frame (RAS): "entry" and "end", where the tunnel ends. Empty without a
// plan. Shown under Bone_World it lies on the bone.
struct NamedPoint {
  std::string name;
  Eigen::Vector3d position_mm;
  double radius_mm = 0;  // of the tunnel
};
[[nodiscard]] std::vector<NamedPoint> plan_points(const operation::OperationState& state);

// Why there is no guidance; "OK" while there is, "OK, simulation" where nobody is operated on. Where several
// drills are declared, behind it, which one the depth is told of: "OK, depth of tibial drill (Drill2_World)".
struct Status {
  bool is_ok = false;
  std::string reason;
};
[[nodiscard]] Status status_of(const operation::OperationState& state);

}  // namespace arthronaut::openigtlink
