// How exact a calibration is at a given corner noise: the joint adjustment of three pictures over many noise
// draws, against what is known to be attainable (closed form and joint adjustment of the same geometry,
// measured elsewhere).
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/navigation/calibration/board_scene.h"

namespace arthronaut::calibration {
namespace {

camera::Calibration study_scope() {
  camera::Calibration c = true_scope();
  c.focal_px = 1050;
  c.distortion_xi = -0.45;
  c.boundary.radius_px = 520;
  return c;
}

struct Spread {
  double focal_px = 0, xi = 0, principal_px = 0, center_px = 0, rms_px = 0;
  double in_sigmas = 0, xi_in_sigmas = 0;  // focal length, xi: 1 is the best that least squares can do
  double corners = 0;                      // a picture
};

Spread study(double tilt_deg, double corner_sigma_px, int trials) {
  // 135 to 145 corners in the view, out to where calibrate() takes them, whatever the tilt.
  const double square_mm = tilt_deg < 10 ? 1.62 : tilt_deg < 25 ? 1.72 : 2.0;
  const camera::Calibration truth = study_scope();
  CalibrationOptions options;
  options.square_mm = square_mm;
  options.leave_one_out = false;
  Spread square;
  std::mt19937 random(static_cast<unsigned>(1000 * tilt_deg + 100 * corner_sigma_px));
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<CalibrationPicture> pictures;
    double axis_deg = 30;
    for (const double lens_angle_deg : {0.0, 60.0, -70.0}) {
      const BoardView view{board_pose(20, tilt_deg, axis_deg, 0.3 * axis_deg), lens_angle_deg};
      // A mark's angle to 0.1 degrees is 1 px on the rim; the circle's centre to half a pixel.
      pictures.push_back(picture_of(truth, view, square_mm, corner_sigma_px, 0.1, random, 0.975));
      pictures.back().lens.circle.center_px += 0.35 * Eigen::Vector2d(normal(random), normal(random));
      square.corners += static_cast<double>(pictures.back().board.corners.size()) / (3 * trials);
      axis_deg += 115;
    }
    const CalibrationSummary summary = calibrate(pictures, options);
    const camera::Calibration& found = summary.record.calibration;
    const Eigen::Vector2d c =
        truth.turned(truth.principal_point_px, truth.lens_angle_rad(found.reference_mark_angle_deg));
    const double focal_error = found.focal_px - truth.focal_px;
    square.focal_px += focal_error * focal_error / trials;
    square.in_sigmas += focal_error * focal_error / (*summary.record.calibration.covariance)(0, 0) / trials;
    square.xi_in_sigmas += std::pow(found.distortion_xi - truth.distortion_xi, 2) /
                           (*summary.record.calibration.covariance)(1, 1) / trials;
    square.xi += std::pow(found.distortion_xi - truth.distortion_xi, 2) / trials;
    square.principal_px += (found.principal_point_px - c).squaredNorm() / 2 / trials;
    square.center_px += (found.rotation_center_px - truth.rotation_center_px).squaredNorm() / 2 / trials;
    square.rms_px += summary.rms_px * summary.rms_px / 2 / trials;
  }
  return {std::sqrt(square.focal_px),     std::sqrt(square.xi),
          std::sqrt(square.principal_px), std::sqrt(square.center_px),
          std::sqrt(square.rms_px),       std::sqrt(square.in_sigmas),
          std::sqrt(square.xi_in_sigmas), square.corners};
}

struct Attainable {
  double tilt_deg, noise_px, focal_px, xi, principal_px, center_px;
};

// xi at 0.3 px was not measured elsewhere: three times that at 0.1 px, whose one digit leaves 0.00035 at 34
// degrees. A fifth is added for 80 draws' own
// scatter (8 % one sigma) and for the known figures' one digit. Nothing better is to be had from these
// corners: the errors are as large as the covariance says, which is the bound for them.
TEST(NoiseStudy, IsAtOrBelowWhatIsAttainable) {
  const Attainable table[] = {{6, 0.1, 3.4, 0.0029, 0.30, 0.25},   {17, 0.1, 0.49, 0.0005, 0.30, 0.25},
                              {34, 0.1, 0.14, 0.0003, 0.30, 0.25}, {6, 0.3, 10, 0.0087, 0.93, 0.4},
                              {17, 0.3, 1.5, 0.0015, 0.93, 0.4},   {34, 0.3, 0.43, 0.00105, 0.93, 0.4}};
  std::printf(
      "| tilt deg | noise px | focal px | xi | principal px | centre px | residual px | f, xi error in "
      "sigmas | corners "
      "|\n");
  for (const Attainable& row : table) {
    const Spread spread = study(row.tilt_deg, row.noise_px, 80);
    std::printf(
        "| %.0f | %.1f | %.2f (%.2f) | %.5f (%.5f) | %.3f (%.2f) | %.3f (%.2f) | %.3f | %.2f, %.2f | %.0f "
        "|\n",
        row.tilt_deg, row.noise_px, spread.focal_px, row.focal_px, spread.xi, row.xi, spread.principal_px,
        row.principal_px, spread.center_px, row.center_px, spread.rms_px, spread.in_sigmas,
        spread.xi_in_sigmas, spread.corners);
    EXPECT_LE(spread.focal_px, 1.2 * row.focal_px) << row.tilt_deg << ' ' << row.noise_px;
    EXPECT_LE(spread.xi, 1.2 * row.xi) << row.tilt_deg << ' ' << row.noise_px;
    EXPECT_LE(spread.principal_px, 1.2 * row.principal_px) << row.tilt_deg << ' ' << row.noise_px;
    EXPECT_LE(spread.center_px, 1.2 * row.center_px) << row.tilt_deg << ' ' << row.noise_px;
    EXPECT_NEAR(spread.xi_in_sigmas, 1, 0.25) << row.tilt_deg << ' ' << row.noise_px;
    EXPECT_NEAR(spread.rms_px, row.noise_px, 0.1 * row.noise_px);
  }
}

}  // namespace
}  // namespace arthronaut::calibration
