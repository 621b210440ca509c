// Which way a surface faces, without the roughness of its triangles: for questions that a single triangle out
// of a CT must not decide.
#pragma once

#include <array>
#include <vector>

#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::geometry {

// Unit normals at the corners of each triangle, to be laid linearly over it: the mean of the triangles
// around, weighted by area, over about 1.5 mm and at least over those that share the corner. Edges sharper
// than 40 deg stay edges: what turns away by more has no part in the mean, so that the faces of a box keep
// their own. Needs triangles with an area and shared vertices.
[[nodiscard]] std::vector<std::array<Eigen::Vector3d, 3>> smooth_corner_normals(const TriangleMesh& mesh);

}  // namespace arthronaut::geometry
