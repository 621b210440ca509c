// A radiograph of bones, made from their surfaces: how much bone a parallel beam goes through at every pixel.
// Along the condylar line it is the true lateral view, with the condyles superposed, on which surgeons read
// the grids; a real one is always a little turned.
#pragma once

#include <cstdint>
#include <vector>

#include "app/scene/reslice.h"
#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::scene {

// The bone along the beam, mm, at each pixel of the plane; rows from the top. The beam goes along
// plane.normal(); the mesh is closed and outward.
[[nodiscard]] std::vector<float> thickness_along(const geometry::TriangleMesh& mesh, const SlicePlane& plane,
                                                 const Eigen::Vector2i& size_px);

// Bright where bone is, as on film: 255 * (1 - exp(-attenuation * thickness)). 0.02 per mm shows condyles of
// 60 mm and cortices.
[[nodiscard]] std::vector<std::uint8_t> radiograph_from(const std::vector<float>& thickness_mm,
                                                        double attenuation_per_mm = 0.02);

}  // namespace arthronaut::scene
