// Why a declared marker is not tracked: one constructed picture, or a short story of pictures, for each
// reason.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "navigation/markers/marker_tracker.h"
#include "tests/navigation/markers/rendered_marker.h"

namespace arthronaut::markers {
namespace {

using geometry::RigidTransform;

constexpr std::int64_t kFrameNs = 16'666'667;

class Reasons : public ::testing::Test {
 protected:
  RenderedPicture picture(const RigidTransform& pose,
                          const geometry::Vector6d& velocity = geometry::Vector6d::Zero(),
                          const PictureOptions& options = {}) const {
    return {camera_, {{codes_4x4_50()[2], 4, pose, velocity}}, options};
  }
  MarkerState show(const RenderedPicture& shown) {
    const auto& seen = tracker_->track(shown.view(), camera_, frame_++ * kFrameNs)[0];
    if (seen.is_tracked()) last_ = seen.camera_from_marker;
    return seen.state;
  }
  camera::CameraModel camera_ = small_scope();
  std::unique_ptr<MarkerTracker> tracker_ = make_tracker(std::vector<DeclaredMarker>{{2, 4}});
  RigidTransform last_;
  std::int64_t frame_ = 0;
};

// Never seen: the reason is not known.
TEST_F(Reasons, UnknownWhenNothingIsThere) {
  const RenderedPicture empty(camera_, {});
  EXPECT_EQ(show(empty), MarkerState::NotSeen);
}

// Half of it beyond the rim.
TEST_F(Reasons, OutOfView) {
  MarkerState state = MarkerState::Tracked;
  for (int i = 0; i < 16 && state == MarkerState::Tracked; ++i)
    state = show(picture(facing_pose(5 + 0.6 * i, -1, 16, 10, 15, 20)));
  EXPECT_EQ(state, MarkerState::OutOfView);
}

// It goes away until a cell is less than 3 px wide: at 105 mm the whole square is 17 px.
TEST_F(Reasons, TooSmall) {
  MarkerState state = MarkerState::Tracked;
  double depth_mm = 40;
  for (; depth_mm < 130 && state != MarkerState::TooSmall; depth_mm *= 1.12)
    state = show(picture(facing_pose(0, 0, depth_mm, 25, 15, 20)));
  EXPECT_EQ(state, MarkerState::TooSmall);
}

// It turns away to 80 degrees and more.
TEST_F(Reasons, TooOblique) {
  MarkerState state = MarkerState::Tracked;
  double tilt_deg = 50;
  for (; tilt_deg < 89 && state == MarkerState::Tracked; tilt_deg += 3)
    state = show(picture(facing_pose(1, 0, 14, tilt_deg, 4, 10)));
  EXPECT_EQ(state, MarkerState::TooOblique) << to_text(state);
  EXPECT_GT(tilt_deg, 60);
}

// A tool across nine tenths of it.
TEST_F(Reasons, Covered) {
  const RigidTransform pose = facing_pose(4, -2, 15, -15, 25, 120);
  for (int i = 0; i < 3; ++i) ASSERT_EQ(show(picture(pose)), MarkerState::Tracked);
  auto shown = picture(pose);
  const Eigen::Vector2d middle = camera_.project(pose.translation_mm).value();
  shown.cover(static_cast<int>(middle.x()) - 70, 0, static_cast<int>(middle.x()) + 45, 600, 120);
  EXPECT_EQ(show(shown), MarkerState::Covered);
}

// The light's mirror image burns most of it out.
TEST_F(Reasons, Glare) {
  const RigidTransform pose = facing_pose(4, -2, 15, -15, 25, 120);
  for (int i = 0; i < 3; ++i) ASSERT_EQ(show(picture(pose)), MarkerState::Tracked);
  auto shown = picture(pose);
  const Eigen::Vector2d middle = camera_.project(pose.translation_mm).value();
  shown.shine(middle.x(), middle.y(), 60, 900);
  EXPECT_EQ(show(shown), MarkerState::Glare);
}

// Ever faster, until it is smeared over more than two cells: no edge is left across the motion.
TEST_F(Reasons, Blur) {
  MarkerState state = MarkerState::Tracked;
  double x_mm = -5, step_mm = 0.15;
  for (int i = 0; i < 9; ++i) {
    const RigidTransform pose = facing_pose(x_mm, 0.3 * x_mm, 15, 10, -15, 40);
    const geometry::Vector6d velocity =
        geometry::log(pose.inverse() * facing_pose(x_mm + step_mm, 0.3 * (x_mm + step_mm), 15, 10, -15, 40));
    state = show(picture(pose, velocity));
    if (state != MarkerState::Tracked) break;
    x_mm += step_mm;
    step_mm *= 1.7;
  }
  EXPECT_EQ(state, MarkerState::Blur) << to_text(state);
}

// No hand tilts it by 55 degrees from picture to picture: what looks like it does not stand for 70 ms.
TEST_F(Reasons, DoubtfulWhereNoHandTurnsIt) {
  for (int i = 0; i < 3; ++i)
    ASSERT_EQ(show(picture(facing_pose(0.5, 0.3, 15, 30, 12, 25))), MarkerState::Tracked);
  const RenderedPicture tilted = picture(facing_pose(0.5, 0.3, 15, -25, 12, 25));
  for (int i = 0; i < 4; ++i) EXPECT_NE(show(tilted), MarkerState::Tracked) << "picture " << i;
  EXPECT_EQ(show(tilted), MarkerState::Tracked);
}

// Something lies on its cells and leaves the outline, which may as well be that of something else.
TEST_F(Reasons, CoveredWhereOnlyTheOutlineIsLeft) {
  const RigidTransform pose = facing_pose(0, 0, 15, 12, 8, 0);
  for (int i = 0; i < 3; ++i) ASSERT_EQ(show(picture(pose)), MarkerState::Tracked);
  auto shown = picture(pose);
  const auto from = *camera_.project(pose * Eigen::Vector3d(-1.2, 1.2, 0)),
             to = *camera_.project(pose * Eigen::Vector3d(1.2, -1.2, 0));
  const auto [left, right] = std::minmax(from.x(), to.x());
  const auto [top, bottom] = std::minmax(from.y(), to.y());
  shown.cover(static_cast<int>(left), static_cast<int>(top), static_cast<int>(right),
              static_cast<int>(bottom), 45);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(show(shown), MarkerState::Covered) << "picture " << i;
}

// Far and nearly head-on both planar poses explain what noise leaves of the corners: it may be refused as
// ambiguous or doubtful, but ambiguity must be named, and no pose that stands may be flipped.
TEST_F(Reasons, Ambiguous) {
  int ambiguous = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    tracker_->reset();
    PictureOptions noisy;
    noisy.noise_grey = 5;
    noisy.seed = seed;
    const RigidTransform pose = facing_pose(0.5, 0.3, 62, 9, 4, 15);
    const MarkerState state = show(picture(pose, geometry::Vector6d::Zero(), noisy));
    ambiguous += state == MarkerState::Ambiguous;
    if (state != MarkerState::Tracked) continue;
    EXPECT_LT(
        geometry::deg_from_rad(geometry::rotation_angle_rad(last_.rotation.conjugate() * pose.rotation)), 6);
  }
  EXPECT_GE(ambiguous, 1);
}

}  // namespace
}  // namespace arthronaut::markers
