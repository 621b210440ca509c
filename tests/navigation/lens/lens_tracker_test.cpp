#include "navigation/lens/lens_tracker.h"

#include <gtest/gtest.h>

#include "tests/navigation/lens/rim_picture.h"

namespace arthronaut::lens {
namespace {

// 0.2 px: a tenth of the drawn rim's width; the fit averages hundreds of rays.
constexpr double kCircleTolerance_px = 0.2;
// 0.15 degrees at a radius of 252 px is 0.7 px along the rim.
constexpr double kAngleTolerance_deg = 0.15;

void expect_found(const LensObservation& seen, const RimTruth& truth) {
  ASSERT_TRUE(seen.circle_found);
  EXPECT_NEAR((seen.circle.center_px - truth.center_px).norm(), 0, kCircleTolerance_px);
  EXPECT_NEAR(seen.circle.radius_px, truth.radius_px, 2 * kCircleTolerance_px);
  ASSERT_EQ(seen.mark, MarkState::Found) << to_text(seen.mark);
  EXPECT_NEAR(turn_between_deg(seen.mark_angle_deg, truth.mark_angle_deg), 0, kAngleTolerance_deg);
  EXPECT_FALSE(seen.is_stale);
}

// One picture on its own: both polarities, all round the rim, from nothing.
TEST(LensTracker, FindsCircleAndMarkOfEitherPolarityInAStill) {
  for (const bool outward : {false, true})
    for (const double angle_deg : {0.0, 94.5, 179.9, 271.3}) {
      RimTruth truth;
      truth.is_bright_outward = outward;
      truth.mark_angle_deg = angle_deg;
      const RimPicture picture = draw(truth);
      const LensObservation seen = observe_still(picture.view());
      expect_found(seen, truth);
      EXPECT_EQ(seen.polarity, outward ? MarkPolarity::BrightOutward : MarkPolarity::DarkInward);
    }
}

// A circle that is cut by the picture's upper and lower edge, as many heads show it.
TEST(LensTracker, FindsACircleThatThePictureCuts) {
  RimTruth truth;
  truth.radius_px = 320;
  truth.mark_angle_deg = 12;
  const RimPicture picture = draw(truth);
  expect_found(observe_still(picture.view()), truth);
}

// A turning lens whose circle moves about the centre of rotation: the angle follows without lag.
TEST(LensTracker, FollowsATurningLens) {
  LensTracker tracker;
  for (int frame = 0; frame < 25; ++frame) {
    RimTruth truth;
    truth.seed = 100 + static_cast<unsigned>(frame);
    truth.mark_angle_deg = 340 + 2.5 * frame;
    const double turn = truth.mark_angle_deg * M_PI / 180;
    truth.center_px += Eigen::Vector2d(4 * std::cos(turn), 4 * std::sin(turn));
    const RimPicture picture = draw(truth);
    expect_found(tracker.observe(picture.view(), frame * 16'666'667LL), truth);
  }
}

// A dim scene under a noisy sensor: the mark is found all the same, and nothing else is taken for it. 0.5
// degrees: the noise is a quarter of the scene's light.
TEST(LensTracker, SeesTheMarkThroughASensorsNoise) {
  for (int k = 0; k < 12; ++k) {
    RimTruth truth;
    truth.seed = 900 + static_cast<unsigned>(k);
    truth.mark_angle_deg = 30.0 * k + 7;
    truth.noise = 9;
    truth.scene = [](double angle_deg, double) { return 40 + 6 * std::sin(0.09 * angle_deg); };
    const RimPicture picture = draw(truth);
    const LensObservation seen = observe_still(picture.view());
    ASSERT_EQ(seen.mark, MarkState::Found) << to_text(seen.mark) << " at " << truth.mark_angle_deg;
    EXPECT_NEAR(turn_between_deg(seen.mark_angle_deg, truth.mark_angle_deg), 0, 0.5);
  }
}

// Half of the scene lies in the dark and a bright instrument crosses the rim: neither moves circle or mark.
TEST(LensTracker, IsNotMovedByDarknessOrInstruments) {
  RimTruth truth;
  truth.scene = [](double angle_deg, double) {
    if (angle_deg > 20 && angle_deg < 120) return 3.0;                 // dark
    if (std::abs(turn_between_deg(angle_deg, -60)) < 8) return 240.0;  // shaft
    return 80.0;
  };
  const RimPicture picture = draw(truth);
  expect_found(observe_still(picture.view()), truth);
}

// Dark instruments make dents of their own; the tracker goes on with the mark whose shape and place it knows.
TEST(LensTracker, KeepsTheMarkWhenADarkInstrumentDentsTheRim) {
  LensTracker tracker;
  for (int frame = 0; frame < 20; ++frame) {
    RimTruth truth;
    truth.seed = 300 + static_cast<unsigned>(frame);
    if (frame > 8)
      truth.scene = [](double angle_deg, double share) {
        return std::abs(turn_between_deg(angle_deg, 150)) < 2.5 && share > 0.95 ? 2.0 : 90.0;
      };
    const RimPicture picture = draw(truth);
    expect_found(tracker.observe(picture.view(), frame * 16'666'667LL), truth);
  }
}

// A mark that is gone from a clean rim, one that is covered and one in the dark are told apart, and after the
// time allowed the angle is stale.
TEST(LensTracker, SaysWhyTheMarkIsNotFoundAndWhenItIsStale) {
  LensTracker tracker;
  std::int64_t now_ns = 0;
  const auto show = [&](const RimTruth& truth) {
    const RimPicture picture = draw(truth);
    return tracker.observe(picture.view(), now_ns += 16'666'667);
  };
  const RimTruth plain;
  for (int frame = 0; frame < 8; ++frame) ASSERT_EQ(show(plain).mark, MarkState::Found);

  RimTruth dark = plain;
  dark.scene = [](double angle_deg, double) {
    return std::abs(turn_between_deg(angle_deg, 205)) < 30 ? 2.0 : 90.0;
  };
  LensObservation seen = show(dark);
  EXPECT_EQ(seen.mark, MarkState::Dark);
  EXPECT_FALSE(seen.is_stale);
  EXPECT_TRUE(seen.has_angle());

  RimTruth covered = plain;
  covered.scene = [](double angle_deg, double share) {
    return std::abs(turn_between_deg(angle_deg, 205)) < 12 && share > 0.97 ? 2.0 : 90.0;
  };
  EXPECT_EQ(show(covered).mark, MarkState::Covered);

  RimTruth gone = plain;
  gone.has_mark = false;
  EXPECT_EQ(show(gone).mark, MarkState::NotSeen);
  now_ns += 1'000'000'000;
  seen = show(gone);
  EXPECT_TRUE(seen.is_stale);
  EXPECT_FALSE(seen.has_angle());
  EXPECT_GT(seen.mark_sigma_deg, 5);
}

// Two marks alike in a still: no guess.
TEST(LensTracker, RefusesToChooseBetweenTwoMarks) {
  RimTruth truth;
  truth.scene = [&](double angle_deg, double share) {
    const double off = std::abs(turn_between_deg(angle_deg, 40)) / 2.1;
    return share > 1 - 0.04 * std::max(0.0, 1 - off) ? 0.0 : 90.0;
  };
  const RimPicture picture = draw(truth);
  EXPECT_EQ(observe_still(picture.view()).mark, MarkState::Ambiguous);
}

// Another zoom and a slipped coupler, under a mark of either polarity: told from the second frame on, in
// every frame while they last, with words for the screen; and taken back when the scope is put right.
TEST(LensTracker, NoticesZoomAndSlipInEveryFrame) {
  struct Fault {
    double zoom, shift_px;
    RimState rim;
    const char* words;
  };
  for (const bool outward : {false, true})
    for (const Fault& fault :
         {Fault{1.03, 0, RimState::Zoomed, "3.0 % larger"}, Fault{0.97, 0, RimState::Zoomed, "3.0 % smaller"},
          Fault{1.01, 0, RimState::Zoomed, "1.0 % larger"}, Fault{1, 7, RimState::Slipped, "7 px beside"}}) {
      RimTruth truth;
      truth.is_bright_outward = outward;
      LensTrackerOptions options;
      options.calibration.emplace();
      options.calibration->image_size_px = {truth.width, truth.height};
      options.calibration->rotation_center_px = {480, 270};
      options.calibration->boundary = {truth.center_px, truth.radius_px};
      options.calibration->reference_mark_angle_deg = truth.mark_angle_deg;
      RimTruth wrong = truth;
      wrong.radius_px *= fault.zoom;
      wrong.center_px.x() += fault.shift_px;
      const RimPicture as_calibrated = draw(truth), off_track = draw(wrong);
      LensTracker tracker(options);
      for (int frame = 0; frame < 26; ++frame) {
        const bool is_wrong = frame >= 8 && frame < 18;
        const RimPicture& picture = is_wrong ? off_track : as_calibrated;
        const LensObservation& seen = tracker.observe(picture.view(), frame * 16'666'667LL);
        EXPECT_EQ(seen.mark, MarkState::Found) << frame;
        if (frame < 8 || frame > 23) {
          EXPECT_FALSE(seen.zoom_or_slip) << frame << ' ' << fault.words;
          EXPECT_EQ(reason_text(seen), "") << frame;
        } else if (frame > 8 && is_wrong) {
          EXPECT_TRUE(seen.zoom_or_slip) << frame << ' ' << fault.words;
          EXPECT_EQ(seen.rim, fault.rim) << frame;
          EXPECT_NE(reason_text(seen).find(fault.words), std::string::npos) << reason_text(seen);
        }
      }
    }
}

// What the rim says about the focal length, in the very frame: unknown before it was seen and when it has
// gone out of a lit picture (zoomed in), changed when it has another radius, by 1 % as well; held for as long
// as a mark while darkness hides it, and no longer.
TEST(LensTracker, ZoomUnknownUntilTheRimWasSeenAsCalibrated) {
  const RimTruth truth;
  LensTrackerOptions options;
  options.calibration.emplace();
  options.calibration->image_size_px = {truth.width, truth.height};
  options.calibration->rotation_center_px = {480, 270};
  options.calibration->boundary = {truth.center_px, truth.radius_px};
  options.calibration->reference_mark_angle_deg = truth.mark_angle_deg;
  LensTracker tracker(options);
  std::int64_t now_ns = 0;
  const auto zoom_of = [&](const RimPicture& shown) {
    return tracker.observe(shown.view(), now_ns += 16'666'667).zoom;
  };
  RimTruth zoomed_truth = truth, larger_truth = truth, dark_truth = truth, partly_truth = truth;
  zoomed_truth.radius_px = 700;  // beyond the picture's corners
  larger_truth.radius_px *= 1.01;
  dark_truth.scene = [](double, double) { return 1.0; };
  partly_truth.scene = [](double angle_deg, double) {
    return std::abs(turn_between_deg(angle_deg, -60)) < 70 ? 2.0 : 90.0;
  };

  const RimPicture seen = draw(truth), zoomed_in = draw(zoomed_truth), larger = draw(larger_truth),
                   dark = draw(dark_truth), partly = draw(partly_truth);

  EXPECT_EQ(zoom_of(zoomed_in), ZoomState::Unknown);
  EXPECT_NE(reason_text(tracker.observe(zoomed_in.view(), now_ns += 16'666'667)).find("zoom unknown"),
            std::string::npos);
  for (int i = 0; i < 8; ++i) EXPECT_EQ(zoom_of(seen), ZoomState::AsCalibrated) << i;
  for (int i = 0; i < 4; ++i) EXPECT_EQ(zoom_of(partly), ZoomState::AsCalibrated) << i;
  for (int i = 0; i < 8; ++i) EXPECT_EQ(zoom_of(zoomed_in), ZoomState::Unknown) << i;
  for (int i = 0; i < 8; ++i) EXPECT_EQ(zoom_of(seen), ZoomState::AsCalibrated) << i;
  for (int i = 0; i < 8; ++i) EXPECT_EQ(zoom_of(larger), ZoomState::Changed) << i;
  for (int i = 0; i < 8; ++i) EXPECT_EQ(zoom_of(seen), ZoomState::AsCalibrated) << i;
  for (int i = 0; i < 30; ++i) EXPECT_EQ(zoom_of(dark), ZoomState::AsCalibrated) << i;
  now_ns += 600'000'000;
  EXPECT_EQ(zoom_of(dark), ZoomState::Unknown);
  EXPECT_EQ(zoom_of(seen), ZoomState::AsCalibrated);

  LensTracker without_calibration;
  EXPECT_EQ(without_calibration.observe(seen.view(), 0).zoom, ZoomState::NotWatched);
}

// A mark that is gone: the words first say that its angle is held, then that it is not known. Both
// polarities.
TEST(LensTracker, SaysThatTheAngleIsHeldAndThenNotKnown) {
  for (const bool outward : {false, true}) {
    RimTruth truth;
    truth.is_bright_outward = outward;
    LensTracker tracker;
    for (int frame = 0; frame < 8; ++frame) {
      const RimPicture picture = draw(truth);
      tracker.observe(picture.view(), frame * 16'666'667LL);
    }
    truth.has_mark = false;
    const RimPicture picture = draw(truth);
    const LensObservation held = tracker.observe(picture.view(), 200'000'000);
    EXPECT_EQ(held.mark, MarkState::NotSeen);
    EXPECT_TRUE(held.has_angle());
    EXPECT_EQ(reason_text(held), "lens mark: no mark on the rim, its last angle is held while it is sure");
    const LensObservation& stale = tracker.observe(picture.view(), 1'500'000'000);
    EXPECT_TRUE(stale.is_stale);
    EXPECT_FALSE(stale.has_angle());
    EXPECT_EQ(reason_text(stale), "lens mark: no mark on the rim, the lens angle is not known");
  }
}

// A checkerboard runs past the view: its black squares beside the rim are dark, but scene, and no dents.
// (Half a degree: squares that meet the mark's flanks take rays from them.)
TEST(LensTracker, TellsTheMarkFromTheSquaresOfABoard) {
  for (const bool outward : {false, true})
    for (const double squares : {7.0, 13.0, 19.0})
      for (const double angle_deg : {20.0, 271.0}) {
        RimTruth truth;
        truth.is_bright_outward = outward;
        truth.mark_angle_deg = angle_deg;
        truth.scene = [&](double at_deg, double share) {
          const double x = share * std::cos(at_deg * M_PI / 180), y = share * std::sin(at_deg * M_PI / 180);
          const auto column = static_cast<int>(std::floor(squares * x + 0.3));
          return (column + static_cast<int>(std::floor(squares * y))) % 2 == 0 ? 30.0 : 140.0;
        };
        const RimPicture picture = draw(truth);
        const LensObservation seen = observe_still(picture.view());
        ASSERT_EQ(seen.mark, MarkState::Found) << to_text(seen.mark) << ' ' << squares << ' ' << angle_deg;
        EXPECT_NEAR(turn_between_deg(seen.mark_angle_deg, angle_deg), 0, 0.5) << squares << ' ' << outward;
      }
}

// After a reset nothing is left of the picture before it: in the dark there is no circle, not even the old
// one.
TEST(LensTracker, ForgetsTheCircleOnReset) {
  LensTracker tracker;
  const RimTruth truth;
  const RimPicture picture = draw(truth);
  expect_found(tracker.observe(picture.view(), 0), truth);
  tracker.reset();
  const std::vector<std::uint8_t> black(static_cast<std::size_t>(picture.view().width) *
                                        picture.view().height);
  const LensObservation& seen = tracker.observe(
      {black.data(), picture.view().width, picture.view().height, picture.view().width}, 16'666'667);
  EXPECT_FALSE(seen.circle_found);
  EXPECT_EQ(seen.circle.radius_px, 0);
  EXPECT_EQ(seen.mark, MarkState::NoCircle);
  EXPECT_TRUE(seen.is_stale);
}

// No round view at all: a plain scene, a black picture, a picture too small to hold one.
TEST(LensTracker, FindsNoCircleWhereThereIsNone) {
  for (const int level : {0, 90}) {
    const std::vector<std::uint8_t> plain(640 * 480, static_cast<std::uint8_t>(level));
    const LensObservation seen = observe_still({plain.data(), 640, 480, 640});
    EXPECT_FALSE(seen.circle_found);
    EXPECT_EQ(seen.mark, MarkState::NoCircle);
    EXPECT_TRUE(seen.is_stale);
  }
  const std::vector<std::uint8_t> tiny(16 * 16, 50);
  EXPECT_EQ(observe_still({tiny.data(), 16, 16, 16}).mark, MarkState::NoCircle);
}

}  // namespace
}  // namespace arthronaut::lens
