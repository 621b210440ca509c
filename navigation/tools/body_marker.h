// A body that carries several markers: where each lies on it. A body is a tool, or what a bone's world frame
// is fixed to; its frame is the one that tip_mm and axis_* are in, and for a world marker the world itself.
// One marker alone is the body's frame by itself.
#pragma once

#include <optional>
#include <vector>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::tools {

struct BodyMarker {
  int marker_id = 0;
  double size_mm = 4;                         // side of the black square, border included
  geometry::RigidTransform body_from_marker;  // "tool_from_marker" in the file
  // How well body_from_marker is known: one sigma of each coordinate, and about each axis. Empty: nobody
  // said.
  std::optional<double> sigma_mm = std::nullopt, sigma_deg = std::nullopt;
};

// More than this many markers on one body are refused.
inline constexpr int kMostMarkersOfBody = 16;

// Of the twist (v mm, w rad) on the marker's side. Where nobody said: none for a marker that is the body's
// frame, else 0.03 mm and 0.2 degrees, what `arthronaut rig` has to keep to be relied on.
[[nodiscard]] geometry::Matrix6d placement_covariance(const BodyMarker& marker);

// Whether both cannot be printed where they are said to be: they face the same way (within 60 degrees) and
// their centres are nearer than half the mean of their sides.
[[nodiscard]] bool lie_on_one_another(const BodyMarker& a, const BodyMarker& b);

// To the last bit: which markers, how large and where; not how well that is known.
[[nodiscard]] bool are_same(const std::vector<BodyMarker>& a, const std::vector<BodyMarker>& b);

}  // namespace arthronaut::tools
