
#include "planning/bones/mesh_repair.h"
#include "planning/files/format.h"

namespace arthronaut::bones {

namespace {

// A patch this large was not seen by any scanner: the surface was open by design, a cartilage say, or cut in
// half.
constexpr double kDoubtfulFilledFraction = 0.2;

std::string counted(std::size_t count, const std::string& singular, const std::string& plural) {
  return std::to_string(count) + " " + (count == 1 ? singular : plural);
}

}  // namespace

std::vector<std::string> MeshRepairReport::lines() const {
  std::vector<std::string> result;
  if (vertices_merged > 0)
    result.push_back(counted(vertices_merged, "repeated point", "repeated points") + " merged");
  if (vertices_unused > 0)
    result.push_back(counted(vertices_unused, "unused point", "unused points") + " dropped");
  if (triangles_degenerate > 0) {
    result.push_back(counted(triangles_degenerate, "triangle", "triangles") + " without an area removed");
  }
  if (triangles_duplicate > 0) {
    result.push_back(counted(triangles_duplicate, "repeated triangle", "repeated triangles") + " removed");
  }
  if (edges_not_manifold > 0) {
    result.push_back(counted(edges_not_manifold, "edge", "edges") +
                     " shared by three triangles or more cut apart");
  }
  if (parts_found > 1) {
    result.push_back("the largest of " + std::to_string(parts_found) + " parts kept, " +
                     counted(triangles_of_other_parts, "triangle", "triangles") + " of the others dropped");
  }
  if (holes_filled > 0) {
    result.push_back(counted(holes_filled, "hole", "holes") + " filled, the largest with an edge of " +
                     files::format("%.1f mm", largest_hole_mm) +
                     files::format(" (%.1f %% of the surface is filled in)", 100 * filled_area_fraction));
  }
  if (was_inside_out) {
    result.push_back("was inside out: turned");
  } else if (triangles_flipped > 0) {
    result.push_back(counted(triangles_flipped, "triangle", "triangles") + " that looked inwards turned");
  }
  return result;
}

std::vector<std::string> MeshRepairReport::doubts() const {
  std::vector<std::string> result;
  if (!is_closed) result.push_back("the surface is not closed");
  if (filled_area_fraction > kDoubtfulFilledFraction) {
    result.push_back(
        files::format("%.0f %% of the surface is filled in: it was open, and this may be no whole bone",
                      100 * filled_area_fraction));
  }
  if (2 * triangles_of_other_parts > triangles_now) {
    result.push_back("much of the mesh (" + std::to_string(triangles_of_other_parts) +
                     " triangles) was not connected to the part that was kept");
  }
  return result;
}

}  // namespace arthronaut::bones
