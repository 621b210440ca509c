// Whether a registration that a file holds may be relied on. Its own words are not believed: whatever of them
// can be judged without the strokes that it was found by is judged again.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "navigation/registration/registration.h"
#include "navigation/tools/tool_set.h"
#include "planning/bones/bone.h"
#include "planning/geometry/surface.h"

namespace arthronaut::registration {

// A world marker is screwed onto the bone, or onto a pin in it; one further off, or deeper inside, is not on
// this bone as the registration has it. What carries an outside tracker's marker may be an arm long, and its
// frame may lie at the tip of the screw.
inline constexpr double kFarthestMarker_mm = 50, kDeepestMarker_mm = 10, kFarthestOutside_mm = 400;

// What it is used for.
struct GivenUse {
  const geometry::Surface& bone;
  const tools::ToolSet& tools;
  bones::BoneKind kind = bones::BoneKind::Femur;
  std::optional<Eigen::Vector3d> target_in_bone_mm = std::nullopt;  // the planned entry
};

// It is not reliable where one of these speaks against it, with the reasons added to its own: the bone's
// distance from its marker; the error that it says, or that its covariance predicts at the target, above
// kMaxError_mm; points that miss the bone by more than that; a covariance that knows the bone far better
// than the error that is said. Nothing is held against 0 points or an error of 0: the truth of a simulation
// says so.
void judge_given(RegistrationSummary& given, const GivenUse& use);

}  // namespace arthronaut::registration
