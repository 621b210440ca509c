#include "navigation/strokes/stroke_tangents.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::strokes {

namespace {

// A circle of 15 mm radius, sampled each `step_mm`, with white noise.
Curves circle(double step_mm, double noise_mm, double turn_rad = 5.0) {
  std::mt19937 random(9);
  std::normal_distribution<double> normal(0, noise_mm);
  Curves curves;
  for (double angle = 0; angle < turn_rad; angle += step_mm / 15) {
    CurvePoint point;
    point.position_mm = {15 * std::cos(angle), 15 * std::sin(angle), 4.0};
    if (noise_mm > 0) point.position_mm += Eigen::Vector3d(normal(random), normal(random), normal(random));
    curves.push_back(point);
  }
  return curves;
}

double tangent_error_rad(const OrientedPoint& point) {
  const Eigen::Vector3d truth =
      Eigen::Vector3d(-point.position_mm.y(), point.position_mm.x(), 0).normalized();
  return std::asin(std::min(1.0, point.tangent.cross(truth).norm()));
}

}  // namespace

// On a clean circle the local quadratic is off by its third order: 2.4^2/(10*15^2) rad is 0.15 degrees.
TEST(StrokeTangents, CleanCircleGivesItsTangents) {
  const auto oriented = oriented_points(circle(0.4, 0));
  ASSERT_GT(oriented.size(), 50u);
  for (const OrientedPoint& point : oriented) EXPECT_LT(tangent_error_rad(point), 0.005);
}

// The error that is predicted from the scatter about the local curve is the error that there is.
TEST(StrokeTangents, PredictedErrorMatchesTheRealOne) {
  const auto oriented = oriented_points(circle(0.4, 0.15));
  ASSERT_GT(oriented.size(), 40u);
  double real = 0, predicted = 0;
  for (const OrientedPoint& point : oriented) {
    real += tangent_error_rad(point) * tangent_error_rad(point) / 2;  // two directions across the tangent
    predicted += point.tangent_error_rad * point.tangent_error_rad;
  }
  EXPECT_GT(std::sqrt(real / predicted), 0.6);
  EXPECT_LT(std::sqrt(real / predicted), 1.7);
}

// A burst of lifted samples bends no tangent beside it by more than a few degrees, and single spikes none.
TEST(StrokeTangents, SpikesDontBendTangents) {
  Curves curves = circle(0.4, 0.02);
  for (std::size_t i = 7; i < curves.size(); i += 9) curves[i].position_mm.z() += 3;
  const auto oriented = oriented_points(curves);
  ASSERT_GT(oriented.size(), 30u);
  for (const OrientedPoint& point : oriented) EXPECT_LT(tangent_error_rad(point), 0.05);
}

// Noise of dense samples does not lengthen the path; 75 mm of circle at 0.05 mm steps with 0.1 mm of noise.
TEST(StrokeTangents, LengthIsThatOfThePathNotOfTheNoise) {
  EXPECT_NEAR(smoothed_length_mm(circle(0.4, 0)), 75.0, 1.0);
  EXPECT_NEAR(smoothed_length_mm(circle(0.05, 0.1)), 75.0, 8.0);
}

// Points that say nothing about a direction give none.
TEST(StrokeTangents, DwellAndTooFewPointsGiveNothing) {
  EXPECT_TRUE(oriented_points({}).empty());
  EXPECT_TRUE(oriented_points(Curves(100)).empty());
  EXPECT_TRUE(oriented_points(circle(0.4, 0, 0.05)).empty());
  EXPECT_EQ(smoothed_length_mm({}), 0.0);
}

}  // namespace arthronaut::strokes
