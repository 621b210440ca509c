// What was in view, and when: the world marker, the guide, the control point under the probe, and the last
// picture that guided. All times are of the frames of one source, ns; with another source, whose clock is
// another one, they are gone.
//
// Thread-free, deterministic; allocates nothing.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

namespace arthronaut::operation {

class InView {
 public:
  // Pictures of another source.
  void on_source() { *this = InView(); }
  // Another registration: nothing was guided by it yet.
  void on_registration() { guided_ns_.reset(); }

  struct News {
    bool marker_is_back = false;  // it was out of sight for so long that a hand may have hit it
    bool guide_is_new = false;    // it is seen for the first time
  };
  // Every frame, in order of time.
  News add(std::int64_t now_ns, bool world_is_seen, bool guide_is_seen);
  void guided(std::int64_t now_ns) { guided_ns_ = now_ns; }
  // Touched for the first time: it knows where the bone lies from now on.
  void control_point_set(std::int64_t now_ns) { control_set_ns_ = now_ns; }
  // Touched, and where it was: the marker sits where it sat.
  void control_point_held(std::int64_t now_ns) { control_held_ns_ = now_ns; }

  // The guide was seen, and the control point so long ago that it is to be touched again before drilling.
  [[nodiscard]] bool control_point_is_old(std::int64_t now_ns) const;
  // One that is there was set in this source later than that, or in one before it.
  [[nodiscard]] bool control_point_was_set_before(std::int64_t time_ns) const {
    return control_set_ns_ < time_ns;
  }
  // In the newest pictures: a marker that one of them lost is still there.
  [[nodiscard]] bool marker_is_seen(std::int64_t now_ns) const;
  // By the registration in force, so lately that the guide is still in the hand.
  [[nodiscard]] bool guided_lately(std::int64_t now_ns) const;

 private:
  std::optional<std::int64_t> world_ns_, guided_ns_;
  std::int64_t control_held_ns_ = 0;  // a source's first frame, where it was not touched in it
  // Of a source before this one: before all of its frames.
  std::int64_t control_set_ns_ = std::numeric_limits<std::int64_t>::min();
  bool guide_was_seen_ = false;
};

}  // namespace arthronaut::operation
