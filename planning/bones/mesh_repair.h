// Makes the closed, outward surface that everything after import relies on, and says what that took.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::bones {

struct MeshRepairReport {
  std::size_t triangles_found = 0;
  std::size_t vertices_merged = 0;       // of the same place as another
  std::size_t vertices_unused = 0;       // of no triangle
  std::size_t triangles_degenerate = 0;  // without an area
  std::size_t triangles_duplicate = 0;   // the same corners as another
  std::size_t edges_not_manifold = 0;  // shared by three triangles or more, or by two that look opposite ways
  std::size_t parts_found = 1;         // connected pieces; the one of the largest area is kept
  std::size_t triangles_of_other_parts = 0;
  std::size_t holes_filled = 0;
  double largest_hole_mm = 0;         // length of its edge
  double filled_area_fraction = 0;    // of the surface as it is now
  std::size_t triangles_flipped = 0;  // of the kept part, looked the other way; all of them: was inside out
  bool was_inside_out = false;
  std::size_t triangles_now = 0;
  double volume_mm3 = 0;
  bool is_closed = false;  // false: the result must not be used for planning

  // A line for each thing that was found and mended, for a person; empty when the mesh was fine.
  [[nodiscard]] std::vector<std::string> lines() const;
  // Why a person should look at the result before relying on it; empty when there is no reason.
  [[nodiscard]] std::vector<std::string> doubts() const;
};

// A hole of the mesh: what closes it now no scanner saw.
struct FilledHole {
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();  // the middle of its edge
  double across_mm = 0;                             // of a circle about it that holds its edge
  // Of its edge's plane, away from the rest of the mesh; zero where the edge has none.
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  bool operator==(const FilledHole&) const = default;
};

struct MeshRepair {
  geometry::TriangleMesh mesh;
  MeshRepairReport report;
  std::vector<FilledHole> filled;
};

// Merges equal points, drops what has no area, keeps the largest part, fills its holes and turns it outwards.
// Points are not moved. A million triangles take in the order of ten seconds. Throws InvalidInput when
// nothing is left, an index is out of range or a coordinate is not finite.
[[nodiscard]] MeshRepair mend_mesh(const geometry::TriangleMesh& mesh);

}  // namespace arthronaut::bones
