// camera.json (format "arthronaut.camera", version 1). A calibration may carry more than the model needs:
// residual, date, names of scope and head; these travel in CalibrationRecord.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <string_view>

#include "navigation/camera/camera_model.h"
#include "navigation/provenance/provenance.h"

namespace arthronaut::camera {

struct CalibrationRecord {
  Calibration calibration;
  double rms_px = -1;    // reprojection error of the calibration; -1 when unknown
  std::string date_utc;  // ISO 8601; empty when unknown
  std::string scope_name, head_name;
  // A file without "origin" is of a measured camera; without "calibrated_utc" it dates from date_utc. A scope
  // of the simulated arthroscope's name is simulated whatever the file says.
  provenance::Provenance provenance{provenance::Origin::Measured, ""};
};

// The name that camera.json carries for the simulated arthroscope, in any case of letters.
inline constexpr std::string_view kSimulatedScope = "Simulated arthroscope";

// Throws IoError or InvalidInput (file, place, reason).
[[nodiscard]] CalibrationRecord read_camera_file(const std::filesystem::path& file);
// Atomic; "-" is standard output. Throws IoError.
void write_camera_file(const std::filesystem::path& file, const CalibrationRecord& record);

}  // namespace arthronaut::camera
