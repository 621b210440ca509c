// Marker poses of a whole video: what `arthronaut track` does.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "navigation/pipeline/view_tracker.h"
#include "navigation/sources/frame_source.h"
#include "navigation/tools/tool_set.h"

namespace arthronaut::pipeline {

// How often each marker was seen; counts add up to the number of frames.
struct MarkerStatistics {
  int id = 0;
  std::string name;  // "femur" for its world marker, else the tool's
  long frames_with_pose = 0;
  // The most frequent reason why there was none; NotSeen when there always was one.
  markers::MarkerState main_loss = markers::MarkerState::NotSeen;
  std::vector<long> frames_by_loss;  // by MarkerState
};

struct ViewStatistics {
  long frame_count = 0;
  long frames_with_mark = 0;
  long frames_with_unknown_lens = 0;  // markers may have been found, but no pose stands
  // Of these, by a view of another size or in another place than this camera's.
  long frames_off_camera = 0;
  std::string off_camera;  // what was told of the first of them, in words
  long frames_frozen = 0;
  double processing_ms_mean = 0, processing_ms_worst = 0;
  std::vector<MarkerStatistics> markers;  // in the order of declared_markers()

  explicit ViewStatistics(const tools::ToolSet& tools);
  ViewStatistics() = default;
  void add(const PictureObservation& view, double processing_ms);
  // Why what was seen is not this camera's; empty where that is so of half of the frames at most, as of a
  // zoom that was turned and turned back: what is said of the others holds.
  [[nodiscard]] std::string reason_of_camera() const;
};

struct TrackedVideo {
  std::vector<strokes::PoseRow> rows;
  ViewStatistics statistics;
  std::vector<std::string> reasons;  // why the result is not reliable; empty when it is
};

using FrameSeen = std::function<void(const camera::Frame&, const PictureObservation&)>;

// In a medium that the pictures contradict (medium_check.h) no pose stands: of a stretch that shows another
// one there are no rows, from the last moment on that was sure to its end, and a reason names the medium and
// the stretch. Decoding runs in a thread of its own. on_frame is called after each frame with what was
// seen in it. Throws what the source throws, what on_frame throws, and InvalidInput for another frame size.
[[nodiscard]] TrackedVideo track_video(sources::FrameSource& source, const ViewTrackerOptions& options,
                                       const tools::ToolSet& tools, const FrameSeen& on_frame = {});

}  // namespace arthronaut::pipeline
