// Whether the landmarks of a tunnel's bone lie where the bone's shape puts them. Grid, axes and with them
// most checks follow from these points: one that was put on the wrong place makes every number wrong and none
// of them suspicious.
#pragma once

#include <optional>
#include <string>

#include "planning/landmarks/landmarks.h"
#include "planning/landmarks/propose.h"
#include "planning/tunnels/plan_checks.h"

namespace arthronaut::plan_review {

// Look where one lies further off than PlanNorms::far_landmark_mm; its value is the furthest one's. A note
// where nobody has confirmed any, since the shape is then held against itself; not checked where the shape
// gives none, or nobody has asked it yet (null).
[[nodiscard]] tunnels::PlanCheck check_landmarks(bones::BoneKind bone, const landmarks::Landmarks& landmarks,
                                                 const landmarks::LandmarkStates& states,
                                                 const landmarks::Proposal* by_shape,
                                                 const tunnels::PlanNorms& norms = {});

// "Landmarks: Notch, deepest point 14.2 mm from where ..." where the check has failed: what rests on these
// landmarks is not reliable then.
[[nodiscard]] std::optional<std::string> landmark_doubt(const tunnels::PlanCheck& of_landmarks);

}  // namespace arthronaut::plan_review
