// How a marker moved over the last frames, and what that says of the next.
#pragma once

#include <cstdint>
#include <optional>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::markers {

// How a marker moved while the shutter was open, as its smear tells: body twists, as ExposedPose has them.
struct SeenMotion {
  geometry::Vector6d velocity = geometry::Vector6d::Zero(), change = geometry::Vector6d::Zero();
  // A smear looks the same run backwards: until the marker is seen to have gone on, it may have been.
  bool is_sense_known = false;
};

class MarkerMotion {
 public:
  // The marker stands here at this time; later than the calls before.
  void follow(const geometry::RigidTransform& camera_from_marker, std::int64_t timestamp_ns,
              const std::optional<SeenMotion>& over_exposure = std::nullopt);

  // Where it should be; nullopt when it was never seen or too long ago.
  [[nodiscard]] std::optional<geometry::RigidTransform> predicted(std::int64_t timestamp_ns) const;
  // Its last sighting is so recent that it tells of the motion now.
  [[nodiscard]] bool is_known_at(std::int64_t timestamp_ns) const;
  // Body twist (v mm, w rad) of one frame's time, from the way between the last sighting, however many frames
  // ago, and this pose; zero when not known.
  [[nodiscard]] geometry::Vector6d twist_to(const geometry::RigidTransform& pose, std::int64_t timestamp_ns,
                                            std::int64_t interval_ns) const;
  // How that twist differs from the one before; nullopt when not known.
  [[nodiscard]] std::optional<geometry::Vector6d> change_to(const geometry::RigidTransform& pose,
                                                            std::int64_t timestamp_ns,
                                                            std::int64_t interval_ns) const;
  // However long ago; nullopt when it was never seen.
  struct Sighting {
    geometry::RigidTransform camera_from_marker;
    std::int64_t timestamp_ns = 0;
    std::optional<SeenMotion> over_exposure = std::nullopt;
  };
  [[nodiscard]] const std::optional<Sighting>& last() const { return last_; }
  [[nodiscard]] const std::optional<Sighting>& before() const { return before_; }  // the one before

 private:
  std::optional<Sighting> last_, before_;
};

}  // namespace arthronaut::markers
