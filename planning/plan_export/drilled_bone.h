// The bone with its tunnels drilled out, as a closed surface: for printing, for finite elements, for other
// programs.
#pragma once

#include <span>
#include <stop_token>
#include <string>

#include "planning/geometry/triangle_mesh.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::plan_export {

struct DrilledBone {
  enum class Outcome {
    NotRun,
    Drilled,
    MissesTheBone,  // a tunnel's axis does not enter it
    BrokenSurface,  // not closed, or it crosses itself: no inside to take away from
    Stopped,        // by `stop`
  } outcome = Outcome::NotRun;
  std::string reason = "drill was not called";  // empty when drilled
  geometry::TriangleMesh mesh;                  // closed, outward, bone frame, mm
  [[nodiscard]] bool is_usable() const { return outcome == Outcome::Drilled; }
};

// The bone less a cylinder about the tunnel's axis, by CGAL's exact boolean (corefinement). The cylinder has
// 96 sides and the tunnel's cross-section area; it runs through both mouths and ends in the open, half way to
// whatever comes next.
[[nodiscard]] DrilledBone drill(const geometry::TriangleMesh& bone, const tunnels::Tunnel& tunnel);
// All of them, which may run into each other: each as it is planned in the bone before any was drilled.
// `stop` is asked at every step of the boolean. Precondition: at least one.
[[nodiscard]] DrilledBone drill(const geometry::TriangleMesh& bone, std::span<const tunnels::Tunnel> tunnels,
                                const std::stop_token& stop = {});

}  // namespace arthronaut::plan_export
