// A live source that comes back by itself: one that breaks off, falls silent or ends is opened again until it
// is there, and pictures of another size are passed over until the right ones come; another camera that
// stands in its place is not taken for it, since the calibration is not its own. Meanwhile nothing is given,
// and SourceInfo::line says why.
//
//   opened by its maker (throws what opening throws: who names a source wants to know at once)
//     -> giving -> broken (DeviceError, or null) -> opened again, every 0.1 s -> giving
//     -> another size -> giving
//     -> there, but without a picture (null and a remark) -> giving, or broken
//     -> opened again, and it says to be another one, or is a camera that gives another size now -> not
//     taken,
//        looked at every second until it is the first one again
//   ended: line->end() was called, or a source that is not live came to its end
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>

#include "navigation/sources/frame_source.h"

namespace arthronaut::sources {

// Numbers and times of a live source's frames, over all its connections: they go on where they were, and by
// what captured_ns went on; where that goes back by more than a second, from there.
class LiveStamps {
 public:
  // When the picture was captured, on the steady clock. Pictures that were lost before it are counted too.
  void put_on(camera::Frame& frame, std::int64_t captured_ns, camera::CaptureClock clock,
              std::int64_t lost_before = 0);

 private:
  std::int64_t started_at_ns_ = 0, last_timestamp_ns_ = -1, next_index_ = 0;
};

struct Opening {
  LiveStamps& stamps;  // outlives the source that is opened
  bool is_again = false;
  Eigen::Vector2i first_size_px{0, 0};  // of what it gave first, while it is opened again
  // Who the source says it is, whatever format it gives: written by the opener. Left empty: nobody knows, and
  // a source that never said it is known by the size of its pictures alone.
  std::string& identity;
  // What is wrong with the pictures that come, in words for the screen: written by the source while it makes
  // one. Empty: nothing. With null instead of a picture: why it makes none for now; the source is still there
  // and is asked again.
  std::string& remark;
};
// Opens the source, which stamps what it gives by these stamps and throws DeviceError when it breaks off or
// gives nothing for too long. An opener whose source may end for good (a pipeline that is not live) says so
// by SourceInfo::ends.
using LiveOpener = std::function<std::unique_ptr<FrameSource>(const Opening&)>;

// Opens it. Throws what the opener throws.
[[nodiscard]] std::unique_ptr<FrameSource> recovering(LiveOpener opener);

}  // namespace arthronaut::sources
