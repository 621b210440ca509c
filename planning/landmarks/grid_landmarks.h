// What the grids of insertion_grids.h follow from: a grid is as good as the least looked at of these.
#pragma once

#include <string>
#include <vector>

#include "planning/bones/bone.h"
#include "planning/landmarks/landmarks.h"

namespace arthronaut::landmarks {

// The names that the bone's grid needs, and of those that may tell its view and its extents the ones that do
// when these are known. Of what it needs also those that are not known.
[[nodiscard]] std::vector<std::string> grid_landmarks(bones::BoneKind bone, const Landmarks& known);

// How well a grid is looked after: somebody has looked at all of its landmarks, and none is missing; one at
// least is as the bone's shape proposes it; somebody has looked at all that are there, and one is missing.
enum class GridState { Confirmed, Proposed, Incomplete };
[[nodiscard]] GridState grid_state(bones::BoneKind bone, const Landmarks& known,
                                   const LandmarkStates& states);
// The first of these.
[[nodiscard]] bool is_grid_confirmed(bones::BoneKind bone, const Landmarks& known,
                                     const LandmarkStates& states);

// What speaks against the grid, in words that follow "Grid: "; empty where is_grid_confirmed(). Which of its
// landmarks nobody confirmed, and which are missing: without the pair of condyles the view of a femur's grid
// is the scanner's, whoever placed the rest.
[[nodiscard]] std::string grid_doubt(bones::BoneKind bone, const Landmarks& known,
                                     const LandmarkStates& states);

}  // namespace arthronaut::landmarks
