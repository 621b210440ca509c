// Where in a picture markers and instruments stand before the bone: nothing is looked for there.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "navigation/camera/camera_model.h"
#include "navigation/contour/edge_search.h"
#include "navigation/tools/tool_set.h"

namespace arthronaut::contour {

// A bounded list: what does not fit any more is not kept, and some edge is looked for where a tool is.
class CoveredPlaces {
 public:
  void clear() { count_ = 0; }
  // The screw's head or the plate that carries it.
  void add_world_marker(const camera::CameraModel& camera, const geometry::RigidTransform& camera_from_world,
                        const tools::WorldMarker& marker);
  // Its plates, and its shaft: along the declared axis, else along the y of its marker, as instruments carry
  // them, from the tip's end up to where the lens sees it no more; and from there to the tip.
  void add_tool(const camera::CameraModel& camera, const geometry::RigidTransform& camera_from_tool,
                const tools::Tool& tool);
  [[nodiscard]] std::span<const Covered> places() const { return {places_.data(), count_}; }

 private:
  void add_disc(const camera::CameraModel& camera, const Eigen::Vector3d& in_camera_mm, double radius_mm);
  void add_rod(const camera::CameraModel& camera, const geometry::RigidTransform& camera_from_tool,
               const Eigen::Vector3d& from_mm, const Eigen::Vector3d& to_mm, double radius_mm);

  std::array<Covered, 96> places_;
  std::size_t count_ = 0;
};

}  // namespace arthronaut::contour
