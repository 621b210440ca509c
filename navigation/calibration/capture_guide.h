// Guides the taking of calibration pictures, live: what is wrong with the picture that the camera sees now,
// which picture is wanted next, and when there are enough. The same checks name the reasons for pictures from
// files.
//
// look() takes 50 to 200 ms on a 1080p frame (the board finder): call it from a worker, on the newest frame.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "navigation/calibration/calibration.h"

namespace arthronaut::calibration {

struct CaptureLimits {
  int fewest_pictures = 3;
  std::size_t fewest_corners = 60;
  double least_coverage = 0.6;   // of the round view's area that has corners near
  double widest_edge_px = 6.0;   // from black to white, in the median
  double most_saturated = 0.12;  // of the view's area
  double most_motion_px = 1.0;   // of a corner since the last look; only told where there was one
  double least_turn_deg = 40;    // from every picture taken
  double least_span_deg = 100;   // between the two most different pictures, all told
  double wanted_tilt_deg = 20;   // of at least one board
};

struct CaptureQuality {
  std::size_t corner_count = 0;
  double coverage = 0;              // 0 to 1
  double edge_width_px = 0;         // 0: not measured
  double saturated = 0;             // share of the view
  std::optional<double> tilt_deg;   // of the board; empty when this picture alone does not tell
  std::optional<double> motion_px;  // since the last look; empty without one
  std::optional<double> turn_deg;   // from the nearest picture taken; empty without a mark or a picture
};

struct CaptureAdvice {
  CalibrationPicture picture;  // as seen now
  CaptureQuality quality;
  std::vector<std::string> rejections;  // reasons not to take it; empty: take it
  std::string wanted;                   // what to do now, one line, for the screen
  bool is_complete = false;             // enough has been taken
  [[nodiscard]] bool is_good() const { return rejections.empty(); }
};

// What one picture shows, without regard to others.
[[nodiscard]] CaptureQuality measure_quality(const camera::GrayView& frame,
                                             const CalibrationPicture& picture);

// One thread at a time.
class CaptureGuide {
 public:
  explicit CaptureGuide(const CaptureLimits& limits = {}) : limits_(limits) {}

  // Judges a live frame. Never throws on what a picture shows.
  const CaptureAdvice& look(const camera::GrayView& frame);
  // Takes the frame last looked at, whatever the advice; a name for it is made up ("picture 2"). Throws
  // InvalidInput when there is no board in it.
  void take();
  void drop_last();

  [[nodiscard]] const CaptureAdvice& advice() const { return advice_; }
  [[nodiscard]] const std::vector<CalibrationPicture>& taken() const { return taken_; }

 private:
  [[nodiscard]] double span_deg(const CalibrationPicture* with) const;
  void judge();
  void advise();

  CaptureLimits limits_;
  CaptureAdvice advice_;
  std::vector<CalibrationPicture> taken_;
  std::vector<double> tilts_deg_;  // of the pictures taken; -1 unknown
};

}  // namespace arthronaut::calibration
