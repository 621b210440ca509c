// Five seconds of a ruler with two markers before the lens, in fluid, without threads: a Job of LiveRun.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <utility>

#include "navigation/calibration/ruler_sightings.h"

namespace arthronaut::setup {

inline constexpr double kFluidCheck_s = 5;

struct FluidStatus {
  camera::FramePtr picture;
  calibration::RulerLook look;  // of this picture
  camera::Boundary view;        // the round view; radius 0: not known
  std::size_t sighting_count = 0;
  double seconds = 0;  // of the source, since the first sighting
  bool is_checking = false;
  double refractive_index = 0;  // of the medium that is said to be there
  std::string camera_sha256;    // of the camera.json that is measured through; empty: the built-in camera
  std::shared_ptr<const calibration::FluidCheckSummary> summary;  // null: not checked yet
};

class FluidJob {
 public:
  using Status = FluidStatus;

  // Throws InvalidInput for an unusable calibration or index.
  explicit FluidJob(const calibration::RulerSightingsOptions& options, std::string camera_sha256 = "")
      : sightings_(options) {
    status_.camera_sha256 = std::move(camera_sha256);
  }

  void look(const camera::FramePtr& frame);
  bool work();  // the check, once five seconds were seen or it was asked for
  [[nodiscard]] bool wants_next_still() const { return true; }
  [[nodiscard]] Status status() const;

  void check();  // with what there is; done in work()
  void clear();

 private:
  calibration::RulerSightings sightings_;
  std::int64_t first_ns_ = -1;
  FluidStatus status_;
};

}  // namespace arthronaut::setup
