// Whether a calibration can be trusted, and why not. Inside the module.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "navigation/calibration/adjustment.h"
#include "navigation/calibration/calibration.h"

namespace arthronaut::calibration {

// Limits of a calibration that is fit for guidance. The distances are those at which an arthroscope is in
// focus on a board that fills its view.
inline constexpr double kMostRms_px = 0.5;
inline constexpr double kMostLeaveOneOutRms_px = 0.7;
inline constexpr double kMostFocalSigma = 0.003;    // of the focal length
inline constexpr double kMostCenterSigma_px = 1.5;  // of the rotation centre and the principal point
inline constexpr double kLeastTilt_deg = 12;        // of the most tilted board
// Pictures that show the lens mark. Two of them at different lens angles fix the centre of rotation, and with
// it the angles of all others; how well is in the covariance, which has its own limits.
inline constexpr long kFewestMarks = 2;
inline constexpr double kLeastTurn_deg = 60;                 // between the two most different lens angles
inline constexpr double kNearest_mm = 9, kFurthest_mm = 30;  // of the board from the lens

// Plain words, most important first; empty: nothing speaks against it.
[[nodiscard]] std::vector<std::string> reasons_against(const CalibrationSummary& summary,
                                                       std::span<const Sighting> sightings, bool turns);

}  // namespace arthronaut::calibration
