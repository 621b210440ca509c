#include "navigation/calibration/verdict.h"

#include <algorithm>
#include <cmath>

#include "planning/files/format.h"
#include "planning/geometry/quantile.h"

namespace arthronaut::calibration {
namespace {

// The largest difference between two of the lens angles, degrees. Those that marks did not give count too:
// how well they are known is in the covariance of the centre of rotation.
double widest_turn_deg(const CalibrationSummary& summary) {
  double widest = 0;
  for (const auto& a : summary.pictures)
    for (const auto& b : summary.pictures)
      widest = std::max(widest, std::abs(std::remainder(a.lens_angle_deg - b.lens_angle_deg, 360.0)));
  return widest;
}

// How far out from the principal point the corners reach, as a share of the view's radius.
double reach_share(const CalibrationSummary& summary, std::span<const Sighting> sightings) {
  const camera::Calibration& c = summary.record.calibration;
  std::vector<double> distances;
  for (const Sighting& seen : sightings)
    for (const auto& pixel : seen.pixels) distances.push_back((pixel - c.principal_point_px).norm());
  return geometry::quantile(std::move(distances), 0.95) / c.boundary.radius_px;
}

}  // namespace

std::vector<std::string> reasons_against(const CalibrationSummary& summary,
                                         std::span<const Sighting> sightings,
                                         const CalibrationOptions& options, bool turns) {
  std::vector<std::string> reasons;
  const camera::Calibration& c = summary.record.calibration;
  const long marked =
      std::count_if(sightings.begin(), sightings.end(), [](const Sighting& s) { return s.has_angle; });
  if (marked < kFewestMarks) {
    for (std::size_t i = 0; i < sightings.size(); ++i)
      if (!sightings[i].has_angle)
        reasons.push_back(summary.pictures[i].name + ": the lens mark was not found (" +
                          std::string(lens::to_text(summary.pictures[i].mark)) + ")");
    reasons.push_back("the lens angles are not known, so the centre of rotation is not");
  } else if (const double turn = widest_turn_deg(summary); turn < kLeastTurn_deg) {
    reasons.push_back(files::format(
        "the lens was turned by no more than %.0f degrees between the pictures (needs %.0f), so the "
        "centre of rotation is not known",
        turn, kLeastTurn_deg));
  }

  double tilt_deg = 0;
  for (const auto& picture : summary.pictures) tilt_deg = std::max(tilt_deg, picture.tilt_deg);
  if (tilt_deg < kLeastTilt_deg)
    reasons.push_back(files::format(
        "all boards face the lens (tilted by %.0f degrees at most, needs %.0f), so the focal length is "
        "not known",
        tilt_deg, kLeastTilt_deg));
  const double mm = summary.distance_mm, ratio = options.distance_mm > 0 ? mm / options.distance_mm : 1;
  if (ratio > kMostDistanceRatio || ratio < 1 / kMostDistanceRatio)
    reasons.push_back(files::format(
        "the boards would stand %.0f mm from the lens, not %.0f mm as measured: is the side of a square "
        "right?",
        mm, options.distance_mm));
  else if (options.distance_mm <= 0 && (mm < kNearest_mm || mm > kFurthest_mm))
    reasons.push_back(files::format(
        "the boards would stand %.0f mm from the lens, where no arthroscope's calibration is taken (%.0f to "
        "%.0f mm): is the side of a square right?",
        mm, kNearest_mm, kFurthest_mm));
  if (const double reach = reach_share(summary, sightings); reach < 0.6)
    reasons.push_back(files::format(
        "the board covers the middle of the view only (%.0f %% of its radius), so the distortion is not "
        "known",
        100 * reach));

  if (!(summary.rms_px <= kMostRms_px))
    reasons.push_back(
        files::format("corners miss the model by %.2f px (at most %.2f)", summary.rms_px, kMostRms_px));
  if (options.leave_one_out && !(summary.leave_one_out_rms_px >= 0))
    reasons.push_back("no picture could be held against the camera that the others give");
  else if (summary.leave_one_out_rms_px > kMostLeaveOneOutRms_px)
    reasons.push_back(files::format("a picture left out is missed by %.2f px (at most %.2f)",
                                    summary.leave_one_out_rms_px, kMostLeaveOneOutRms_px));
  for (const auto& picture : summary.pictures)
    if (picture.rms_px > 2.5 * summary.rms_px && picture.rms_px > kMostRms_px)
      reasons.push_back(picture.name + ": does not agree with the other pictures");

  if (c.covariance) {
    const Eigen::VectorXd sigma = c.covariance->diagonal().cwiseMax(0).cwiseSqrt();
    if (!(sigma(0) <= kMostFocalSigma * c.focal_px))
      reasons.push_back(files::format("the focal length is known to %.1f px only (1 sigma, of %.0f)",
                                      sigma(0), c.focal_px));
    if (!(std::max(sigma(2), sigma(3)) <= kMostCenterSigma_px))
      reasons.push_back(files::format("the principal point is known to %.1f px only (1 sigma)",
                                      std::max(sigma(2), sigma(3))));
    if (turns && !(std::max(sigma(4), sigma(5)) <= kMostCenterSigma_px))
      reasons.push_back(files::format("the centre of rotation is known to %.1f px only (1 sigma)",
                                      std::max(sigma(4), sigma(5))));
  } else {
    reasons.push_back("how well the camera is known could not be computed: the pictures leave it open");
  }
  if ((c.principal_point_px - c.boundary.center_px).norm() > 0.12 * c.boundary.radius_px)
    reasons.push_back("the principal point lies far from the middle of the round view");
  if (c.distortion_xi < -1.2 || c.distortion_xi > 0.3)
    reasons.push_back(files::format("the distortion %.2f is not that of an endoscope", c.distortion_xi));
  return reasons;
}

}  // namespace arthronaut::calibration
