#include "navigation/markers/marker_tracker.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "navigation/markers/square_search.h"
#include "planning/geometry/error.h"
#include "tests/benchmarks/aruco_tracker.h"
#include "tests/counted_allocations.h"
#include "tests/navigation/markers/rendered_marker.h"

namespace arthronaut::markers {
namespace {

using geometry::RigidTransform;

constexpr std::int64_t kFrameNs = 16'666'667;

class MarkerTracking : public ::testing::Test {
 protected:
  static PlacedMarker placed(int id, const RigidTransform& pose) { return {codes_4x4_50()[id], 4, pose}; }
  RenderedPicture picture(const std::vector<PlacedMarker>& markers, unsigned seed = 1) const {
    PictureOptions options;
    options.seed = seed;
    return {camera_, markers, options};
  }
  static double angle_deg(const RigidTransform& a, const RigidTransform& b) {
    return geometry::deg_from_rad(geometry::rotation_angle_rad(a.rotation.conjugate() * b.rotation));
  }
  static void expect_near(const MarkerObservation& seen, const RigidTransform& truth, double deg, double mm) {
    ASSERT_TRUE(seen.is_tracked()) << to_text(seen.state);
    EXPECT_LT(angle_deg(seen.camera_from_marker, truth), deg);
    EXPECT_LT((seen.camera_from_marker.translation_mm - truth.translation_mm).norm(), mm);
    EXPECT_GT(seen.covariance.trace(), 0);
  }

