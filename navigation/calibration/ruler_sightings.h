// Collects from live or recorded frames what check_fluid() asks for: raw corners of the ruler's two markers,
// each frame with the lens angle of that very frame.
//
// The corners are measured in the raw picture. What the fluid does to them matters only for recognising the
// markers, so a frame in which the stated medium recognises none is looked at once more as if the medium were
// another: a check that finds nothing when the medium is wrong would be none.
//
// Only pictures of now, with the lens as it was calibrated, are taken: none that is frozen or repeats the one
// before, none whose zoom is unknown or another one.
//
// look() takes about as long as tracking (1 to 6 ms on a 1080p frame). One thread at a time.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "navigation/calibration/fluid_check.h"
#include "navigation/camera/frame.h"
#include "navigation/lens/lens_tracker.h"
#include "navigation/markers/marker_tracker.h"

namespace arthronaut::calibration {

struct RulerSightingsOptions {
  camera::Calibration calibration;
  double refractive_index = 1.3345;  // of the medium that is said to be there
  Ruler ruler;
  bool follow_lens = true;  // false: the lens stays at the reference angle, the mark is not needed
  // Sightings kept; later ones are looked at and shown, but not added. Five seconds of 60 frames.
  std::size_t most = 300;
};

// What the last frame was good for.
struct RulerLook {
  lens::LensObservation lens;
  std::array<markers::MarkerObservation, 2> markers;  // first, second; corners for the screen
  bool is_taken = false;
  std::string reason = "no frame was looked at";  // why it was not taken, in plain words; empty when it was
};

class RulerSightings {
 public:
  // Throws InvalidInput for an unusable calibration or index, ids that are equal or not in the dictionary, a
  // marker size not above 0.
  explicit RulerSightings(const RulerSightingsOptions& options);
  ~RulerSightings();
  RulerSightings(RulerSightings&&) noexcept;
  RulerSightings& operator=(RulerSightings&&) noexcept;

  // Frames of one source in order of time. Throws InvalidInput when the frame's size is not the
  // calibration's; never on what a picture shows. The answer is valid until the next call.
  const RulerLook& look(const camera::Frame& frame);
  void clear();  // forgets the sightings, not what it knows of lens and markers

  [[nodiscard]] const std::vector<RulerSighting>& sightings() const;
  [[nodiscard]] std::size_t frame_count() const;  // looked at since the start or clear()
  [[nodiscard]] bool is_full() const;
  [[nodiscard]] const RulerSightingsOptions& options() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace arthronaut::calibration
