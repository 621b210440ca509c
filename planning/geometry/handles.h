// Holes that go right through a body, as a drilled tunnel does, by its closed surface alone: each is a handle
// of it, counted by V - E + F, and measured by the shortest line about it.
#pragma once

#include <vector>

#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::geometry {

struct Handle {
  // Of the shortest line found that runs round it and does not part the surface: of a tunnel with a diameter
  // of 8 mm 25 mm, along edges a little more.
  double around_mm = 0;
  std::vector<Eigen::Vector3d> line_mm;  // that line, closed
};

// Handles that no shorter line than least_around_mm runs about, in any way: neither round the hole (that of a
// vessel) nor round what bridges it (a splinter). Those are cut and closed one after the other before. mesh:
// closed, oriented, each edge of two triangles; of another one none are found. Nor are they looked for where
// handles times triangles are more than 2.5 million, some seven seconds: such a surface is full of small
// holes. Vertices of the same place share an index. Of two parts each by itself.
[[nodiscard]] std::vector<Handle> handles_of(const TriangleMesh& mesh, double least_around_mm);

}  // namespace arthronaut::geometry
