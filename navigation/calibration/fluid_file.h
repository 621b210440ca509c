// fluid.json (format "arthronaut.fluid", version 1): the verdict of the self-check in fluid, kept with its
// date, its medium, what it was measured with and of which calibration.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "navigation/calibration/fluid_check.h"
#include "navigation/provenance/provenance.h"

namespace arthronaut::calibration {

struct FluidRecord {
  double refractive_index = 0;                                   // of the medium that was said to be there
  bool is_trusted = false;                                       // what it measures in that medium is right
  std::vector<std::string> reasons = {"the check was not run"};  // why not; empty when it is
  // The numbers of FluidCheckSummary; median_* are of the flat port. -1, or 0 for the index: not known.
  double best_index = 0, index_sigma = -1, median_mm = -1, median_deg = -1;
  std::size_t frame_count = 0;
  std::string source;  // what the pictures came from: "knee.mkv", "Simulated arthroscope"
  provenance::Provenance provenance = {provenance::Origin::Measured, ""};  // calibrated_utc: of the check
  std::string camera_sha256;  // of the camera.json that was checked
};

// What a check found, without where and when.
[[nodiscard]] FluidRecord record_of(const FluidCheckSummary& summary, double refractive_index);

// Throws IoError or InvalidInput (file, place, reason); a verdict that is trusted for reasons, or doubted for
// none, is refused.
[[nodiscard]] FluidRecord read_fluid_file(const std::filesystem::path& file);
// Atomic. Throws IoError.
void write_fluid_file(const std::filesystem::path& file, const FluidRecord& record);

}  // namespace arthronaut::calibration
