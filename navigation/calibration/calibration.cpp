#include "navigation/calibration/calibration.h"

#include <algorithm>
#include <cmath>

#include "navigation/calibration/adjustment.h"
#include "navigation/calibration/joint_solution.h"
#include "navigation/calibration/verdict.h"
#include "planning/files/format.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"
#include "planning/geometry/quantile.h"

namespace arthronaut::calibration {
namespace {

void check_contract(std::span<const CalibrationPicture> pictures, const CalibrationOptions& options) {
  if (!(options.square_mm > 0) || !std::isfinite(options.square_mm))
    throw InvalidInput("calibration: the side of a square must be above 0 mm");
  if (!(options.refractive_index >= 1 && options.refractive_index <= 2))
    throw InvalidInput("calibration: the refractive index must lie in [1, 2]");
  if (!(options.distance_mm >= 0) || !std::isfinite(options.distance_mm))
    throw InvalidInput("calibration: the distance of the boards must not be below 0 mm");
  if (pictures.size() < 3)
    throw InvalidInput("a calibration needs three pictures or more, there are " +
                       std::to_string(pictures.size()));
  for (const CalibrationPicture& picture : pictures) {
    if (picture.size_px != pictures.front().size_px)
      throw InvalidInput(picture.name + ": is " + std::to_string(picture.size_px.x()) + " x " +
                         std::to_string(picture.size_px.y()) + " px, " + pictures.front().name + " is " +
                         std::to_string(pictures.front().size_px.x()) + " x " +
                         std::to_string(pictures.front().size_px.y()) +
                         ": all pictures must come from one camera at one setting");
    if (!picture.board.found()) throw InvalidInput(picture.name + ": " + picture.board.reason);
  }
}

Sighting sighting_of(const CalibrationPicture& picture, double square_mm) {
  Sighting sighting;
  for (const BoardCorner& corner : corners_used(picture)) {
    sighting.pixels.push_back(corner.pixel);
    sighting.board_mm.push_back(corner.lattice.cast<double>() * square_mm);
    sighting.sigma_px.push_back(corner.sigma_px);
  }
  sighting.has_angle = picture.lens.mark == lens::MarkState::Found;
  sighting.mark_angle_deg = picture.lens.mark_angle_deg;
  sighting.has_circle = picture.lens.circle_found;
  sighting.circle_center_px = picture.lens.circle.center_px;
  return sighting;
}

// Where no round border is seen, the circle about the whole image stands in for it.
double median_radius_px(std::span<const CalibrationPicture> pictures) {
  std::vector<double> radii;
  for (const CalibrationPicture& picture : pictures)
    if (picture.lens.circle_found) radii.push_back(picture.lens.circle.radius_px);
  return geometry::median(std::move(radii), 0.5 * pictures.front().size_px.cast<double>().norm());
}

// Each picture in turn against the camera that the others give: RMS over all their corners, -1 when that
// fails. A picture without which the rest would not tell the centre of rotation is not left out.
double leave_one_out(std::span<const Sighting> sightings, const Estimate& estimate,
                     const AdjustmentOptions& options) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t out = 0; out < sightings.size(); ++out) {
    std::vector<Sighting> rest;
    Estimate start = estimate, of_one = estimate;
    start.lens_angle_rad.clear();
    start.camera_from_board.clear();
    for (std::size_t i = 0; i < sightings.size(); ++i) {
      if (i == out) continue;
      rest.push_back(sightings[i]);
      start.lens_angle_rad.push_back(estimate.lens_angle_rad[i]);
      start.camera_from_board.push_back(estimate.camera_from_board[i]);
    }
    if (options.turns && measured_turn_deg(rest) < kLeastMeasurableTurn_deg) continue;
    const AdjustmentResult without = adjust(rest, start, options);
    of_one = without.estimate;
    of_one.lens_angle_rad = {estimate.lens_angle_rad[out]};
    of_one.camera_from_board = {estimate.camera_from_board[out]};
    AdjustmentOptions pose_alone = options;
    pose_alone.fix_intrinsics = true;
    const AdjustmentResult held = adjust(sightings.subspan(out, 1), of_one, pose_alone);
    if (without.rms_px < 0 || held.rms_px < 0) return -1;
    const std::size_t corners = sightings[out].pixels.size();
    sum += held.rms_px * held.rms_px * static_cast<double>(corners);
    count += corners;
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : -1;
}

// Where the optical axis meets each board; the corners' own mean is drawn far away by boards that run to the
// horizon.
double median_distance_mm(const CalibrationSummary& summary) {
  std::vector<double> distances;
  for (const auto& picture : summary.pictures) {
    const Eigen::Vector3d normal = picture.camera_from_board.rotate(Eigen::Vector3d::UnitZ());
    distances.push_back(std::abs(normal.dot(picture.camera_from_board.translation_mm) / normal.z()));
  }
  return geometry::median(std::move(distances));
}

// A picture whose mark was not found, or not believed, is named with the lens angle that the others give it.
std::vector<std::string> notes_on(std::span<const CalibrationPicture> pictures, const JointSolution& joint) {
  std::vector<std::string> notes;
  if (!joint.options.turns) return notes;
  const AdjustmentResult& result = joint.result;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    if (joint.sightings[i].has_angle) continue;
    const bool was_seen = pictures[i].lens.mark == lens::MarkState::Found;
    const double angle_deg = std::fmod(result.estimate.reference_mark_angle_deg + 720 +
                                           geometry::deg_from_rad(result.estimate.lens_angle_rad[i]),
                                       360.0);
    const double sigma_deg = i < result.lens_angle_sigma_rad.size()
                                 ? geometry::deg_from_rad(result.lens_angle_sigma_rad[i])
                                 : 180.0;
    notes.push_back(pictures[i].name + ": lens mark: " +
                    (was_seen ? "what looks like it contradicts the other pictures"
                              : std::string(lens::to_text(pictures[i].lens.mark))) +
                    files::format("; its angle (%.0f degrees, +- %.1f) follows from the other pictures",
                                  angle_deg, sigma_deg));
  }
  return notes;
}

