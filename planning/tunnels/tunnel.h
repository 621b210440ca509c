// A bone tunnel as planned or as drilled, and what follows from it and the bone.
#pragma once

#include <Eigen/Core>
#include <compare>
#include <optional>
#include <string>

#include "planning/bones/bone.h"
#include "planning/geometry/surface.h"
#include "planning/norms/insertion_norms.h"
#include "planning/tunnels/tunnel_mouth.h"

namespace arthronaut::tunnels {

// Which tunnel of a knee: a bone has one for the whole ligament, or one for each of its two bundles. The bone
// alone names the tunnel of the whole ligament and never one of a bundle: who asks for "the femur's" of two
// gets none.
struct TunnelKey {
  bones::BoneKind bone = bones::BoneKind::Femur;
  norms::Bundle bundle = norms::Bundle::Whole;
  TunnelKey(bones::BoneKind of_bone, norms::Bundle of_bundle = norms::Bundle::Whole)
      : bone(of_bone), bundle(of_bundle) {}
  [[nodiscard]] auto operator<=>(const TunnelKey&) const = default;
};
[[nodiscard]] std::string name_of(const TunnelKey& key);  // "femur", "femur AM", "tibia PL"

struct Tunnel {
  bones::BoneKind bone = bones::BoneKind::Femur;
  Eigen::Vector3d entry_mm = Eigen::Vector3d::Zero();    // on the joint side, in the bone's frame (LPS)
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  // unit, the direction of drilling, into the bone
  double diameter_mm = 9.0;
  norms::Bundle bundle = norms::Bundle::Whole;
  [[nodiscard]] TunnelKey key() const { return {bone, bundle}; }
};

struct TunnelGeometry {
  bool enters_bone = false;  // false: the rest is meaningless
  // Where the axis enters the bone, within 5 mm of the planned entry, and where it leaves it.
  Eigen::Vector3d entry_on_surface_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d exit_mm = Eigen::Vector3d::Zero();
  double length_mm = 0;  // inside bone, along the axis
  double wall_mm = 0;    // the least bone beside the tunnel, mouth to mouth: see tunnel_wall.h
  Eigen::Vector3d thinnest_mm = Eigen::Vector3d::Zero();  // on the bone's surface, where it is that thin
  double thinnest_station_mm = 0;                         // along the axis, from the entry
  TunnelMouth entry = {}, exit = {};
};

// Never throws: a tunnel that misses the bone gives enters_bone == false. Keep the Surface for as long as the
// bone: it is the index that makes this a matter of milliseconds.
[[nodiscard]] TunnelGeometry measure(const Tunnel& tunnel, const geometry::Surface& bone);

// Where a tunnel begins for whoever draws it or reads it on a grid: where its axis enters the bone, as the
// checks take it; as planned where it misses. A plan from elsewhere may begin some mm before the bone.
[[nodiscard]] Eigen::Vector3d entry_on_bone(const Tunnel& tunnel, const TunnelGeometry& measured);

// TunnelGeometry::length_mm alone, in microseconds; nullopt for a tunnel that misses the bone.
[[nodiscard]] std::optional<double> length_along(const Tunnel& tunnel, const geometry::Surface& bone);

}  // namespace arthronaut::tunnels
