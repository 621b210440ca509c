#include "planning/plan_export/drilled_bone.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Surface_mesh.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "planning/geometry/rigid_transform.h"
#include "planning/geometry/surface.h"

namespace arthronaut::plan_export {

namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Eigen::Vector3d;

constexpr int kSides = 96;
constexpr double kRing_mm = 3;          // of the cylinder's length, between one ring and the next
constexpr double kFurthestOut_mm = 15;  // beyond a mouth, where nothing else comes

Mesh cgal_from(const geometry::TriangleMesh& mesh) {
  Mesh result;
  for (const Vector3d& v : mesh.vertices_mm) result.add_vertex({v.x(), v.y(), v.z()});
  for (const auto& t : mesh.triangles) {
    const auto vertex = [&](std::size_t k) { return Mesh::Vertex_index(static_cast<Mesh::size_type>(t[k])); };
    result.add_face(vertex(0), vertex(1), vertex(2));
  }
  return result;
}

geometry::TriangleMesh mesh_from(Mesh& mesh) {
  mesh.collect_garbage();
  geometry::TriangleMesh result;
  for (const auto v : mesh.vertices())
    result.vertices_mm.emplace_back(mesh.point(v).x(), mesh.point(v).y(), mesh.point(v).z());
  for (const auto f : mesh.faces()) {
    std::array<std::int32_t, 3> triangle{};
    std::size_t k = 0;
    for (const auto v : CGAL::vertices_around_face(mesh.halfedge(f), mesh))
      triangle[k++] = static_cast<std::int32_t>(static_cast<Mesh::size_type>(v));
    result.triangles.push_back(triangle);
  }
  return result;
}

// A closed cylinder from one point to another, in rings: the boxes about sides as long as the tunnel, which
// runs aslant, would hold most of the bone, and each of its edges would be tried against each of them.
geometry::TriangleMesh cylinder(const Vector3d& from, const Vector3d& to, double radius) {
  const Vector3d along = to - from, axis = along.normalized(), u = axis.unitOrthogonal(), v = axis.cross(u);
  const int rings = std::max(1, static_cast<int>(std::ceil(along.norm() / kRing_mm)));
  geometry::TriangleMesh mesh;
  for (int ring = 0; ring <= rings; ++ring) {
    const Vector3d middle = from + along * (static_cast<double>(ring) / rings);
    for (int i = 0; i < kSides; ++i) {
      const double angle = 2 * geometry::kPi * (i + 0.5) / kSides;
      mesh.vertices_mm.push_back(middle + radius * (std::cos(angle) * u + std::sin(angle) * v));
    }
  }
  const auto first = static_cast<std::int32_t>(mesh.vertices_mm.size());
  mesh.vertices_mm.push_back(from);
  mesh.vertices_mm.push_back(to);
  for (std::int32_t i = 0; i < kSides; ++i) {
    const std::int32_t next = (i + 1) % kSides, last = kSides * rings;
    for (std::int32_t at = 0; at < last; at += kSides) {
      mesh.triangles.push_back({at + i, at + next, at + next + kSides});
      mesh.triangles.push_back({at + i, at + next + kSides, at + i + kSides});
    }
    mesh.triangles.push_back({first, next, i});
    mesh.triangles.push_back({first + 1, last + i, last + next});
  }
  return mesh;
}

// How far the cylinder may go beyond a mouth at `from`, outwards.
double room(const geometry::Surface& surface, const Vector3d& from, const Vector3d& outwards) {
  constexpr double kClear_mm = 0.1;
  const auto next = surface.first_hit(from + kClear_mm * outwards, outwards);
  return next ? std::min(kFurthestOut_mm, 0.5 * next->distance_mm) : kFurthestOut_mm;
}

struct Stopped {};

// The one way out of CGAL's boolean before its end.
struct StopBetweenSteps : pmp::Corefinement::Default_visitor<Mesh> {
  explicit StopBetweenSteps(std::stop_token asked) : stop(std::move(asked)) {}
  void look() const {
    if (stop.stop_requested()) throw Stopped();
  }
  void progress_filtering_intersections(double) const { look(); }
  void edge_face_intersections_step() const { look(); }
  void triangulating_faces_step() const { look(); }
  void start_building_output() const { look(); }
  std::stop_token stop;
};

}  // namespace

DrilledBone drill(const geometry::TriangleMesh& bone, const tunnels::Tunnel& tunnel) {
  return drill(bone, std::span(&tunnel, 1));
}

DrilledBone drill(const geometry::TriangleMesh& bone, std::span<const tunnels::Tunnel> tunnels,
                  const std::stop_token& stop) {
  DrilledBone result;
  const geometry::Surface surface(bone);
  std::vector<Mesh> drills;
  for (const tunnels::Tunnel& tunnel : tunnels) {
    const auto measured = tunnels::measure(tunnel, surface);
    if (!measured.enters_bone) {
      result.outcome = DrilledBone::Outcome::MissesTheBone;
      result.reason = tunnels.size() == 1 ? "the tunnel misses the bone"
                                          : "the tunnel " + name_of(tunnel.key()) + " misses the bone";
      return result;
    }
    const Vector3d& d = tunnel.direction;
    // A polygon of the circle's area.
    const double sector = 2 * geometry::kPi / kSides;
    const double radius = 0.5 * tunnel.diameter_mm * std::sqrt(sector / std::sin(sector));
    drills.push_back(
        cgal_from(cylinder(measured.entry_on_surface_mm - room(surface, measured.entry_on_surface_mm, -d) * d,
                           measured.exit_mm + room(surface, measured.exit_mm, d) * d, radius)));
  }
  result.outcome = DrilledBone::Outcome::BrokenSurface;
  result.reason = "the bone's surface is not closed or crosses itself";
  Mesh drilled = cgal_from(bone);
  if (!CGAL::is_closed(drilled) || drilled.number_of_faces() != bone.triangles.size()) return result;
  try {
    for (Mesh& drill : drills) {
      Mesh less;
      if (!pmp::corefine_and_compute_difference(
              drilled, drill, less,
              CGAL::parameters::visitor(StopBetweenSteps(stop)).throw_on_self_intersection(true)))
        return result;
      drilled = std::move(less);
    }
  } catch (const std::exception&) {  // CGAL's way to say that the surface crosses itself
    return result;
  } catch (const Stopped&) {
    result.outcome = DrilledBone::Outcome::Stopped;
    result.reason = "it was stopped";
    return result;
  }
  result.mesh = mesh_from(drilled);
  result.outcome = DrilledBone::Outcome::Drilled;
  result.reason.clear();
  return result;
}

}  // namespace arthronaut::plan_export
