#include "navigation/markers/row_timing.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "navigation/markers/marker_tracker.h"
#include "tests/navigation/markers/rendered_marker.h"

namespace arthronaut::markers {
namespace {

using geometry::RigidTransform;
using geometry::Vector6d;

constexpr std::int64_t kFrameNs = 16'666'667;
constexpr double kExposureShare = 0.5;  // of the time between frames

// How markers sway: by so many pixels a frame at most, along x and y.
struct Sway {
  Eigen::Vector2d most_px{8, 5};
  double phase_rad = 0;
};

// What the tracker makes of two markers that sway before a camera of these delays, in the time between
// frames. In the first frame no motion is known: errors are counted from the second on.
struct Swayed {
  int tracked = 0;
  double mean_square = 0, largest_square = 0;  // normalised: 1 is as the covariance says
  double last_rms_deg = 0;                     // over the second half
};

Swayed track_swaying(double readout, double fields, int frames, const Sway& sway = {}) {
  const camera::CameraModel camera = small_scope();
  const RigidTransform rest[] = {facing_pose(-4.5, 1, 17, 20, 10, 15), facing_pose(4, -1, 15, -15, 25, 120)};
  const std::vector<DeclaredMarker> declared = {{0, 4}, {2, 4}};
  const auto tracker = make_tracker(declared);
  // In pixels, by frames.
  const auto moved = [&sway](double time) {
    return Eigen::Vector2d(sway.most_px.x() / 0.45 * std::sin(0.45 * time + sway.phase_rad),
                           sway.most_px.y() / 0.3 * std::cos(0.3 * time + sway.phase_rad));
  };
  Swayed result;
  double last_squares = 0;
  int last = 0;
  for (int i = 0; i < frames; ++i) {
    std::vector<PlacedMarker> placed;
    for (int m = 0; m < 2; ++m) {
      const RigidTransform there = rest[m] * geometry::exp(motion_of(camera, rest[m], moved(i)));
      const Vector6d velocity = motion_of(camera, rest[m], moved(i + 0.5) - moved(i - 0.5));
      placed.push_back({codes_4x4_50()[declared[m].id], 4, there, kExposureShare * velocity});
    }
    PictureOptions options;
    options.seed = static_cast<unsigned>(i + 1);
    options.readout = readout / kExposureShare;
    options.fields = fields / kExposureShare;
    const RenderedPicture picture(camera, placed, options);
    const auto seen = tracker->track(picture.view(), camera, i * kFrameNs);
    for (int m = 0; m < 2 && i > 0; ++m) {
      if (!seen[m].is_tracked()) continue;
      const Vector6d error =
          geometry::log(seen[m].camera_from_marker.inverse() * placed[m].camera_from_marker);
      const double square = error.dot(seen[m].covariance.inverse() * error) / 6;
      result.mean_square += square;
      result.largest_square = std::max(result.largest_square, square);
      ++result.tracked;
      if (2 * i < frames) continue;
      last_squares += error.tail<3>().squaredNorm();
      ++last;
    }
  }
  result.mean_square /= result.tracked;
  result.last_rms_deg = geometry::deg_from_rad(std::sqrt(last_squares / last));
  return result;
}

// Seven frames after the first, of two markers: at least all but one are measured, none is off by more than
// its covariance allows (a square of 6 would be six sigma in one direction), and once the delays are told the
// poses are nearly as good as at once (0.03 deg), where they were off by 0.7 deg and more.
void expect_told(const Swayed& seen) {
  EXPECT_GE(seen.tracked, 13);
  EXPECT_LT(seen.mean_square, 2);
  EXPECT_LT(seen.largest_square, 6);
  EXPECT_LT(seen.last_rms_deg, 0.15);
}

TEST(RowTiming, ARollingShutterIsToldAndDoubtedUntilThen) { expect_told(track_swaying(0.8, 0, 8)); }

TEST(RowTiming, FieldsAreToldAndDoubtedUntilThen) { expect_told(track_swaying(0, 0.5, 8)); }

// In the second picture a motion is known in the mean of the way alone, and these slow down meanwhile: what
// the rows make of the rest may be off by no more than the covariance allows.
TEST(RowTiming, AMotionThatIsKnownInTheMeanIsDoubted) {
  for (const double readout : {0.8, -0.8}) {
    const Swayed seen = track_swaying(readout, 0, 2, {{8, -6}, 1.8});
    EXPECT_EQ(seen.tracked, 2);
    EXPECT_LT(seen.largest_square, 6) << "readout " << readout;
  }
}

EdgeMeasurement edge_at(double x, double y, double moves_px) {
  EdgeMeasurement edge;
  edge.state = EdgeState::Found;
  edge.point_px = {x, y};
  edge.normal = Eigen::Vector2d::UnitX();
  edge.offset_px = 0.25;
  edge.moves_px = moves_px;
  return edge;
}

RowTrend trend_to(double readout, double weight) {
  RowTrend trend;
  trend.weight.diagonal() << weight, 1;
  trend.gain = trend.weight * Eigen::Vector2d(readout, 0);
  return trend;
}

// One hint, however strong it seems beside what is known beforehand, is taken for nothing until others agree.
TEST(RowTiming, KnowsADelayWhenSeveralPosesAgree) {
  RowTiming timing;
  timing.learn(trend_to(0.3, 25));
  EXPECT_EQ(timing.known()[0], 0);
  EXPECT_GT(timing.uncertainty()(0, 0), 0.1 * 0.1);
  for (int i = 0; i < 30; ++i) timing.learn(trend_to(0.3 - timing.known()[0], 25));
  EXPECT_NEAR(timing.known()[0], 0.3, 0.02);
  EXPECT_LT(timing.uncertainty()(0, 0), 0.1 * 0.1);
}

// A shutter that opens for all rows at once stays at none, and is doubted less and less.
TEST(RowTiming, LearnsThatThereIsNoDelay) {
  RowTiming timing;
  const double before = timing.uncertainty()(0, 0);
  for (int i = 0; i < 60; ++i) timing.learn(trend_to(i % 2 ? 0.4 : -0.4, 10));
  EXPECT_EQ(timing.known(), Eigen::Vector2d::Zero());
  EXPECT_LT(timing.uncertainty()(0, 0), 0.05 * before);
}

TEST(RowTiming, MovesEdgesByTheirRowAndLeavesStillOnesAlone) {
  RowTiming timing;
  for (int i = 0; i < 60; ++i) timing.learn(trend_to(0.5 - timing.known()[0], 100));
  std::vector<EdgeMeasurement> edges = {edge_at(100, 300, 6), edge_at(100, 360, 6), edge_at(100, 360, 0)};
  correct_rows(timing, 300, 600, 1.2, edges);
  EXPECT_DOUBLE_EQ(edges[0].offset_px, 0.25);
  EXPECT_NEAR(edges[1].offset_px, 0.25 - 6 * 0.1 * 0.5, 0.01);
  EXPECT_DOUBLE_EQ(edges[2].offset_px, 0.25);
  EXPECT_TRUE(edges[2].by_delays_px.isZero());
}

}  // namespace
}  // namespace arthronaut::markers
