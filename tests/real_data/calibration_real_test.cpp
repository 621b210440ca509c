// Calibration on path-traced pictures with the true camera, and the board finder on real chessboards.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>

#include "navigation/calibration/calibration.h"
#include "navigation/calibration/held_out.h"
#include "navigation/camera/camera_file.h"
#include "navigation/sources/frame_source.h"
#include "tests/real_data/real_data.h"

namespace arthronaut {
namespace {

calibration::CalibrationPicture observe(const std::filesystem::path& file) {
  const camera::Frame frame = sources::read_picture(file);
  std::vector<std::uint8_t> gray;
  camera::gray_from(frame, gray);
  return calibration::observe_picture(file.filename().string(), {gray.data(), frame.width, frame.height, frame.width});
}

std::vector<std::filesystem::path> pictures_in(const std::filesystem::path& folder, const std::string& prefix) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string(), extension = entry.path().extension().string();
    if (name.starts_with(prefix) && (extension == ".png" || extension == ".jpg")) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// Three pictures in air against the true camera, and stills at other lens angles whose board poses alone are solved.
TEST(CalibrationOnPictures, FindsTheTrueCamera) {
  ARTHRONAUT_REQUIRE_DATA(folder, "arthroscopy/cal_air");
  std::vector<calibration::CalibrationPicture> pictures;
  for (const auto& file : pictures_in(folder, "cal_")) pictures.push_back(observe(file));
  calibration::CalibrationOptions options;
  options.square_mm = 1.5;
  const calibration::CalibrationSummary summary = calibration::calibrate(pictures, options);
  ASSERT_EQ(summary.outcome, calibration::CalibrationSummary::Outcome::Ok)
      << (summary.reasons.empty() ? "" : summary.reasons.front());

  const camera::Calibration truth = camera::read_camera_file(folder / "camera.json").calibration;
  const camera::Calibration& found = summary.record.calibration;
  double principal_px = 0;
  for (double mark_deg = 0; mark_deg < 360; mark_deg += 15)
    principal_px = std::max(principal_px, (found.turned(found.principal_point_px, found.lens_angle_rad(mark_deg)) -
                                           truth.turned(truth.principal_point_px, truth.lens_angle_rad(mark_deg)))
                                              .norm());
  const double center_px = (found.rotation_center_px - truth.rotation_center_px).norm();
  std::cout << "focal length off by " << 100 * (found.focal_px / truth.focal_px - 1) << " %, xi by "
            << found.distortion_xi - truth.distortion_xi << ", principal point by " << principal_px
            << " px at the worst lens angle, centre of rotation by " << center_px << " px; left-out RMS "
            << summary.leave_one_out_rms_px << " px\n";
  EXPECT_NEAR(found.focal_px / truth.focal_px, 1, 0.003);
  EXPECT_NEAR(found.distortion_xi, truth.distortion_xi, 0.006);
  EXPECT_LT(principal_px, 1.0);
  EXPECT_LT(center_px, 1.5);

  for (const auto& file : pictures_in(folder, "held_")) {
    const calibration::HeldOut held = calibration::check_held_out(observe(file), summary.record.calibration, 1.5);
    std::cout << file.filename().string() << ": " << held.corner_count << " corners, reprojection RMS " << held.rms_px
              << " px\n";
    EXPECT_GT(held.corner_count, 400U);
    EXPECT_GT(held.rms_px, 0);
    EXPECT_LE(held.rms_px, 0.35);
  }
}

// Photographs of a 9 x 6 board with clutter around it: all 54 corners in every picture.
TEST(BoardFinderOnPictures, FindsTheOpenCvChessboards) {
  ARTHRONAUT_REQUIRE_DATA(folder, "checkerboards/opencv-stereo");
  for (const char* side : {"left", "right"})
    for (const auto& file : pictures_in(folder, side))
      EXPECT_EQ(observe(file).board.corners.size(), 54U) << file.filename().string() << ": " << observe(file).board.reason;
}

// Boards through a laparoscope, whose 140 corners somebody else's detector gave: all found, within half a pixel in the
// median (the given ones themselves scatter by 0.2 to 0.4 px against OpenCV's).
TEST(BoardFinderOnPictures, FindsTheLaparoscopeChessboards) {
  ARTHRONAUT_REQUIRE_DATA(folder, "checkerboards/viking-laparoscope");
  for (const auto& file : pictures_in(folder, "left-")) {
    const calibration::CalibrationPicture picture = observe(file);
    std::ifstream given(file.string() + ".points.txt");
    std::vector<double> distances_px;
    Eigen::Vector2d point;
    while (given >> point.x() >> point.y()) {
      double nearest = 1e9;
      for (const auto& corner : picture.board.corners) nearest = std::min(nearest, (corner.pixel - point).norm());
      distances_px.push_back(nearest);
    }
    ASSERT_EQ(distances_px.size(), 140U);
    EXPECT_EQ(picture.board.corners.size(), 140U) << file.filename().string();
    std::sort(distances_px.begin(), distances_px.end());
    EXPECT_LT(distances_px[70], 0.5) << file.filename().string();
    EXPECT_LT(distances_px.back(), 3.0) << file.filename().string();
  }
}

// Dots are no checkerboard: refused with a reason.
TEST(BoardFinderOnPictures, RefusesDots) {
  ARTHRONAUT_REQUIRE_DATA(folder, "endoscope/dots-768");
  for (const auto& file : pictures_in(folder, "frame_")) {
    const calibration::BoardDetection board = observe(file).board;
    EXPECT_FALSE(board.found()) << file.filename().string();
    EXPECT_FALSE(board.reason.empty());
  }
}

}  // namespace
}  // namespace arthronaut
