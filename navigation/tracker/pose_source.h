// Whoever gives poses of an outside tracker while frames are taken.
#pragma once

#include <cstdint>
#include <string>

#include "navigation/tracker/tracker_poses.h"

namespace arthronaut::tracker {

class PoseSource {
 public:
  virtual ~PoseSource() = default;
  // Of all bodies, as of now (steady clock). `poses` is reused from call to call. Never waits for the
  // tracker, never throws; allocates nothing after the first call.
  virtual void poses_at(std::int64_t now_ns, TrackerPoses& poses) = 0;
  // Why the tracker gives nothing, in words for the screen; empty while it does.
  [[nodiscard]] virtual std::string trouble() const = 0;
  [[nodiscard]] virtual const std::string& name() const = 0;  // "igtl://host:18944"
};

}  // namespace arthronaut::tracker
