// How far a tracker is from the truth of a clip.
#pragma once

#include <vector>

#include "tests/real_data/marker_clip.h"
#include "tests/real_data/pose_error.h"

namespace arthronaut::real_data {

struct ClipAccuracy {
  std::vector<double> rotation_deg, translation_mm, depth_mm;  // of every tracked marker; depth is signed
  std::vector<double> relative_rotation_deg,
      relative_translation_mm;             // tool marker in the world marker's frame
  std::vector<double> tip_mm;              // the tool's tip there
  std::vector<double> cpu_ms;              // of each track(), this thread
  double normalised_error = 0;             // mean of squared error by covariance, over 6
  int wrong_count = 0;                     // valid, but off by more than 5 deg or 1 mm, or not in the scene
  int whole_count = 0, whole_tracked = 0;  // nothing covered
  int partial_count = 0, partial_tracked = 0;
  [[nodiscard]] double whole_rate() const { return whole_count ? double(whole_tracked) / whole_count : 1; }
  [[nodiscard]] double partial_rate() const {
    return partial_count ? double(partial_tracked) / partial_count : 1;
  }
};

// From the clip's next picture to its end, with the true camera of every picture.
[[nodiscard]] ClipAccuracy measure_accuracy(MarkerClip& clip, markers::MarkerTracker& tracker);
// The same with another calibration of the same scope.
[[nodiscard]] ClipAccuracy measure_accuracy(MarkerClip& clip, markers::MarkerTracker& tracker,
                                            const camera::Calibration& calibration);

}  // namespace arthronaut::real_data
