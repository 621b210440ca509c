// What was in view, and when: the world marker, the guide, the control point under the probe, and the last
// picture that guided. All times are of the frames of one source, ns; with another source, whose clock is
// another one, they are gone. What is left of the source before is that nobody saw the marker in between.
//
// Thread-free, deterministic; allocates nothing.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

namespace arthronaut::operation {

class InView {
 public:
  // Pictures of another source. may_have_moved: pictures of this operation were seen before, and a hand may
  // have hit the marker since: that is a long loss.
  void on_source(bool may_have_moved);
  // Another registration: nothing was guided by it yet.
  void on_registration() { guided_ns_.reset(); }

  // Every frame, in order of time. True when something is new that is told: the marker was lost for long, or
  // the guide is seen for the first time.
  bool add(std::int64_t now_ns, bool world_is_seen, bool guide_is_seen);
  void guided(std::int64_t now_ns) { guided_ns_ = now_ns; }
  // Touched for the first time: it knows where the bone lies from now on.
  void control_point_set(std::int64_t now_ns) { control_set_ns_ = now_ns; }
  // Touched, and where it was: the marker sits where it sat.
  void control_point_held(std::int64_t now_ns) {
    control_held_ns_ = now_ns;
    was_lost_for_long_ = false;
  }

  // Until the control point is found where it was.
  [[nodiscard]] bool marker_was_lost_for_long() const { return was_lost_for_long_; }
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
  bool was_lost_for_long_ = false, guide_was_seen_ = false;
};

}  // namespace arthronaut::operation
