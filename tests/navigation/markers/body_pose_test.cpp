#include "navigation/markers/body_pose.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

#include "navigation/markers/planar_pose.h"
#include "tests/counted_allocations.h"
#include "tests/navigation/markers/waved_body.h"

namespace arthronaut::markers {
namespace {

using geometry::RigidTransform;
using geometry::Vector6d;

constexpr double kCornerSigma_px = 0.1;

double angle_deg(const RigidTransform& a, const RigidTransform& b) {
  return geometry::deg_from_rad(geometry::rotation_angle_rad(a.rotation.conjugate() * b.rotation));
}

RigidTransform placed(double x_mm, double y_mm, double z_mm, double tilt_deg) {
  return {Eigen::Quaterniond(
              Eigen::AngleAxisd(geometry::rad_from_deg(tilt_deg), Eigen::Vector3d(1, 0.5, 0).normalized())),
          {x_mm, y_mm, z_mm}};
}

class BodyPose : public ::testing::Test {
 protected:
  // Markers whose places are known to sigma_mm and sigma_deg.
  static Body body_of(const std::vector<RigidTransform>& places, double sigma_mm = 0, double sigma_deg = 0) {
    Body body;
    for (std::size_t i = 0; i < places.size(); ++i)
      body.markers.push_back({static_cast<int>(i) + 5, 3.0, places[i], sigma_mm, sigma_deg});
    body.id = 5;
    return body;
  }

  RigidTransform random_pose() {
    std::uniform_real_distribution<double> side(-4, 4), depth(16, 32), tilt(-45, 45), turn(-180, 180);
    const double x = side(random_), y = side(random_), z = depth(random_), a = tilt(random_),
                 b = tilt(random_);
    return facing_pose(x, y, z, a, b, turn(random_));
  }

  Vector6d noise(double sigma_mm, double sigma_rad) {
    Vector6d twist;
    for (int i = 0; i < 6; ++i) twist[i] = (i < 3 ? sigma_mm : sigma_rad) * normal_(random_);
    return twist;
  }

  // What a tracker says of a marker whose corners are off by this much: the pose nearest the truth, as a
  // tracker has it that follows a marker, and the covariance of it.
  MarkerObservation seen(const RigidTransform& camera_from_marker, double size_mm,
                         double sigma_px = kCornerSigma_px) {
    MarkerObservation observation = unseen();
    const auto corners_mm = square_corners_mm(size_mm);
    for (std::size_t k = 0; k < 4; ++k)
      observation.corners_px[k] = *camera_.project(camera_from_marker * corners_mm[k]) +
                                  sigma_px * Eigen::Vector2d(normal_(random_), normal_(random_));
    const auto pose = refine_square_pose(camera_, observation.corners_px, size_mm, camera_from_marker);
    observation.state = MarkerState::Tracked;
    observation.camera_from_marker = pose->camera_from_marker;
    observation.covariance = square_covariance(*pose, sigma_px);
    return observation;
  }

  static MarkerObservation unseen(MarkerState why = MarkerState::NotSeen) {
    MarkerObservation observation{};
    observation.corners_px.fill(Eigen::Vector2d::Zero());
    observation.state = why;
    return observation;
  }

  std::vector<MarkerObservation> all_seen(const Body& body, const RigidTransform& camera_from_body) {
    std::vector<MarkerObservation> observations;
    for (const tools::BodyMarker& marker : body.markers)
      observations.push_back(seen(camera_from_body * marker.body_from_marker, marker.size_mm));
    return observations;
  }

  [[nodiscard]] BodyObservation observe(const Body& body,
                                        const std::vector<MarkerObservation>& seen_ones) const {
    return observe_body(body, seen_ones, camera_);
  }

  // Squared error of a pose over its predicted variance, of each of six.
  static double normalised(const BodyObservation& found, const RigidTransform& truth) {
    const Vector6d error = geometry::log(found.camera_from_body.inverse() * truth);
    return error.dot(found.covariance.ldlt().solve(error)) / 6;
  }

