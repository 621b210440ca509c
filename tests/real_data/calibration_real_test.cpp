// Calibration on path-traced pictures with the true camera, and the board finder on real chessboards.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <opencv2/calib3d.hpp>

#include "navigation/calibration/calibration.h"
#include "navigation/calibration/fluid_check.h"
#include "navigation/calibration/ruler_sightings.h"
#include "navigation/camera/camera_file.h"
#include "navigation/camera/medium.h"
#include "navigation/markers/marker_tracker.h"
#include "navigation/sources/frame_source.h"
#include "tests/real_data/held_out.h"
#include "tests/real_data/real_data.h"

namespace arthronaut {
namespace {

calibration::CalibrationPicture observe(const std::filesystem::path& file) {
  const camera::Frame frame = sources::read_picture(file);
  std::vector<std::uint8_t> gray;
  camera::gray_from(frame, gray);
  return calibration::observe_picture(file.filename().string(),
                                      {gray.data(), frame.width, frame.height, frame.width});
}

std::vector<std::filesystem::path> pictures_in(const std::filesystem::path& folder,
                                               const std::string& prefix) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string(), extension = entry.path().extension().string();
    if (name.starts_with(prefix) && (extension == ".png" || extension == ".jpg"))
      files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<calibration::CalibrationPicture> observe_cal_air(const std::filesystem::path& folder) {
  std::vector<calibration::CalibrationPicture> pictures;
  for (const auto& file : pictures_in(folder, "cal_")) pictures.push_back(observe(file));
  return pictures;
}

calibration::CalibrationSummary calibrate_cal_air(const std::filesystem::path& folder) {
  calibration::CalibrationOptions options;
  options.square_mm = 1.5;
  return calibration::calibrate(observe_cal_air(folder), options);
}

// The ruler's markers in every frame of the clip, the intrinsics following the lens mark (or standing still).
std::vector<calibration::RulerSighting> ruler_sightings(const std::filesystem::path& clip,
                                                        const camera::Calibration& calibration,
                                                        bool follow_lens) {
  const auto source = sources::open_video(clip);
  const markers::DeclaredMarker declared[] = {{5, 2.89}, {6, 2.89}};
  const auto tracker = markers::make_tracker(declared);
  lens::LensTracker lens_tracker({calibration});
  std::vector<calibration::RulerSighting> sightings;
  std::vector<std::uint8_t> gray;
  while (const camera::FramePtr frame = source->next()) {
    camera::gray_from(*frame, gray);
    const camera::GrayView view{gray.data(), frame->width, frame->height, frame->width};
    const lens::LensObservation& lens = lens_tracker.observe(view, frame->timestamp_ns);
    const double mark_deg = follow_lens ? lens.mark_angle_deg : calibration.reference_mark_angle_deg;
    const camera::CameraModel camera(calibration, calibration.lens_angle_rad(mark_deg), camera::kSalineIndex);
    const auto seen = tracker->track(view, camera, frame->timestamp_ns);
    if (seen[0].is_tracked() && seen[1].is_tracked())
      sightings.push_back({mark_deg, seen[0].corners_px, seen[1].corners_px});
  }
  return sightings;
}

void print(const char* what, const calibration::FluidCheckSummary::Row& row, std::size_t frames) {
  std::printf("| %s | %zu | %.3f | %.3f | %.3f | %.3f | %.3f |\n", what, frames, row.median_deg,
              row.median_mm, row.worst_deg, row.worst_mm, row.rms_px);
}

// Three pictures in air against the true camera, and stills at other lens angles whose board poses alone are
// solved.
TEST(CalibrationOnPictures, FindsTheTrueCamera) {
  ARTHRONAUT_REQUIRE_DATA(folder, "arthroscopy/cal_air");
  const calibration::CalibrationSummary summary = calibrate_cal_air(folder);
  ASSERT_EQ(summary.outcome, calibration::CalibrationSummary::Outcome::Ok)
      << (summary.reasons.empty() ? "" : summary.reasons.front());

  const camera::Calibration truth = camera::read_camera_file(folder / "camera.json").calibration;
  const camera::Calibration& found = summary.record.calibration;
  double principal_px = 0;
  for (double mark_deg = 0; mark_deg < 360; mark_deg += 15)
    principal_px =
        std::max(principal_px, (found.turned(found.principal_point_px, found.lens_angle_rad(mark_deg)) -
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
    const calibration::HeldOut held =
        calibration::check_held_out(observe(file), summary.record.calibration, 1.5);
    std::cout << file.filename().string() << ": " << held.corner_count << " corners, reprojection RMS "
              << held.rms_px << " px\n";
    EXPECT_GT(held.corner_count, 400U);
    EXPECT_GT(held.rms_px, 0);
    EXPECT_LE(held.rms_px, 0.35);
    // Without the mark the lens could stand anyhow: no angle is made up.
    calibration::CalibrationPicture unmarked = observe(file);
    unmarked.lens.mark = lens::MarkState::Covered;
    EXPECT_LT(calibration::check_held_out(unmarked, summary.record.calibration, 1.5).rms_px, 0);
  }
}

// Any one of the three pictures without its mark: the same camera, reliable, and the picture is named.
TEST(CalibrationOnPictures, NeedsNoMarkInOneOfThree) {
  ARTHRONAUT_REQUIRE_DATA(folder, "arthroscopy/cal_air");
  const std::vector<calibration::CalibrationPicture> seen = observe_cal_air(folder);
  const camera::Calibration truth = camera::read_camera_file(folder / "camera.json").calibration;
  for (std::size_t lost = 0; lost < seen.size(); ++lost) {
    std::vector<calibration::CalibrationPicture> pictures = seen;
    pictures[lost].lens.mark = lens::MarkState::Covered;
    pictures[lost].lens.mark_angle_deg = 0;
    calibration::CalibrationOptions options;
    options.square_mm = 1.5;
    const calibration::CalibrationSummary summary = calibration::calibrate(pictures, options);
    EXPECT_EQ(summary.outcome, calibration::CalibrationSummary::Outcome::Ok) << lost;
    ASSERT_EQ(summary.notes.size(), 1U);
    EXPECT_TRUE(summary.notes.front().starts_with(pictures[lost].name)) << summary.notes.front();
    EXPECT_NEAR(summary.record.calibration.focal_px / truth.focal_px, 1, 0.003);
    EXPECT_LT((summary.record.calibration.rotation_center_px - truth.rotation_center_px).norm(), 1.5);
  }
}

// The boards stand 16 mm from the lens in the median. Squares half, twice or 25.4 times their size put them
// where none is held; half as much again (24 mm) does not, and only a measured distance tells it. The camera
// is the same each time.
TEST(CalibrationOnPictures, TellsAWrongSquareSizeByTheDistance) {
  ARTHRONAUT_REQUIRE_DATA(folder, "arthroscopy/cal_air");
  const std::vector<calibration::CalibrationPicture> pictures = observe_cal_air(folder);
  const auto outcome_of = [&](double factor, double distance_mm) {
    calibration::CalibrationOptions options;
    options.square_mm = 1.5 * factor;
    options.distance_mm = distance_mm;
    options.leave_one_out = false;
    const auto summary = calibration::calibrate(pictures, options);
    EXPECT_NEAR(summary.distance_mm, 15.95 * factor, 0.1 * factor);
    EXPECT_NEAR(summary.record.calibration.focal_px, 571.3, 0.2);
    return summary.outcome;
  };
  using Outcome = calibration::CalibrationSummary::Outcome;
  EXPECT_EQ(outcome_of(1, 0), Outcome::Ok);
  for (const double factor : {0.5, 2.0, 25.4})
    EXPECT_EQ(outcome_of(factor, 0), Outcome::Unreliable) << factor;
  EXPECT_EQ(outcome_of(1.5, 0), Outcome::Ok);
  EXPECT_EQ(outcome_of(1.5, 16), Outcome::Unreliable);
  EXPECT_EQ(outcome_of(1, 16), Outcome::Ok);
}

// The self-check on the clip, saline stated and air stated: the first is trusted, the second is not, and both
// find the same index.
TEST(FluidCheckOnAClip, TrustsTheRightMediumAlone) {
  ARTHRONAUT_REQUIRE_DATA(wet, "arthroscopy/ruler_wet");
  for (const double stated : {camera::kSalineIndex, camera::kAirIndex}) {
    calibration::RulerSightingsOptions options;
    options.calibration = camera::read_camera_file(wet / "camera.json").calibration;
    options.refractive_index = stated;
    calibration::RulerSightings sightings(options);
    const auto source = sources::open_video(wet / "clip.mkv");
    while (const camera::FramePtr frame = source->next()) sightings.look(*frame);
    EXPECT_GE(sightings.sightings().size(), 57U);
    calibration::FluidCheckOptions limits;
    limits.refractive_index = stated;
    const auto check =
        calibration::check_fluid(sightings.sightings(), options.ruler, options.calibration, limits);
    EXPECT_EQ(check.is_trusted(), stated == camera::kSalineIndex);
    EXPECT_NEAR(check.best_index, camera::kSalineIndex, 0.01);
    EXPECT_LT(check.index_sigma, 0.005);
  }
}

// Calibrated in air, used in saline, over the whole turn of the lens: the two markers' relative pose against
// the ruler's, beside what comes of the paper's focal rule and of a lens that is not followed. The bounds are
// those of OpenCV's ArUco with the true camera.
TEST(CalibrationInFluid, KeepsTheRulerTrueWhileTheLensTurns) {
  ARTHRONAUT_REQUIRE_DATA(air, "arthroscopy/cal_air");
  ARTHRONAUT_REQUIRE_DATA(wet, "arthroscopy/ruler_wet");
  const camera::Calibration found = calibrate_cal_air(air).record.calibration;
  const auto followed = ruler_sightings(wet / "clip.mkv", found, true);
  const auto fixed = ruler_sightings(wet / "clip.mkv", found, false);
  const calibration::FluidCheckSummary check = calibration::check_fluid(followed, {}, found, {});
  std::printf("| camera | frames | median deg | median mm | 95 %% deg | 95 %% mm | rms px |\n");
  for (const auto& row : check.rows)
    print(std::string(to_text(row.hypothesis)).c_str(), row, followed.size());
  const auto of_fixed = calibration::check_fluid(fixed, {}, found, {});
  for (const auto& row : of_fixed.rows)
    if (row.hypothesis == calibration::FluidHypothesis::FlatPort)
      print("flat port, lens not followed", row, fixed.size());
  std::printf("index that fits best: %.4f\n", check.best_index);

  const auto& best = check.rows.front();
  EXPECT_TRUE(check.is_trusted()) << check.reasons.front();
  EXPECT_EQ(best.hypothesis, calibration::FluidHypothesis::FlatPort);
  EXPECT_NEAR(check.best_index, camera::kSalineIndex, 0.01);
  EXPECT_GE(followed.size(), 57U);
  EXPECT_LE(best.median_deg, 0.35);
  EXPECT_LE(best.median_mm, 0.08);
  EXPECT_LE(best.worst_deg, 1.3);
  EXPECT_LE(best.worst_mm, 0.15);
}

// Photographs of a 9 x 6 board with clutter around it: all 54 corners in every picture.
TEST(BoardFinderOnPictures, FindsTheOpenCvChessboards) {
  ARTHRONAUT_REQUIRE_DATA(folder, "checkerboards/opencv-stereo");
  for (const char* side : {"left", "right"})
    for (const auto& file : pictures_in(folder, side))
      EXPECT_EQ(observe(file).board.corners.size(), 54U)
          << file.filename().string() << ": " << observe(file).board.reason;
}

// Boards through a laparoscope, whose 140 corners somebody else's detector gave: all found, within half a
// pixel in the median (the given ones themselves scatter by 0.2 to 0.4 px against OpenCV's).
TEST(BoardFinderOnPictures, FindsTheLaparoscopeChessboards) {
  ARTHRONAUT_REQUIRE_DATA(folder, "checkerboards/viking-laparoscope");
  for (const auto& file : pictures_in(folder, "left-")) {
    const calibration::CalibrationPicture picture = observe(file);
    std::ifstream given(file.string() + ".points.txt");
    std::vector<double> distances_px;
    Eigen::Vector2d point;
    while (given >> point.x() >> point.y()) {
      double nearest = 1e9;
      for (const auto& corner : picture.board.corners)
        nearest = std::min(nearest, (corner.pixel - point).norm());
      distances_px.push_back(nearest);
    }
    ASSERT_EQ(distances_px.size(), 140U);
    EXPECT_EQ(picture.board.corners.size(), 140U) << file.filename().string();
    std::sort(distances_px.begin(), distances_px.end());
    EXPECT_LT(distances_px[70], 0.5) << file.filename().string();
    EXPECT_LT(distances_px.back(), 3.0) << file.filename().string();
  }
}

// OpenCV's own calibration on the same corners, without tangential terms; RMS of the error's length.
double opencv_rms_px(const std::vector<calibration::CalibrationPicture>& pictures, double square_mm,
                     int flags, double& focal_px) {
  std::vector<std::vector<cv::Point3f>> boards;
  std::vector<std::vector<cv::Point2f>> pixels;
  for (const auto& picture : pictures) {
    boards.emplace_back();
    pixels.emplace_back();
    for (const auto& corner : picture.board.corners) {
      boards.back().emplace_back(static_cast<float>(corner.lattice.x() * square_mm),
                                 static_cast<float>(corner.lattice.y() * square_mm), 0.0F);
      pixels.back().emplace_back(static_cast<float>(corner.pixel.x()), static_cast<float>(corner.pixel.y()));
    }
  }
  const cv::Size size(pictures.front().size_px.x(), pictures.front().size_px.y());
  cv::Mat camera = cv::Mat::eye(3, 3, CV_64F), distortion;
  std::vector<cv::Mat> rotations, translations;
  const double rms = cv::calibrateCamera(boards, pixels, size, camera, distortion, rotations, translations,
                                         flags | cv::CALIB_FIX_ASPECT_RATIO | cv::CALIB_ZERO_TANGENT_DIST);
  focal_px = camera.at<double>(0, 0);
  return rms;
}

// One coefficient of the division model against one and three of OpenCV's polynomial, same corners, square
// pixels.
TEST(CalibrationOnPictures, DivisionModelBesideOpenCvsRadialModel) {
  struct Set {
    const char *folder, *prefix;
    double square_mm;
  };
  std::printf("| pictures | division, rms px, f | OpenCV k1, rms px, f | OpenCV k1 k2 k3, rms px, f |\n");
  for (const Set& set :
       {Set{"checkerboards/opencv-stereo", "left", 25}, Set{"checkerboards/opencv-stereo", "right", 25},
        Set{"checkerboards/viking-laparoscope", "left-", 3}}) {
    ARTHRONAUT_REQUIRE_DATA(folder, set.folder);
    std::vector<calibration::CalibrationPicture> pictures;
    for (const auto& file : pictures_in(folder, set.prefix)) pictures.push_back(observe(file));
    calibration::CalibrationOptions options;
    options.square_mm = set.square_mm;
    options.leave_one_out = false;
    const calibration::CalibrationSummary summary = calibration::calibrate(pictures, options);
    ASSERT_TRUE(summary.is_usable());
    double focal_of_one = 0, focal_of_three = 0;
    const double one =
        opencv_rms_px(pictures, set.square_mm, cv::CALIB_FIX_K2 | cv::CALIB_FIX_K3, focal_of_one);
    const double three = opencv_rms_px(pictures, set.square_mm, 0, focal_of_three);
    std::printf("| %s/%s | %.3f, %.1f | %.3f, %.1f | %.3f, %.1f |\n", set.folder, set.prefix, summary.rms_px,
                summary.record.calibration.focal_px, one, focal_of_one, three, focal_of_three);
    // As good as one polynomial coefficient, and never far from three.
    EXPECT_LE(summary.rms_px, 1.1 * one + 0.02) << set.folder;
    EXPECT_LE(summary.rms_px, 1.5 * three + 0.02) << set.folder;
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
