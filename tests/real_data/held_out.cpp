#include "tests/real_data/held_out.h"

#include "navigation/calibration/adjustment.h"
#include "navigation/calibration/conformal_map.h"

namespace arthronaut::calibration {

HeldOut check_held_out(const CalibrationPicture& picture, const camera::Calibration& calibration,
                       double square_mm) {
  HeldOut held;
  if (picture.lens.mark != lens::MarkState::Found) return held;
  Estimate estimate;
  estimate.focal_px = calibration.focal_px;
  estimate.xi = calibration.distortion_xi;
  estimate.principal_point_px = calibration.principal_point_px;
  estimate.rotation_center_px = calibration.rotation_center_px;
  estimate.circle_center_px = calibration.boundary.center_px;
  estimate.reference_mark_angle_deg = calibration.reference_mark_angle_deg;
  const double angle_rad = calibration.lens_angle_rad(picture.lens.mark_angle_deg);
  estimate.lens_angle_rad = {angle_rad};

  // Corners on the plane Z = 1 through the known camera, then the homography's pose.
  const camera::CameraModel model(calibration, angle_rad, calibration.refractive_index);
  Sighting seen;
  std::vector<Eigen::Vector2d> on_plane;
  for (const BoardCorner& corner : corners_used(picture)) {
    const auto tangent = model.undistort(corner.pixel);
    if (!tangent) continue;
    on_plane.push_back(*tangent * calibration.focal_px);
    seen.pixels.push_back(corner.pixel);
    seen.board_mm.push_back(corner.lattice.cast<double>() * square_mm);
    seen.sigma_px.push_back(corner.sigma_px);
  }
  held.corner_count = seen.pixels.size();
  const auto flat = camera_without_distortion(on_plane, seen.board_mm, Eigen::Vector2d::Zero());
  if (!flat) return held;
  estimate.camera_from_board = {pose_from_homography(flat->homography, calibration.focal_px)};
  AdjustmentOptions options;
  options.fix_intrinsics = true;
  options.turns = false;  // the angle is the mark's, as in the theatre
  const AdjustmentResult result = adjust(std::span(&seen, 1), estimate, options);
  held.rms_px = result.rms_px;
  held.camera_from_board = result.estimate.camera_from_board.front();
  return held;
}

}  // namespace arthronaut::calibration