  std::mt19937 random_{11};
  std::normal_distribution<double> normal_;
  camera::CameraModel camera_ = small_scope();
  // Two plates at an angle, and a third beside them.
  const RigidTransform first_, second_ = placed(6, 1, -1, 25), third_ = placed(-5, 3, 0.5, -20);
};

// One marker that is the body says what it says itself, to the last bit.
TEST_F(BodyPose, OfOneMarkerIsThatMarkers) {
  const Body body{2, 0, {{2, 3.0, {}}}};
  const MarkerObservation one = seen(random_pose(), 3.0);
  const BodyObservation found = observe(body, {one});
  ASSERT_TRUE(found.is_tracked());
  EXPECT_EQ(found.camera_from_body.translation_mm, one.camera_from_marker.translation_mm);
  EXPECT_EQ(found.camera_from_body.rotation.coeffs(), one.camera_from_marker.rotation.coeffs());
  EXPECT_EQ(found.covariance, one.covariance);
  EXPECT_EQ(observe(body, {unseen(MarkerState::Glare)}).state, MarkerState::Glare);
}

// Corners off by a tenth of a pixel, places off by what is said of them: errors are what the covariance says.
// 400 poses of six degrees of freedom: the mean has a sigma of 0.03. The covariance is widened where markers
// agree less than predicted, which lowers the mean; hence 0.5 to 1.2 and not 1.
TEST_F(BodyPose, ErrorIsAsPredicted) {
  constexpr double kPlace_mm = 0.03, kPlace_deg = 0.2;
  for (const std::size_t count : {2U, 3U}) {
    std::vector<RigidTransform> places{first_, second_, third_};
    places.resize(count);
    const Body said = body_of(places, kPlace_mm, kPlace_deg);
    double sum = 0;
    int tracked = 0;
    for (int i = 0; i < 400; ++i) {
      Body made = said;
      for (tools::BodyMarker& marker : made.markers)
        marker.body_from_marker =
            marker.body_from_marker * geometry::exp(noise(kPlace_mm, geometry::rad_from_deg(kPlace_deg)));
      const RigidTransform truth = random_pose();
      const BodyObservation found = observe(said, all_seen(made, truth));
      if (!found.is_tracked()) continue;
      ++tracked;
      sum += normalised(found, truth);
    }
    EXPECT_GE(tracked, 398) << count;
    EXPECT_GT(sum / tracked, 0.5) << count;
    EXPECT_LT(sum / tracked, 1.2) << count;
  }
}

// Two markers tell the rotation better than either, and better than their mean: by more than a third less
// error.
TEST_F(BodyPose, IsBetterThanItsBestMarker) {
  const Body body = body_of({first_, second_});
  double fused = 0, alone = 0;
  for (int i = 0; i < 200; ++i) {
    const RigidTransform truth = random_pose();
    const auto observations = all_seen(body, truth);
    const BodyObservation found = observe(body, observations);
    ASSERT_TRUE(found.is_tracked());
    fused += std::pow(angle_deg(found.camera_from_body, truth), 2);
    alone += std::pow(angle_deg(observe(body, {observations[0], unseen()}).camera_from_body, truth), 2);
  }
  EXPECT_LT(std::sqrt(fused / 200), 0.65 * std::sqrt(alone / 200));
}

// A marker whose tilt is not told, seen the wrong way: another that is tracked says which, and two that are
// both ambiguous tell each other.
TEST_F(BodyPose, OneMarkerDecidesTheTiltOfAnother) {
  const Body body = body_of({first_, second_});
  int both_wrong_ways = 0;
  for (int i = 0; i < 100; ++i) {
    const RigidTransform truth = random_pose();
    auto observations = all_seen(body, truth);
    const auto poses = solve_square(camera_, observations[1].corners_px, 3.0);
    if (!poses || !poses->other ||
        angle_deg(poses->best.camera_from_marker, poses->other->camera_from_marker) < 15)
      continue;
    ++both_wrong_ways;
    observations[1].state = MarkerState::Ambiguous;
    observations[1].camera_from_marker = poses->other->camera_from_marker;
    observations[1].covariance = square_covariance(*poses->other, kCornerSigma_px);
    BodyObservation found = observe(body, observations);
    ASSERT_TRUE(found.is_tracked()) << to_text(found.state);
    EXPECT_EQ(found.used_count(), 2);
    EXPECT_LT(angle_deg(found.camera_from_body, truth), 3);
    observations[0].state = MarkerState::Ambiguous;
    found = observe(body, observations);
    EXPECT_TRUE(!found.is_tracked() || angle_deg(found.camera_from_body, truth) < 3);
  }
  EXPECT_GT(both_wrong_ways, 60);
}

// A plate that is bent: of three the wrong one is named and left out; of two none is believed.
TEST_F(BodyPose, NamesTheMarkerThatIsBentAway) {
  const Body said = body_of({first_, second_, third_});
  const RigidTransform bent = placed(1.0, 0, 0.3, 6);
  for (int i = 0; i < 60; ++i) {
    Body made = said;
    made.markers[1].body_from_marker = made.markers[1].body_from_marker * bent;
    const RigidTransform truth = random_pose();
    auto observations = all_seen(made, truth);
    const BodyObservation found = observe(said, observations);
    EXPECT_EQ(found.odd_marker, 6);
    ASSERT_TRUE(found.is_tracked()) << to_text(found.state);
    EXPECT_EQ(found.used, 0b101U);
    EXPECT_LT((found.camera_from_body.translation_mm - truth.translation_mm).norm(), 0.25);
    observations[2] = unseen();
    EXPECT_EQ(observe(said, observations).state, MarkerState::Disagreeing);
  }
}

// Markers that are as they are said to be do not disagree: of 1,000 pairs none. Six numbers together come to
// the limit once in 10^11.
TEST_F(BodyPose, AgreesWhereNothingIsWrong) {
  const Body body = body_of({first_, second_});
  int disagreeing = 0;
  for (int i = 0; i < 1000; ++i)
    disagreeing += observe(body, all_seen(body, random_pose())).state == MarkerState::Disagreeing ? 1 : 0;
  EXPECT_EQ(disagreeing, 0);
}

// What is seen of none is said of the one that came nearest; one that is left carries the body.
TEST_F(BodyPose, SaysWhyThereIsNone) {
  const Body body = body_of({first_, second_});
  const MarkerObservation hidden = unseen(), dazzled = unseen(MarkerState::Glare);
  EXPECT_EQ(observe(body, {hidden, dazzled}).state, MarkerState::Glare);
  EXPECT_EQ(observe(body, {hidden, hidden}).state, MarkerState::NotSeen);
  const RigidTransform truth = random_pose();
  const BodyObservation found = observe(body, {dazzled, seen(truth * second_, 3.0)});
  ASSERT_TRUE(found.is_tracked());
  EXPECT_EQ(found.used, 0b10U);
  EXPECT_LT((found.camera_from_body.translation_mm - truth.translation_mm).norm(), 1.0);
}

// What the tracker says of rendered pictures: nothing disagrees, and the bodies' errors are what is predicted
// of them. 60 frames whose errors hang together: a factor of two either way, as is asked of one marker.
TEST_F(BodyPose, ErrorIsAsPredictedInPictures) {
  const Body body = waved_body();
  double sum = 0;
  int tracked = 0;
  for (const WavedFrame& frame : tracked_wave(body, 60, 1)) {
    const BodyObservation found = observe(body, frame.observations);
    EXPECT_NE(found.state, MarkerState::Disagreeing);
    EXPECT_EQ(found.odd_marker, BodyObservation::kNone);
    if (!found.is_tracked()) continue;
    ++tracked;
    sum += normalised(found, frame.camera_from_body);
    EXPECT_LT(angle_deg(found.camera_from_body, frame.camera_from_body), 1.0);
  }
  EXPECT_GE(tracked, 58);
  EXPECT_GT(sum / tracked, 0.5);
  EXPECT_LT(sum / tracked, 2);
}

TEST_F(BodyPose, AllocatesNothing) {
  const Body body = body_of({first_, second_, third_});
  const auto observations = all_seen(body, random_pose());
  test::start_counting_allocations();
  const BodyObservation found = observe_body(body, observations, camera_);
  EXPECT_EQ(test::stop_counting_allocations(), 0);
  EXPECT_TRUE(found.is_tracked());
}

}  // namespace
}  // namespace arthronaut::markers
