// Whether a calibration can be trusted, and why not. Inside the module.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "navigation/calibration/adjustment.h"
#include "navigation/calibration/calibration.h"

namespace arthronaut::calibration {

// Limits of a calibration that is fit for guidance.
inline constexpr double kMostRms_px = 0.5;
inline constexpr double kMostLeaveOneOutRms_px = 0.7;
inline constexpr double kMostFocalSigma = 0.003;    // of the focal length
inline constexpr double kMostCenterSigma_px = 1.5;  // of the rotation centre and the principal point
inline constexpr double kLeastTilt_deg = 12;        // of the most tilted board
// Pictures that show the lens mark. Two of them at different lens angles fix the centre of rotation, and with
// it the angles of all others; how well is in the covariance, which has its own limits.
inline constexpr long kFewestMarks = 2;
inline constexpr double kLeastTurn_deg = 60;  // between the two most different lens angles
// Of the boards from the lens, along its axis, in the median. Pictures of a plane tell everything but its
// scale: a wrong square size leaves corners, focal length and distortion as they are (and camera.json, which
// holds no length) and shows in this distance alone, which is therefore always printed. The bounds are where
// boards are held in practice, 12 to 22 mm, with a fifth to spare. Told is a factor above 26 mm / the true
// distance or below 10 mm / it: at 16 mm above 1.63 or below 0.63; above 2.2 or below 0.45 wherever the board
// was held. A factor of 1.5 at 16 mm gives 24 mm, where others hold their boards: no picture tells it, only a
// distance that somebody measured does.
inline constexpr double kNearest_mm = 10, kFurthest_mm = 26;
inline constexpr double kMostDistanceRatio = 1.3;  // against a distance that was measured, either way

// Plain words, most important first; empty: nothing speaks against it.
[[nodiscard]] std::vector<std::string> reasons_against(const CalibrationSummary& summary,
                                                       std::span<const Sighting> sightings,
                                                       const CalibrationOptions& options, bool turns);

}  // namespace arthronaut::calibration
