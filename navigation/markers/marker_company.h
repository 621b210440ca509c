// Where each marker stood beside another one when both were last seen: where that one takes it while it is
// lost itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "navigation/markers/marker_tracker.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::markers {

class MarkerCompany {
 public:
  void start_over(std::size_t markers) { beside_.assign(markers, Beside()); }
  // The observations of a frame, one for each marker, are final.
  void remember(std::span<const MarkerObservation> observations, std::int64_t timestamp_ns);

  struct Place {
    geometry::RigidTransform camera_from_marker;
    std::int64_t age_ns = 0;  // since both were seen
  };
  // Of a marker in the frame of this time; nullopt where the other one is not tracked, or it was too long
  // ago.
  [[nodiscard]] std::optional<Place> place_of(std::size_t marker,
                                              std::span<const MarkerObservation> observations,
                                              std::int64_t timestamp_ns) const;

 private:
  struct Beside {
    std::size_t other = 0;
    geometry::RigidTransform other_from_marker;
    std::int64_t timestamp_ns = -1;  // below 0: never
  };
  std::vector<Beside> beside_;  // by marker
};

}  // namespace arthronaut::markers
