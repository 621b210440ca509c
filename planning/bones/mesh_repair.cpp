// The one translation unit of this module that takes in CGAL's mesh processing: it costs a minute to compile.
#include "planning/bones/mesh_repair.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <numeric>

#include "planning/geometry/error.h"

namespace arthronaut::bones {

namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;
using Halfedge = SurfaceMesh::Halfedge_index;
using Face = SurfaceMesh::Face_index;
using Polygon = std::vector<std::size_t>;

struct Soup {
  std::vector<Point> points;
  std::vector<Polygon> polygons;
};

Soup soup_of(const geometry::TriangleMesh& mesh) {
  Soup soup;
  soup.points.reserve(mesh.vertices_mm.size());
  for (std::size_t i = 0; i < mesh.vertices_mm.size(); ++i) {
    const auto& v = mesh.vertices_mm[i];
    if (!v.allFinite()) throw InvalidInput("mesh: vertex " + std::to_string(i + 1) + ": is not finite");
    soup.points.emplace_back(v.x(), v.y(), v.z());
  }
  soup.polygons.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Polygon polygon;
    for (const std::int32_t v : mesh.triangles[t]) {
      if (v < 0 || static_cast<std::size_t>(v) >= soup.points.size()) {
        throw InvalidInput("mesh: triangle " + std::to_string(t + 1) + ": refers to a vertex out of range");
      }
      polygon.push_back(static_cast<std::size_t>(v));
    }
    soup.polygons.push_back(std::move(polygon));
  }
  return soup;
}

void clean_soup(Soup& soup, MeshRepairReport& report) {
  // Unused points first: else an unused twin of a used point would count as merged.
  report.vertices_unused = pmp::remove_isolated_points_in_polygon_soup(soup.points, soup.polygons);
  report.vertices_merged = pmp::merge_duplicate_points_in_polygon_soup(soup.points, soup.polygons);
  const auto is_point_or_line = [](const Polygon& p) { return p[0] == p[1] || p[1] == p[2] || p[2] == p[0]; };
  report.triangles_degenerate = std::erase_if(soup.polygons, is_point_or_line);
  report.triangles_duplicate = pmp::merge_duplicate_polygons_in_polygon_soup(soup.points, soup.polygons);
  pmp::remove_isolated_points_in_polygon_soup(soup.points, soup.polygons);
  if (soup.polygons.empty()) throw InvalidInput("mesh: holds no triangle with an area");
}

std::size_t count_edges_not_manifold(const std::vector<Polygon>& polygons) {
  std::vector<std::pair<std::size_t, std::size_t>> edges;
  edges.reserve(3 * polygons.size());
  for (const Polygon& p : polygons) {
    for (int i = 0; i < 3; ++i) edges.push_back(std::minmax(p[i], p[(i + 1) % 3]));
  }
  std::sort(edges.begin(), edges.end());
  std::size_t count = 0;
  for (auto begin = edges.begin(); begin != edges.end();) {
    const auto end = std::find_if(begin, edges.end(), [&](const auto& e) { return e != *begin; });
    count += end - begin > 2;
    begin = end;
  }
  return count;
}

// Orients the triangles consistently, part by part, and cuts where three or more meet in an edge. Returns
// which of them now look the other way. Corners may have become copies of the points they were, so places are
// compared.
std::vector<bool> orient(Soup& soup) {
  const std::vector<Polygon> before = soup.polygons;
  pmp::orient_polygon_soup(soup.points, soup.polygons);
  std::vector<bool> flipped(before.size());
  for (std::size_t t = 0; t < before.size(); ++t) {
    const auto at = [&](const Polygon& p, int i) { return soup.points[p[i]]; };
    int shift = 0;
    while (shift < 2 && at(soup.polygons[t], shift) != at(before[t], 0)) ++shift;
    flipped[t] = at(soup.polygons[t], (shift + 1) % 3) != at(before[t], 1);
  }
  return flipped;
}

void keep_largest_part(SurfaceMesh& mesh, MeshRepairReport& report) {
  auto part = mesh.add_property_map<Face, std::size_t>("f:part", 0).first;
  report.parts_found = pmp::connected_components(mesh, part);
  if (report.parts_found > 1) {
    std::vector<double> area(report.parts_found, 0.0);
    for (const Face f : mesh.faces()) area[part[f]] += pmp::face_area(f, mesh);
    const std::size_t before = mesh.number_of_faces();
    const auto largest = static_cast<std::size_t>(std::max_element(area.begin(), area.end()) - area.begin());
    pmp::keep_connected_components(mesh, std::vector<std::size_t>{largest}, part);
    report.triangles_of_other_parts = before - mesh.number_of_faces();
  }
  mesh.remove_property_map(part);
}

double border_length(Halfedge border, const SurfaceMesh& mesh) {
  double length = 0;
  for (const Halfedge h : CGAL::halfedges_around_face(border, mesh)) length += pmp::edge_length(h, mesh);
  return length;
}

// A cone over the border: closed whatever the border's shape, for the holes that the triangulation gives up
// on.
void fill_by_cone(Halfedge border, SurfaceMesh& mesh) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0;
  for (const Halfedge h : CGAL::halfedges_around_face(border, mesh)) {
    const Point& p = mesh.point(mesh.target(h));
    sum += Eigen::Vector3d(p.x(), p.y(), p.z());
    ++count;
  }
  sum /= count;
  CGAL::Euler::fill_hole(border, mesh);
  const Halfedge center = CGAL::Euler::add_center_vertex(border, mesh);
  mesh.point(mesh.target(center)) = Point(sum.x(), sum.y(), sum.z());
}

using Edge = std::vector<Eigen::Vector3d>;

