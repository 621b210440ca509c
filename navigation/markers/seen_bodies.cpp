#include "navigation/markers/seen_bodies.h"

namespace arthronaut::markers {

namespace {

// A marker that did not lie where the others of its body had it is not believed alone, once the others are
// out of sight, nor is either of two that contradicted each other; not until it agrees with another again.
void distrust(const Body& body, std::span<const MarkerObservation> all, BodyObservation& observation,
              std::uint32_t& out_of_place) {
  const bool contradict = observation.state == MarkerState::Disagreeing;
  for (std::size_t i = 0; i < body.markers.size(); ++i) {
    const std::uint32_t bit = std::uint32_t{1} << i;
    const bool is_odd = observation.odd_marker == body.markers[i].marker_id;
    if (is_odd || (contradict && all[body.first + i].is_tracked())) out_of_place |= bit;
  }
  if (!observation.is_tracked()) return;
  if (observation.used_count() >= 2)
    out_of_place &= ~observation.used;
  else if ((observation.used & out_of_place) != 0)
    observation.state = MarkerState::Disagreeing;
}

}  // namespace

void SeenBodies::observe(std::span<const MarkerObservation> markers, const camera::CameraModel& camera,
                         std::vector<BodyObservation>& seen) {
  seen.resize(declared_.size());
  out_of_place_.resize(declared_.size(), 0);
  for (std::size_t i = 0; i < declared_.size(); ++i) {
    const Body& body = declared_[i];
    seen[i] = observe_body(body, markers.subspan(body.first, body.markers.size()), camera);
    distrust(body, markers, seen[i], out_of_place_[i]);
  }
}

}  // namespace arthronaut::markers
