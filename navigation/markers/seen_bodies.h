// The bodies of one source's pictures, picture by picture: where their markers have each of them, and which
// of a body's markers is not believed alone, since it did not lie where the others had it. Whoever takes
// poses of bodies takes them from here, so that what is no pose for guidance is none for a calibration.
//
// Stateful over the pictures of one source; one thread at a time; deterministic.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "navigation/markers/body_pose.h"

namespace arthronaut::markers {

class SeenBodies {
 public:
  explicit SeenBodies(const tools::ToolSet& tools) : declared_(declared_bodies(tools)) {}
  // World markers', then tools': the order of what is observed, too.
  [[nodiscard]] const std::vector<Body>& declared() const { return declared_; }

  // Of one picture; its markers in the order of declared_markers(). `seen` is reused from call to call.
  void observe(std::span<const MarkerObservation> markers, const camera::CameraModel& camera,
               std::vector<BodyObservation>& seen);

 private:
  std::vector<Body> declared_;
  std::vector<std::uint32_t>
      out_of_place_;  // of each body: bit i, its marker i did not lie where others had it
};

}  // namespace arthronaut::markers
