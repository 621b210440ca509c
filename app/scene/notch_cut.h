// Where a femur is cut in two so that the lateral wall of its notch is seen from the medial side: the wall
// that the ligament comes from, which the medial condyle hides from everywhere but below.
#pragma once

#include <optional>

#include "app/scene/scene_content.h"
#include "planning/landmarks/anatomical_axes.h"

namespace arthronaut::scene {

// The sagittal plane through the notch; the medial half is cut away. Through the landmark "notch_apex" where
// it is there, else through the middle of the roof: the most lateral and the most medial sagittal slice
// between the condyles that is open from below to within 3 mm of the highest. nullopt for an empty mesh.
[[nodiscard]] std::optional<CutPlane> notch_cut(const geometry::TriangleMesh& femur,
                                                const landmarks::AnatomicalAxes& axes,
                                                const landmarks::Landmarks& landmarks);

}  // namespace arthronaut::scene
