#include "navigation/operation/in_view.h"

namespace arthronaut::operation {

namespace {

// A marker that was out of sight for so long may have been hit meanwhile.
constexpr std::int64_t kLongLoss_ns = 30'000'000'000;
// A guide that is away for longer was put down: the hand is free for something else.
constexpr std::int64_t kGuideAway_ns = 2'000'000'000;
// A control point that was touched so lately need not be touched again before drilling.
constexpr std::int64_t kControlHolds_ns = 300'000'000'000;

// A marker that blur or a tool hides for a moment comes back within this time.
constexpr std::int64_t kStillThere_ns = 500'000'000;

}  // namespace

InView::News InView::add(std::int64_t now_ns, bool world_is_seen, bool guide_is_seen) {
  News news;
  news.guide_is_new = guide_is_seen && !guide_was_seen_;
  guide_was_seen_ = guide_was_seen_ || guide_is_seen;
  if (!world_is_seen) return news;
  news.marker_is_back = world_ns_ && now_ns - *world_ns_ > kLongLoss_ns;
  world_ns_ = now_ns;
  return news;
}

bool InView::control_point_is_old(std::int64_t now_ns) const {
  return guide_was_seen_ && now_ns - control_held_ns_ > kControlHolds_ns;
}

bool InView::marker_is_seen(std::int64_t now_ns) const {
  return world_ns_ && now_ns - *world_ns_ <= kStillThere_ns;
}

bool InView::guided_lately(std::int64_t now_ns) const {
  return guided_ns_ && now_ns - *guided_ns_ <= kGuideAway_ns;
}

}  // namespace arthronaut::operation
