// The bones that a known CT shows.
#pragma once

#include <vector>

#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::test {

// Femur and tibia of the built-in knee, a right one.
[[nodiscard]] const std::vector<geometry::TriangleMesh>& knee();

// A rod beside the tibia, on the patient's left.
[[nodiscard]] geometry::TriangleMesh fibula_of(const geometry::TriangleMesh& tibia);

// One whose head lies against the tibia, below its outer half, over a face of two centimetres: it follows the
// tibia's surface at a tenth of a millimetre.
[[nodiscard]] geometry::TriangleMesh fibula_against(const geometry::TriangleMesh& tibia);

}  // namespace arthronaut::test
