#include "app/setup/fluid_job.h"

#include <utility>

namespace arthronaut::setup {

void FluidJob::look(const camera::FramePtr& frame) {
  status_.picture = frame;
  if (status_.summary != nullptr) return;  // checked; the picture is shown, no more
  status_.look = sightings_.look(*frame);
  status_.view = status_.look.lens.circle_found ? status_.look.lens.circle : camera::Boundary{};
  if (status_.look.is_taken && first_ns_ < 0) first_ns_ = frame->timestamp_ns;
  status_.sighting_count = sightings_.sightings().size();
  if (first_ns_ >= 0) status_.seconds = static_cast<double>(frame->timestamp_ns - first_ns_) * 1e-9;
  if (status_.seconds >= kFluidCheck_s || sightings_.is_full()) check();
}

void FluidJob::check() { status_.is_checking = status_.summary == nullptr; }

bool FluidJob::work() {
  if (!std::exchange(status_.is_checking, false)) return false;
  const calibration::RulerSightingsOptions& seen = sightings_.options();
  calibration::FluidCheckOptions options;
  options.refractive_index = seen.refractive_index;
  status_.summary = std::make_shared<const calibration::FluidCheckSummary>(
      calibration::check_fluid(sightings_.sightings(), seen.ruler, seen.calibration, options));
  return true;
}

FluidStatus FluidJob::status() const {
  FluidStatus status = status_;
  status.refractive_index = sightings_.options().refractive_index;
  return status;
}

void FluidJob::clear() {
  sightings_.clear();
  first_ns_ = -1;
  status_.sighting_count = 0;
  status_.seconds = 0;
  status_.is_checking = false;
  status_.summary.reset();
}

}  // namespace arthronaut::setup