double rms_of(const std::vector<Eigen::Vector2d>& residuals_px) {
  double sum = 0;
  for (const auto& r : residuals_px) sum += r.squaredNorm();
  return residuals_px.empty() ? -1 : std::sqrt(sum / static_cast<double>(residuals_px.size()));
}

}  // namespace

std::vector<BoardCorner> corners_used(const CalibrationPicture& picture) {
  std::vector<BoardCorner> used;
  const double reach_px = picture.lens.circle.radius_px - 6;
  for (const BoardCorner& corner : picture.board.corners)
    if (!picture.lens.circle_found || (corner.pixel - picture.lens.circle.center_px).norm() < reach_px)
      used.push_back(corner);
  return used;
}

CalibrationPicture observe_picture(const std::string& name, const camera::GrayView& picture) {
  return {name, {picture.width, picture.height}, find_checkerboard(picture), lens::observe_still(picture)};
}

CalibrationSummary calibrate(std::span<const CalibrationPicture> pictures,
                             const CalibrationOptions& options) {
  check_contract(pictures, options);
  CalibrationSummary summary;
  std::vector<Sighting> sightings;
  for (const CalibrationPicture& picture : pictures) {
    sightings.push_back(sighting_of(picture, options.square_mm));
    if (sightings.back().pixels.size() < 16)
      throw InvalidInput(picture.name + ": fewer than 16 corners of the board lie inside the round view");
  }
  const JointSolution joint = solve_jointly(sightings, pictures.front().size_px);
  const AdjustmentResult& best = joint.result;
  if (best.rms_px < 0) {
    summary.outcome = CalibrationSummary::Outcome::Failed;
    summary.reasons.push_back("no camera explains the pictures; are they of one flat checkerboard?");
    return summary;
  }

  const Estimate& found = best.estimate;
  camera::Calibration& calibration = summary.record.calibration;
  calibration.image_size_px = pictures.front().size_px;
  calibration.focal_px = found.focal_px;
  calibration.distortion_xi = found.xi;
  calibration.principal_point_px = found.principal_point_px;
  calibration.rotation_center_px = found.rotation_center_px;
  calibration.reference_mark_angle_deg = found.reference_mark_angle_deg;
  calibration.refractive_index = options.refractive_index;
  calibration.boundary = {found.circle_center_px, median_radius_px(pictures)};
  if (best.covariance.rows() == 6) {
    calibration.covariance = best.covariance;
    if (!joint.options.turns) {
      const double guess_px = 0.03 * calibration.boundary.radius_px;
      calibration.covariance->bottomRightCorner<2, 2>() = guess_px * guess_px * Eigen::Matrix2d::Identity();
    }
  }
  summary.record.rms_px = summary.rms_px = best.rms_px;
  summary.record.date_utc = files::utc_now();
  summary.record.provenance = {provenance::Origin::Measured, summary.record.date_utc};
  summary.record.scope_name = options.scope_name;
  summary.record.head_name = options.head_name;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const geometry::RigidTransform& pose = found.camera_from_board[i];
    const double tilt_rad =
        geometry::angle_between_rad(pose.rotate(Eigen::Vector3d::UnitZ()), Eigen::Vector3d::UnitZ());
    const double tilt_deg = geometry::deg_from_rad(std::min(tilt_rad, geometry::kPi - tilt_rad));
    summary.pictures.push_back({pictures[i].name, rms_of(best.residuals_px[i]), tilt_deg,
                                geometry::deg_from_rad(found.lens_angle_rad[i]), pictures[i].lens.mark,
                                joint.sightings[i].has_angle, pose, best.residuals_px[i]});
  }
  if (options.leave_one_out)
    summary.leave_one_out_rms_px = leave_one_out(joint.sightings, found, joint.options);
  summary.distance_mm = median_distance_mm(summary);
  summary.notes = notes_on(pictures, joint);
  summary.reasons = reasons_against(summary, joint.sightings, options, joint.options.turns);
  summary.outcome =
      summary.reasons.empty() ? CalibrationSummary::Outcome::Ok : CalibrationSummary::Outcome::Unreliable;
  return summary;
}

}  // namespace arthronaut::calibration
