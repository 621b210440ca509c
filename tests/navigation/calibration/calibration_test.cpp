#include "navigation/calibration/calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "navigation/calibration/verdict.h"
#include "planning/geometry/error.h"
#include "planning/geometry/quantile.h"
#include "tests/navigation/calibration/board_scene.h"

namespace arthronaut::calibration {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const std::vector<BoardView> kThreeViews = {
    {board_pose(18, 6, 30, 5), 0}, {board_pose(20, 20, 120, 33), 60}, {board_pose(22, 34, 250, 71), -70}};

std::vector<CalibrationPicture> pictures_of(const std::vector<BoardView>& views, double corner_sigma_px,
                                            unsigned seed, double square_mm = 2) {
  std::mt19937 random(seed);
  std::vector<CalibrationPicture> pictures;
  for (const BoardView& view : views)
    pictures.push_back(picture_of(true_scope(), view, square_mm, corner_sigma_px, 0.1, random));
  return pictures;
}

CalibrationOptions options_with(double square_mm) {
  CalibrationOptions options;
  options.square_mm = square_mm;
  return options;
}

// Where principal points stand at the same mark angle: calibrations may choose other reference angles.
double principal_error_px(const camera::Calibration& found, const camera::Calibration& truth) {
  double worst = 0;
  for (double mark_deg = 0; mark_deg < 360; mark_deg += 30)
    worst = std::max(worst, (found.turned(found.principal_point_px, found.lens_angle_rad(mark_deg)) -
                             truth.turned(truth.principal_point_px, truth.lens_angle_rad(mark_deg)))
                                .norm());
  return worst;
}

// Three noisy pictures: the bounds are three times the measured spread at 0.1 px of corner noise.
TEST(Calibration, RecoversTheScopeFromThreePictures) {
  const CalibrationSummary summary = calibrate(pictures_of(kThreeViews, 0.1, 5), options_with(2));
  ASSERT_EQ(summary.outcome, CalibrationSummary::Outcome::Ok)
      << (summary.reasons.empty() ? "" : summary.reasons.front());
  const camera::Calibration &found = summary.record.calibration, truth = true_scope();
  EXPECT_NEAR(found.focal_px, truth.focal_px, 0.5);
  EXPECT_NEAR(found.distortion_xi, truth.distortion_xi, 0.0009);
  EXPECT_LT(principal_error_px(found, truth), 0.6);
  EXPECT_LT((found.rotation_center_px - truth.rotation_center_px).norm(), 0.6);
  EXPECT_NEAR(summary.rms_px, 0.1 * std::sqrt(2.0), 0.02);
  EXPECT_NEAR(summary.leave_one_out_rms_px, 0.1 * std::sqrt(2.0), 0.05);
}

// Over many noise draws the errors are as large as the covariance says: mean square of error / sigma near 1.
TEST(Calibration, CovarianceIsTrue) {
  constexpr int kTrials = 40;
  Eigen::Matrix<double, 6, 1> mean_square = Eigen::Matrix<double, 6, 1>::Zero();
  CalibrationOptions options = options_with(3);
  options.leave_one_out = false;
  const camera::Calibration truth = true_scope();
  for (int trial = 0; trial < kTrials; ++trial) {
    const CalibrationSummary summary =
        calibrate(pictures_of(kThreeViews, 0.15, 100 + static_cast<unsigned>(trial), 3), options);
    ASSERT_TRUE(summary.is_usable());
    const camera::Calibration& found = summary.record.calibration;
    const Eigen::Vector2d c =
        truth.turned(truth.principal_point_px, truth.lens_angle_rad(found.reference_mark_angle_deg));
    Eigen::Matrix<double, 6, 1> error;
    error << found.focal_px - truth.focal_px, found.distortion_xi - truth.distortion_xi,
        found.principal_point_px - c, found.rotation_center_px - truth.rotation_center_px;
    ASSERT_TRUE(summary.record.calibration.covariance);
    mean_square +=
        error.cwiseAbs2().cwiseQuotient(summary.record.calibration.covariance->diagonal()) / kTrials;
  }
  for (int k = 0; k < 6; ++k) {
    EXPECT_GT(mean_square(k), 0.3) << k;
    EXPECT_LT(mean_square(k), 2.0) << k;
  }
}

// Boards that all but face the lens leave the focal length open, which is not the same as knowing it.
TEST(Calibration, WhatThePicturesLeaveOpenIsNotKnown) {
  const std::vector<BoardView> facing = {{board_pose(18, 0.3, 30, 5), 0},
                                         {board_pose(20, 0.5, 120, 33), 60},
                                         {board_pose(22, 0.3, 250, 71), -70}};
  const CalibrationSummary summary = calibrate(pictures_of(facing, 0.1, 5), options_with(2));
  EXPECT_EQ(summary.outcome, CalibrationSummary::Outcome::Unreliable);
  const auto& covariance = summary.record.calibration.covariance;
  const double variance = covariance ? (*covariance)(0, 0) : std::numeric_limits<double>::infinity();
  EXPECT_GT(std::sqrt(variance), 0.1 * true_scope().focal_px);
}

// A check that could not be done is not one that was passed; one that nobody asked for is no reason.
TEST(Calibration, ALeaveOneOutInVainIsAReason) {
  CalibrationOptions options = options_with(2);
  CalibrationSummary summary = calibrate(pictures_of(kThreeViews, 0.1, 5), options);
  ASSERT_EQ(summary.outcome, CalibrationSummary::Outcome::Ok);
  for (const double rms_px : {-1.0, geometry::kNotKnown}) {
    summary.leave_one_out_rms_px = rms_px;
    options.leave_one_out = true;
    EXPECT_THAT(reasons_against(summary, {}, options, true), Contains(HasSubstr("the others give")));
    options.leave_one_out = false;
    EXPECT_THAT(reasons_against(summary, {}, options, true), Not(Contains(HasSubstr("the others give"))));
  }
}

// Whole chain on drawn pictures: board finder, circle, mark, adjustment.
TEST(Calibration, CalibratesFromDrawnPictures) {
  std::vector<CalibrationPicture> pictures;
  unsigned seed = 20;
  for (const BoardView& view : kThreeViews)
    pictures.push_back(observe_picture("drawn", draw_board(true_scope(), view, 2, 1.5, ++seed).view()));
  const CalibrationSummary summary = calibrate(pictures, options_with(2));
  ASSERT_EQ(summary.outcome, CalibrationSummary::Outcome::Ok)
      << (summary.reasons.empty() ? "" : summary.reasons.front());
  const camera::Calibration &found = summary.record.calibration, truth = true_scope();
  EXPECT_NEAR(found.focal_px / truth.focal_px, 1, 0.003);
  EXPECT_NEAR(found.distortion_xi, truth.distortion_xi, 0.006);
  EXPECT_LT(principal_error_px(found, truth), 1.0);
  EXPECT_LT((found.rotation_center_px - truth.rotation_center_px).norm(), 1.5);
}

const std::vector<BoardView> kFiveViews = {{board_pose(18, 6, 30, 5), 0},
                                           {board_pose(20, 20, 120, 33), 60},
                                           {board_pose(22, 34, 250, 71), -70},
                                           {board_pose(19, 28, 200, 12), 140},
                                           {board_pose(21, 25, 70, 50), -130}};

// A picture without its mark, whichever it is, takes nothing from the others: its lens angle follows from
// where its principal point and circle stand. Five pictures or three.
TEST(Calibration, SolvesTheAngleOfAPictureWithoutMark) {
  for (const bool few : {false, true}) {
    const std::vector<BoardView>& views = few ? kThreeViews : kFiveViews;
    for (std::size_t lost = 0; lost < views.size(); ++lost) {
      std::vector<CalibrationPicture> pictures = pictures_of(views, 0.1, 5 + static_cast<unsigned>(lost));
      pictures[lost].lens.mark = lens::MarkState::Ambiguous;
      pictures[lost].lens.mark_angle_deg = 0;
      const CalibrationSummary summary = calibrate(pictures, options_with(2));
      ASSERT_EQ(summary.outcome, CalibrationSummary::Outcome::Ok)
          << (summary.reasons.empty() ? "" : summary.reasons.front());
      EXPECT_THAT(summary.notes, ElementsAre(HasSubstr("two marks look alike")));
      EXPECT_FALSE(summary.pictures[lost].mark_is_used);
      const camera::Calibration &found = summary.record.calibration, truth = true_scope();
      EXPECT_NEAR(found.focal_px, truth.focal_px, 0.5);
      EXPECT_LT(principal_error_px(found, truth), 0.9);
      EXPECT_LT((found.rotation_center_px - truth.rotation_center_px).norm(), 0.9);
      // The principal point, 7 px from the centre of rotation, is known to 0.2 px: 2 degrees; three times
      // that.
      const double mark_deg = found.reference_mark_angle_deg + summary.pictures[lost].lens_angle_deg;
      const double true_deg = truth.reference_mark_angle_deg + views[lost].lens_angle_deg;
      EXPECT_NEAR(std::remainder(mark_deg - true_deg, 360.0), 0, 6) << lost;
    }
  }
}

// Two of five without a mark, and one of them first: still the others' calibration.
TEST(Calibration, SolvesTheAnglesOfTwoPicturesWithoutMark) {
  std::vector<CalibrationPicture> pictures = pictures_of(kFiveViews, 0.1, 9);
  pictures[0].lens.mark = pictures[3].lens.mark = lens::MarkState::Dark;
  const CalibrationSummary summary = calibrate(pictures, options_with(2));
  EXPECT_EQ(summary.outcome, CalibrationSummary::Outcome::Ok);
  EXPECT_EQ(summary.notes.size(), 2U);
  EXPECT_LT(principal_error_px(summary.record.calibration, true_scope()), 0.9);
}

// Something that looked like the mark, in one picture of five: noticed, named, and put right.
TEST(Calibration, DisbelievesAMarkThatContradictsTheOthers) {
  std::vector<CalibrationPicture> pictures = pictures_of(kFiveViews, 0.1, 11);
  pictures[2].lens.mark_angle_deg = std::fmod(pictures[2].lens.mark_angle_deg + 95, 360.0);
  const CalibrationSummary summary = calibrate(pictures, options_with(2));
  EXPECT_EQ(summary.outcome, CalibrationSummary::Outcome::Ok);
  EXPECT_THAT(summary.notes, ElementsAre(HasSubstr("contradicts")));
  EXPECT_FALSE(summary.pictures[2].mark_is_used);
  EXPECT_LT(principal_error_px(summary.record.calibration, true_scope()), 0.9);
}

// Broken contracts are named.
TEST(Calibration, ThrowsOnBrokenContracts) {
  std::vector<CalibrationPicture> pictures = pictures_of(kThreeViews, 0.1, 5);
  const auto message = [](auto&& run) -> std::string {
    try {
      (void)run();
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(message([&] { return calibrate(std::span(pictures).first(2), options_with(2)); }),
              HasSubstr("three pictures"));
  EXPECT_THAT(message([&] { return calibrate(pictures, options_with(0)); }), HasSubstr("above 0 mm"));
  EXPECT_THAT(message([&] { return calibrate(pictures, options_with(NAN)); }), HasSubstr("above 0 mm"));
  std::vector<CalibrationPicture> other_size = pictures;
  other_size[1].size_px = {1280, 720};
  EXPECT_THAT(message([&] { return calibrate(other_size, options_with(2)); }), HasSubstr("1280 x 720"));
  std::vector<CalibrationPicture> no_board = pictures;
  no_board[2].board = {{}, "no checkerboard was found in it"};
  EXPECT_THAT(message([&] { return calibrate(no_board, options_with(2)); }), HasSubstr("no checkerboard"));
}

// Poor pictures give a result with its reasons, each of its own.
TEST(Calibration, SaysWhyItIsNotReliable) {
  const std::vector<BoardView> facing = {
      {board_pose(18, 1, 30, 5), 0}, {board_pose(20, 2, 120, 33), 60}, {board_pose(22, 1, 250, 71), -70}};
  EXPECT_THAT(calibrate(pictures_of(facing, 0.1, 5), options_with(2)).reasons,
              Contains(HasSubstr("face the lens")));

  std::vector<BoardView> unturned = kThreeViews;
  for (BoardView& view : unturned) view.lens_angle_deg = 3;
  EXPECT_THAT(calibrate(pictures_of(unturned, 0.1, 5), options_with(2)).reasons,
              Contains(HasSubstr("was turned by")));

  EXPECT_THAT(calibrate(pictures_of(kThreeViews, 0.1, 5), options_with(20)).reasons,
              Contains(HasSubstr("side of a square")));

  std::vector<CalibrationPicture> one_mark = pictures_of(kThreeViews, 0.1, 5);
  one_mark[1].lens.mark = one_mark[2].lens.mark = lens::MarkState::NotSeen;
  EXPECT_THAT(calibrate(one_mark, options_with(2)).reasons, Contains(HasSubstr("lens mark was not found")));

  std::vector<CalibrationPicture> noisy = pictures_of(kThreeViews, 1.0, 5);
  EXPECT_THAT(calibrate(noisy, options_with(2)).reasons, Contains(HasSubstr("miss the model")));
}

}  // namespace
}  // namespace arthronaut::calibration
