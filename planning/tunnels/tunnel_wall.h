// The bone that is left beside a tunnel, from mouth to mouth.
//
// Every line from the tunnel's side straight away from its axis runs through bone until it comes out. How far
// it runs is the wall there; the wall of the tunnel is the least of them, negative where the tunnel's side
// lies outside. No stretch is left out.
//
// A tunnel that meets a face at a slant has a sharp lip on one side of its mouth: bone thins to nothing
// there, since the hole is cut at a slant and not since it breaks out. Lip and breach are told apart by the
// face that such a line comes out of, followed from the mouth's rim on in every half plane through the axis:
//   lip     the mouth's own face: it turns less than 45 deg from the mouth's normal, and it faces the drill
//           by more than 15 deg (at the exit: faces away from it)
//   wall    all that comes after it. A face that turns away for less than 1 mm is roughness of the lip.
// Which way a face looks is taken without the roughness of its triangles (geometry/smooth_normals.h), so that
// the number does not jump while a tunnel is dragged over a surface out of a CT. So an edge beside the mouth,
// a second face through which the side shows, a groove along a cortex and a tunnel that grazes the bone are
// walls; a flat or bowed face that is met at a slant is not.
//
// Exact in the triangles along every half plane; of those 1.5 deg apart, half planes are halved around the
// thinnest places, and where the thickness or the end of a lip leaps, until they are 0.1 deg apart. What
// shows in less than 1.5 deg, 0.1 mm on a tunnel's side, may be passed over.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "planning/tunnels/axis_view.h"
#include "planning/tunnels/breach.h"
#include "planning/tunnels/tunnel_mouth.h"

namespace arthronaut::tunnels {

struct TunnelWall {
  bool is_known =
      false;  // false: no side of the tunnel comes out within the view's reach; the rest is meaningless
  double thickness_mm = 0;                          // negative: so far outside
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();  // on the bone's surface, where it is thinnest
  double station_mm = 0;                            // along the axis from the entry; may lie a little before
                                                    // the entry or beyond the exit, in a slanting rim
};

struct WallQuery {
  double length_mm = 0, diameter_mm = 0;
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  TunnelMouth entry, exit;
};
// The view must reach from rim_reach_mm(diameter) before the entry to as far beyond the exit.
[[nodiscard]] TunnelWall thinnest_wall(const AxisView& view, const WallQuery& query);

// Where the side lies outside, lips left out: see breach.h. The ends are found as the thinnest place is. Of
// what lies beyond the tunnel's side the view needs to show nothing.
[[nodiscard]] std::vector<DepthRange> breaches(const AxisView& view, const WallQuery& query);

// How far before its mouth a tunnel's side may begin: that of a face at 15 deg to the axis.
[[nodiscard]] double rim_reach_mm(double diameter_mm);

}  // namespace arthronaut::tunnels
