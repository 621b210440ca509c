// The project's own tracker: squares found at a quarter of the frame's size, read, and then measured edge by
// edge at full size and in linear light; followed from frame to frame by prediction. See marker_tracker.h for
// what it promises.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "navigation/markers/marker_pattern.h"
#include "navigation/markers/marker_track.h"
#include "navigation/markers/marker_tracker.h"

namespace arthronaut::markers {

struct EdgeTrackerOptions {
  // Grey level = light ^ (1 / gamma). Below the usual 2.2: blur happens in light, but noise is even in grey
  // levels. What is left of the blur's asymmetry is estimated with each pose (bloom).
  // 1 takes edges where the grey levels put them: for pictures of unknown origin, to compare with other
  // detectors.
  double gamma = 1.6;
  double bloom_sigma_px =
      0.2;                   // how far the bloom may be from the camera's mean; hardly above 0 leaves it out
  bool fit_directly = true;  // false: edge profiles alone, also through motion blur; to compare
  MarkerTrackOptions track;
  // A search of the whole frame, by a part in each of so many: for doubles while every marker is tracked, and
  // for those that are long lost.
  int search_every_frames = 4;
};

// The same for other codes, which all have the same count of cells. Throws as make_tracker.
[[nodiscard]] std::unique_ptr<MarkerTracker> make_edge_tracker(std::span<const DeclaredMarker> declared,
                                                               std::span<const MarkerCode> codes,
                                                               const EdgeTrackerOptions& options = {});

}  // namespace arthronaut::markers