Edge edge_of(Halfedge border, const SurfaceMesh& mesh) {
  Edge edge;
  for (const Halfedge h : CGAL::halfedges_around_face(border, mesh)) {
    const Point& p = mesh.point(mesh.target(h));
    edge.emplace_back(p.x(), p.y(), p.z());
  }
  return edge;
}

// middle: of the mesh.
FilledHole filled_hole(const Edge& edge, const Eigen::Vector3d& middle) {
  FilledHole hole;
  for (const Eigen::Vector3d& p : edge) hole.at_mm += p / static_cast<double>(edge.size());
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < edge.size(); ++i) {
    const Eigen::Vector3d from = edge[i] - hole.at_mm, to = edge[(i + 1) % edge.size()] - hole.at_mm;
    hole.across_mm = std::max(hole.across_mm, 2 * from.norm());
    normal += from.cross(to);
  }
  if (!(normal.norm() > 0)) return hole;
  hole.out = normal.normalized() * (normal.dot(hole.at_mm - middle) < 0 ? -1 : 1);
  return hole;
}

// Returns the edges of what was filled.
std::vector<Edge> fill_holes(SurfaceMesh& mesh, MeshRepairReport& report) {
  std::vector<Edge> edges;
  std::vector<Halfedge> borders;
  pmp::extract_boundary_cycles(mesh, std::back_inserter(borders));
  for (const Halfedge border : borders) {
    edges.push_back(edge_of(border, mesh));
    report.largest_hole_mm = std::max(report.largest_hole_mm, border_length(border, mesh));
    ++report.holes_filled;
    std::vector<Face> added;
    // The cubic search would take hours on the cut end of a shaft with some thousand edges.
    pmp::triangulate_hole(mesh, border, std::back_inserter(added),
                          pmp::parameters::use_delaunay_triangulation(true)
                              .use_2d_constrained_delaunay_triangulation(true)
                              .do_not_use_cubic_algorithm(true));
    if (mesh.is_border(border)) fill_by_cone(border, mesh);
  }
  return edges;
}

geometry::TriangleMesh plain_mesh(SurfaceMesh& mesh) {
  mesh.collect_garbage();
  geometry::TriangleMesh result;
  result.vertices_mm.reserve(mesh.number_of_vertices());
  for (const auto v : mesh.vertices()) {
    const Point& p = mesh.point(v);
    result.vertices_mm.emplace_back(p.x(), p.y(), p.z());
  }
  result.triangles.reserve(mesh.number_of_faces());
  for (const Face f : mesh.faces()) {
    std::array<std::int32_t, 3> triangle{};
    int i = 0;
    for (const auto v : CGAL::vertices_around_face(mesh.halfedge(f), mesh)) {
      triangle[i++] = static_cast<std::int32_t>(static_cast<std::size_t>(v));
    }
    result.triangles.push_back(triangle);
  }
  return result;
}

// Thin triangles, whose three corners lie on a line, need the neighbours to close up: CGAL flips and
// collapses.
void remove_flat_triangles(SurfaceMesh& mesh, MeshRepairReport& report) {
  std::vector<Face> flat;
  pmp::degenerate_faces(mesh, std::back_inserter(flat));
  if (flat.empty()) return;
  report.triangles_degenerate += flat.size();
  pmp::remove_degenerate_faces(mesh);
}

MeshRepair mend(const geometry::TriangleMesh& mesh) {
  MeshRepair result;
  MeshRepairReport& report = result.report;
  report.triangles_found = mesh.triangles.size();

  Soup soup = soup_of(mesh);
  clean_soup(soup, report);
  report.edges_not_manifold = count_edges_not_manifold(soup.polygons);
  const std::vector<bool> flipped = orient(soup);

  SurfaceMesh surface;
  pmp::polygon_soup_to_polygon_mesh(soup.points, soup.polygons, surface);
  auto was_flipped = surface.add_property_map<Face, bool>("f:flipped", false).first;
  for (std::size_t t = 0; t < flipped.size(); ++t)
    was_flipped[Face(static_cast<SurfaceMesh::size_type>(t))] = flipped[t];
  pmp::stitch_borders(surface);
  keep_largest_part(surface, report);
  // What was cut at an edge shared by three closes again once the third is gone.
  pmp::stitch_borders(surface);
  remove_flat_triangles(surface, report);

  const double found_area = pmp::area(surface);
  std::size_t flips = 0;
  for (const Face f : surface.faces()) flips += was_flipped[f];
  const std::size_t kept = surface.number_of_faces();
  const std::vector<Edge> filled = fill_holes(surface, report);
  const double area = pmp::area(surface);
  report.filled_area_fraction = area > 0 ? std::max(0.0, area - found_area) / area : 0;
  report.is_closed = CGAL::is_closed(surface);
  report.volume_mm3 = pmp::volume(surface);
  if (report.volume_mm3 < 0) {
    pmp::reverse_face_orientations(surface);
    report.volume_mm3 = -report.volume_mm3;
    flips = kept - flips;
  }
  report.was_inside_out = flips == kept;
  report.triangles_flipped = flips;
  result.mesh = plain_mesh(surface);
  report.triangles_now = result.mesh.triangles.size();
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : result.mesh.vertices_mm)
    middle += p / static_cast<double>(result.mesh.vertices_mm.size());
  for (const Edge& edge : filled) result.filled.push_back(filled_hole(edge, middle));
  return result;
}

}  // namespace

MeshRepair mend_mesh(const geometry::TriangleMesh& mesh) {
  try {
    return mend(mesh);
  } catch (const CGAL::Failure_exception& failure) {
    // CGAL's checks, where they are compiled in, speak of its code: of use to nobody who has the mesh.
    throw InvalidInput(std::string("mesh: cannot be mended (") + failure.library() + ": " +
                       failure.expression() + ")");
  }
}

}  // namespace arthronaut::bones