  camera::CameraModel camera_ = small_scope();
  std::vector<DeclaredMarker> declared_ = {{0, 4}, {2, 4}};
  RigidTransform world_ = facing_pose(-4.5, 3, 17, 20, 10, 15), probe_ = facing_pose(4, -2, 15, -15, 25, 120);
};

// Two markers through the wet, turned, distorted lens. A marker of 80 px whose 180 edges are each good to 0.1
// px is known to about 0.1 deg and 10 um; the limits are three times that.
TEST_F(MarkerTracking, MeasuresPosesOfARenderedPicture) {
  const auto tracker = make_tracker(declared_);
  const auto shown = picture({placed(0, world_), placed(2, probe_)});
  for (int frame = 0; frame < 3; ++frame) {
    const auto seen = tracker->track(shown.view(), camera_, frame * kFrameNs);
    ASSERT_EQ(seen.size(), 2u);
    expect_near(seen[0], world_, 0.3, 0.03);
    expect_near(seen[1], probe_, 0.3, 0.03);
  }
}

// The reference tracker sees the same, less exactly: its corners are good to 0.2 px, and the gamma shrinks
// the square.
TEST_F(MarkerTracking, AgreesWithTheReferenceTracker) {
  const auto tracker = make_aruco_tracker(declared_);
  const auto seen = tracker->track(picture({placed(0, world_), placed(2, probe_)}).view(), camera_, 0);
  expect_near(seen[0], world_, 1.5, 0.3);
  expect_near(seen[1], probe_, 1.5, 0.3);
}

// In all four turns and from all sides the marker's own top-left stays its top-left.
TEST_F(MarkerTracking, KeepsTheMarkersFrameInEveryTurn) {
  for (const double turn : {5.0, 95.0, 185.0, 275.0}) {
    const auto tracker = make_tracker(declared_);
    const RigidTransform truth = facing_pose(1, 0.5, 16, 12, -20, turn);
    const auto seen = tracker->track(picture({placed(2, truth)}).view(), camera_, 0);
    expect_near(seen[1], truth, 0.3, 0.03);
    const Eigen::Vector2d top_left = camera_.project(truth * Eigen::Vector3d(-2, 2, 0)).value();
    EXPECT_LT((seen[1].corners_px[0] - top_left).norm(), 0.3);
  }
}

// The error over poses and noise stays within what the covariance says. It may stay well within: the
// covariance also carries what compression and the renderers of others add.
TEST_F(MarkerTracking, DoesNotUnderstateItsError) {
  double sum = 0;
  int count = 0;
  for (int i = 0; i < 12; i += 2) {
    const RigidTransform a = facing_pose(-4.5 + 0.1 * i, 3, 16 + 0.5 * i, 20 - 3 * i, 10 + i, 15 + 31 * i);
    const RigidTransform b =
        facing_pose(4, -2 - 0.1 * i, 15 + 0.4 * i, -15 + 2 * i, 25 - 4 * i, 120 + 17 * i);
    const auto tracker = make_tracker(declared_);
    const auto seen = tracker->track(picture({placed(0, a), placed(2, b)}, 100 + i).view(), camera_, 0);
    for (int k = 0; k < 2; ++k) {
      if (!seen[k].is_tracked()) continue;
      const geometry::Vector6d error = geometry::log(seen[k].camera_from_marker.inverse() * (k == 0 ? a : b));
      sum += error.dot(seen[k].covariance.inverse() * error) / 6;
      ++count;
    }
  }
  ASSERT_GE(count, 11);
  RecordProperty("normalised_error", std::to_string(sum / count));
  EXPECT_LT(sum / count, 2);
}

// A corner and a third of a side covered: found from nothing, and right.
TEST_F(MarkerTracking, FindsAMarkerWithACoveredCorner) {
  auto shown = picture({placed(2, probe_)});
  const Eigen::Vector2d corner = camera_.project(probe_ * Eigen::Vector3d(-2, 2, 0)).value();
  shown.cover(static_cast<int>(corner.x()) - 14, static_cast<int>(corner.y()) - 14,
              static_cast<int>(corner.x()) + 14, static_cast<int>(corner.y()) + 14, 150);
  const auto tracker = make_tracker(declared_);
  expect_near(tracker->track(shown.view(), camera_, 0)[1], probe_, 0.6, 0.06);
}

// A bar across the marker: followed from the frame before, or refused with the reason; never wrong.
TEST_F(MarkerTracking, FollowsAPartlyCoveredMarkerAndNeverReportsAWrongOne) {
  const auto clear = picture({placed(2, probe_)});
  const Eigen::Vector2d middle = camera_.project(probe_.translation_mm).value();
  const auto tracker = make_tracker(declared_);
  int followed = 0;
  for (int width = 4; width <= 100; width += 16) {
    tracker->reset();
    (void)tracker->track(clear.view(), camera_, 0);
    auto barred = picture({placed(2, probe_)});
    const int x = static_cast<int>(middle.x());
    barred.cover(x - width / 2, 0, x + width / 2, 600, 120);
    const auto& seen = tracker->track(barred.view(), camera_, kFrameNs)[1];
    if (!seen.is_tracked()) {
      EXPECT_TRUE(seen.state == MarkerState::Covered || seen.state == MarkerState::Doubtful)
          << to_text(seen.state);
      continue;
    }
    ++followed;
    expect_near(seen, probe_, 2, 0.2);
  }
  EXPECT_GE(followed, 2);
}

// An id that is in view twice belongs to neither.
TEST_F(MarkerTracking, RefusesAMarkerThatIsSeenTwice) {
  const auto shown = picture({placed(2, world_), placed(2, probe_)});
  for (const bool own : {true, false}) {
    const auto tracker = own ? make_tracker(declared_) : make_aruco_tracker(declared_);
    const auto seen = tracker->track(shown.view(), camera_, 0);
    EXPECT_EQ(seen[1].state, MarkerState::Duplicate) << (own ? "own" : "reference");
    EXPECT_FALSE(seen[0].is_tracked());
  }
}

// A marker that moves out of the view says so.
TEST_F(MarkerTracking, SaysThatAMarkerLeftTheView) {
  const auto tracker = make_tracker(declared_);
  MarkerState last = MarkerState::NotSeen;
  for (int frame = 0; frame < 20; ++frame) {
    const auto pose = facing_pose(6 + 0.5 * frame, -1, 16, 10, 15, 20);
    last = tracker->track(picture({placed(2, pose)}).view(), camera_, frame * kFrameNs)[1].state;
    if (last == MarkerState::OutOfView) break;
  }
  EXPECT_EQ(last, MarkerState::OutOfView);
}

// Black, white, and grey pictures hold nothing; the next good one does.
TEST_F(MarkerTracking, SurvivesEmptyPictures) {
  const auto tracker = make_tracker(declared_);
  for (const std::uint8_t grey : {0, 128, 255}) {
    const std::vector<std::uint8_t> flat(800 * 600, grey);
    for (const auto& seen : tracker->track({flat.data(), 800, 600, 800}, camera_, 0)) {
      EXPECT_EQ(seen.state, MarkerState::NotSeen);
    }
  }
  EXPECT_TRUE(tracker->track(picture({placed(2, probe_)}).view(), camera_, kFrameNs)[1].is_tracked());
}

// The same frames give the same numbers, also after a reset.
TEST_F(MarkerTracking, IsDeterministic) {
  const auto shown = picture({placed(0, world_), placed(2, probe_)});
  const auto tracker = make_tracker(declared_);
  const MarkerObservation first = tracker->track(shown.view(), camera_, 0)[0];
  (void)tracker->track(shown.view(), camera_, kFrameNs);
  tracker->reset();
  const MarkerObservation again = tracker->track(shown.view(), camera_, 0)[0];
  EXPECT_EQ(first.camera_from_marker.translation_mm, again.camera_from_marker.translation_mm);
  EXPECT_EQ(first.covariance, again.covariance);
}

// For what is declared and not there for a second, a part of the search is made in each frame; what is lost
// only now is sought in every frame, and what comes into view is found in the fourth frame at the latest.
TEST_F(MarkerTracking, SeeksAMarkerThatIsLongLostByAPartOfTheSearchInEachFrame) {
  const auto one = picture({placed(0, world_)}), both = picture({placed(0, world_), placed(2, probe_)});
  const auto tracker = make_tracker(declared_);
  int frame = 0;
  const auto searches_in = [&](const RenderedPicture& shown, int frames) {
    int searches = 0;
    for (const int end = frame + frames; frame < end; ++frame) {
      EXPECT_TRUE(tracker->track(shown.view(), camera_, frame * kFrameNs)[0].is_tracked());
      searches += !tracker->candidates().empty();
    }
    return searches;
  };
  EXPECT_EQ(searches_in(one, 60), 60);
  (void)searches_in(one, 4);
  // Squares are seen by two of three usual searches, as many by another contrast and one for covered ones, of
  // twelve frames; never by two in one.
  EXPECT_EQ(searches_in(one, 48), 20);
  (void)searches_in(both, 3);
  EXPECT_TRUE(tracker->track(both.view(), camera_, frame++ * kFrameNs)[1].is_tracked());
  EXPECT_EQ(searches_in(one, 40), 40);
}

// However much of a picture looks like covered squares, a call looks at a part of it, and the calls go round.
TEST(SquareSearch, GoesRoundThePictureForCoveredSquares) {
  constexpr int kSide = 60, kApart = 110, kAcross = 14, kDown = 10;
  const int width = kApart * kAcross, height = kApart * kDown;
  std::vector<std::uint8_t> grey(static_cast<std::size_t>(width) * height, 180);
  const auto is_dark = [](int x, int y) { return x < kSide && y < kSide && x + y > kSide / 3; };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (is_dark(x % kApart - 25, y % kApart - 25) && x % kApart >= 25 && y % kApart >= 25)
        grey[static_cast<std::size_t>(y) * width + x] = 40;
  camera::Calibration calibration;
  calibration.image_size_px = {width, height};
  calibration.focal_px = width;
  calibration.principal_point_px = {0.5 * width, 0.5 * height};
  const camera::CameraModel camera(calibration, 0, 1);
  SquareSearch search;
  search.look_at({grey.data(), width, height, width}, camera);
  std::vector<char> is_found(kAcross * kDown, 0);
  const std::size_t first = search.find_covered(camera).size();
  search.start_over();
  for (int call = 0; call < 20; ++call) {
    const auto squares = search.find_covered(camera);
    EXPECT_LE(squares.size(), 40U);
    EXPECT_TRUE(call > 0 || squares.size() == first);
    for (const FoundSquare& square : squares) {
      const Eigen::Vector2d middle =
          0.25 * (square.corners_px[0] + square.corners_px[1] + square.corners_px[2] + square.corners_px[3]);
      const int column = static_cast<int>(middle.x()) / kApart, row = static_cast<int>(middle.y()) / kApart;
      if (column >= 0 && column < kAcross && row >= 0 && row < kDown) is_found[row * kAcross + column] = 1;
    }
  }
  EXPECT_EQ(std::count(is_found.begin(), is_found.end(), 1), kAcross * kDown);
}

// What breaks the contract is said, with its name.
TEST_F(MarkerTracking, RefusesBadDeclarationsAndFrames) {
  const std::vector<DeclaredMarker> twice = {{2, 4}, {2, 4}}, outside = {{50, 4}}, flat = {{2, 0}},
                                    nan = {{2, std::nan("")}};
  for (const auto& bad : {twice, outside, flat, nan}) {
    EXPECT_THROW((void)make_tracker(bad), InvalidInput);
    EXPECT_THROW((void)make_aruco_tracker(bad), InvalidInput);
  }
  const std::vector<std::uint8_t> small(640 * 480);
  EXPECT_THROW((void)make_tracker(declared_)->track({small.data(), 640, 480, 640}, camera_, 0), InvalidInput);
  EXPECT_THROW((void)make_aruco_tracker(declared_)->track({}, camera_, 0), InvalidInput);
}

// Through a smear an edge is a ramp, which the camera's tone curve bends: by a twelfth of its length, as long
// as it is read by another one. Corners that lay there were held against a right pose.
TEST_F(MarkerTracking, CornersOfASmearedMarkerLieAtItsPose) {
  const auto tracker = make_tracker(std::vector<DeclaredMarker>{{2, 4}});
  const RigidTransform start = facing_pose(-4, -2, 13, -15, 25, 120);
  const geometry::Vector6d open = motion_of(camera_, start, {12, 5});
  for (int frame = 0; frame < 6; ++frame) {
    PlacedMarker moving = placed(2, start * geometry::exp(2.0 * frame * open));
    moving.velocity = open;
    const auto shown = picture({moving}, static_cast<unsigned>(frame));
    const auto& seen = tracker->track(shown.view(), camera_, frame * kFrameNs)[0];
    if (frame == 0) continue;
    ASSERT_TRUE(seen.is_tracked()) << frame << ": " << to_text(seen.state);
    EXPECT_LT(seen.rms_px, 0.4) << frame;
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector3d corner(k % 3 ? 2 : -2, k < 2 ? 2 : -2, 0);
      EXPECT_LT((seen.corners_px[k] - *camera_.project(moving.camera_from_marker * corner)).norm(), 0.6)
          << frame << ", " << k;
    }
  }
}

// After the first frames nothing is allocated: neither while tracking, nor when a marker is lost for the
// first time and searched for, nor under a smear of 12 px or after half a second without a marker, when all
// its pixels are fitted.
TEST_F(MarkerTracking, AllocatesNothingAfterWarmUp) {
  const auto both = picture({placed(0, world_), placed(2, probe_)}), one = picture({placed(2, probe_)}),
             none = picture({});
  PlacedMarker moving = placed(2, probe_);
  moving.velocity = motion_of(camera_, probe_, {9, 8});
  const auto smeared = picture({placed(0, world_), moving});
  const auto tracker = make_tracker(declared_);
  for (int frame = 0; frame < 12; ++frame) (void)tracker->track(both.view(), camera_, frame * kFrameNs);
  int smeared_tracked = 0;
  test::start_counting_allocations();
  for (int frame = 12; frame < 100; ++frame) {
    const bool is_smeared = frame >= 40 && (frame < 44 || frame > 90), is_gone = frame >= 50 && frame < 80;
    const auto& shown = is_smeared ? smeared : is_gone ? none : frame % 4 ? both : one;
    const auto seen = tracker->track(shown.view(), camera_, frame * kFrameNs);
    smeared_tracked += is_smeared && seen[1].is_tracked();
    EXPECT_TRUE(frame != 80 || seen[1].is_tracked());
  }
  EXPECT_EQ(test::stop_counting_allocations(), 0);
  EXPECT_GT(smeared_tracked, 4);
}

// What the tools declare is declared to the tracker, world markers first.
TEST(DeclaredMarkers, FollowTheTools) {
  const auto declared = declared_markers(tools::standard_tools());
  ASSERT_EQ(declared.size(), 5u);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(declared[i].id, i);
}

}  // namespace
}  // namespace arthronaut::markers
