// Finds the circular image border and the lens mark in every frame, so that the intrinsics follow the lens.
// The mark may be a dark tooth that points inwards or a bright one that points outwards.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "navigation/camera/camera_model.h"
#include "navigation/camera/frame.h"

namespace arthronaut::lens {

enum class MarkState {
  Found,
  NoCircle,   // the rim itself was not found
  Dark,       // the scene beside the rim is too dark to tell
  Covered,    // something crosses the rim where the mark was expected
  Ambiguous,  // two dents look alike
  NotSeen,    // a clean rim without a mark
};
[[nodiscard]] std::string_view to_text(MarkState state);

// The circle against the place that the calibration gives it at this lens angle (without one: against its own
// past).
enum class RimState {
  OnTrack,
  Zoomed,   // another radius: another zoom or focus, so another focal length
  Slipped,  // another centre: the scope is not seated in the coupler as it was
};

// What the rim's radius says about the focal length. The rim is the edge of a stop inside the scope: camera
// head and zoom enlarge it just as they enlarge the scene, so its radius is the only witness of the zoom.
enum class ZoomState {
  NotWatched,    // no calibration for pictures of this size, or one without a rim
  Unknown,       // no rim that would tell: never seen, out of view, or hidden for too long
  AsCalibrated,  // the rim has the calibrated radius, or had it a moment ago and darkness hides it
  Changed,       // another radius
};
[[nodiscard]] std::string_view to_text(ZoomState state);

enum class MarkPolarity { Unknown, DarkInward, BrightOutward };

struct LensObservation {
  std::int64_t timestamp_ns = 0;
  bool circle_found = false;
  camera::Boundary circle;         // measured in this frame when circle_found, else predicted
  double circle_coverage_deg = 0;  // how much of the rim was seen
  MarkState mark = MarkState::NoCircle;
  MarkPolarity polarity = MarkPolarity::Unknown;
  double mark_angle_deg = 0;    // filtered, [0, 360); measured when mark == Found, else the last known one
  double mark_sigma_deg = 360;  // grows while the mark is not found
  bool is_stale = true;         // no mark for longer than the options allow: intrinsics can't be trusted
  bool zoom_or_slip = false;    // radius or centre off their track: another zoom, or the coupler slipped
  RimState rim = RimState::OnTrack;  // which of them; told from the second clear frame on, and while it lasts
  ZoomState zoom = ZoomState::NotWatched;  // told in this very frame
  double radius_ratio = 1;                 // of the circle to that of the track, when last seen
  double off_track_px = 0;                 // of the circle's centre from the track, when last seen
  [[nodiscard]] bool has_angle() const { return mark == MarkState::Found || !is_stale; }
};

// What is wrong, in plain words for the screen, most serious first; empty while nothing is.
[[nodiscard]] std::string reason_text(const LensObservation& lens);

struct LensTrackerOptions {
  std::optional<camera::Calibration>
      calibration;  // predicts the circle and its track; without it: found from nothing
  // How long a lost mark's angle is held, and the zoom while darkness hides the rim.
  double stale_after_s = 1.0;
  // Which polarity to believe where both are possible; Unknown lets the tracker learn it.
  MarkPolarity polarity = MarkPolarity::Unknown;
};

// Stateful over frames of one source; one thread at a time. No allocation after the first frame of a size.
class LensTracker {
 public:
  explicit LensTracker(const LensTrackerOptions& options = {});
  ~LensTracker();
  LensTracker(LensTracker&&) noexcept;
  LensTracker& operator=(LensTracker&&) noexcept;

  // Frames must come in order of time. Never throws on what a picture shows.
  const LensObservation& observe(const camera::GrayView& frame, std::int64_t timestamp_ns);
  void reset();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// One picture on its own, everything from nothing: for calibration stills.
[[nodiscard]] LensObservation observe_still(const camera::GrayView& picture);

}  // namespace arthronaut::lens
