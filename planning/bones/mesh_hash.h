// Which mesh something is of: plans and registrations name it, so that they are never used with another.
#pragma once

#include <string>

#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::bones {

// SHA-256 in hexadecimal over the vertices (x y z, binary64, little endian, mm, in order), then the
// triangles' vertex indices (int32, little endian, in order): the same for a mesh whatever file it came from.
[[nodiscard]] std::string mesh_sha256(const geometry::TriangleMesh& mesh);

}  // namespace arthronaut::bones
