#include "planning/landmarks/grid_landmarks.h"

#include <algorithm>

namespace arthronaut::landmarks {

std::vector<std::string> grid_landmarks(bones::BoneKind bone, const Landmarks& known) {
  if (bone == bones::BoneKind::Tibia)
    return {"plateau_anterior", "plateau_posterior", "plateau_medial", "plateau_lateral"};
  const std::string pair = known.contains("lateral_condyle_center") && known.contains("medial_condyle_center")
                               ? "center"
                               : "posterior";
  std::vector<std::string> names{"blumensaat_anterior", "blumensaat_posterior", "lateral_condyle_" + pair,
                                 "medial_condyle_" + pair};
  if (known.contains("lateral_condyle_deep") && known.contains("lateral_condyle_shallow") &&
      known.contains("lateral_condyle_low"))
    names.insert(names.end(), {"lateral_condyle_deep", "lateral_condyle_shallow", "lateral_condyle_low"});
  return names;
}

GridState grid_state(bones::BoneKind bone, const Landmarks& known, const LandmarkStates& states) {
  GridState state = GridState::Confirmed;
  for (const std::string& name : grid_landmarks(bone, known)) {
    if (!known.contains(name))
      state = GridState::Incomplete;
    else if (state_of(states, name) == LandmarkState::Proposed)
      return GridState::Proposed;
  }
  return state;
}

bool is_grid_confirmed(bones::BoneKind bone, const Landmarks& known, const LandmarkStates& states) {
  return grid_state(bone, known, states) == GridState::Confirmed;
}

std::string grid_doubt(bones::BoneKind bone, const Landmarks& known, const LandmarkStates& states) {
  std::string proposed, missing;
  bool has_confirmed = false;
  for (const std::string& name : grid_landmarks(bone, known)) {
    if (known.contains(name) && state_of(states, name) == LandmarkState::Confirmed) {
      has_confirmed = true;
      continue;
    }
    std::string& names = known.contains(name) ? proposed : missing;
    names += (names.empty() ? "" : ", ") + name;
  }
  std::string doubt;
  if (!proposed.empty())
    doubt = has_confirmed ? "landmarks proposed from the bone's shape and not confirmed: " + proposed
                          : "landmarks proposed from the bone's shape, confirmed by nobody";
  if (!missing.empty())
    doubt += (doubt.empty() ? "" : "; ") + ("landmarks missing: " + missing) +
             (bone == bones::BoneKind::Femur ? ", so that it is seen along the scanner's axis" : "");
  return doubt;
}

}  // namespace arthronaut::landmarks
