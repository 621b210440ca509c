#include "navigation/registration/search/weighted_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace arthronaut::registration {

namespace {

// Along a circle of 20 mm radius, as wide as a condyle, with white noise in each coordinate.
strokes::Curves noisy_arc(int curve, int count, double step_mm, double noise_mm) {
  constexpr double kRadius_mm = 20;
  std::mt19937_64 random(static_cast<std::uint64_t>(curve) + 1);
  const auto noise = [&] {  // sum of twelve: near enough to a normal law
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += static_cast<double>(random() >> 11) * 0x1p-53;
    return noise_mm * sum;
  };
  strokes::Curves curves;
  for (int i = 0; i < count; ++i) {
    const double angle = i * step_mm / kRadius_mm;
    curves.push_back({curve, i / 60.0,
                      Eigen::Vector3d(kRadius_mm * std::cos(angle) + noise(),
                                      kRadius_mm * std::sin(angle) + noise(), noise())});
  }
  return curves;
}

double rms_off_arc_mm(const WeightedPoints& points) {
  double sum = 0;
  for (const Eigen::Vector3d& p : points.positions_mm) sum += std::pow(p.head<2>().norm() - 20, 2);
  return std::sqrt(sum / static_cast<double>(points.positions_mm.size()));
}

}  // namespace

// A quadratic over a dozen samples leaves 0.41 of white noise in its middle, its robust weights a little
// more; and it does not cut the corner.
TEST(WeightedPoints, SmoothedPointsHoldLessNoiseThanSamples) {
  const strokes::Curves curves = noisy_arc(0, 720, 0.4, 0.25);
  const WeightedPoints raw = choose_points(curves, 800);
  const WeightedPoints smooth = choose_points(curves, 800, strokes::oriented_points(curves));
  EXPECT_EQ(raw.positions_mm.size(), curves.size());
  EXPECT_NEAR(rms_off_arc_mm(raw), 0.25, 0.03);
  EXPECT_GT(smooth.positions_mm.size(), 200u);
  EXPECT_LT(rms_off_arc_mm(smooth), 0.6 * rms_off_arc_mm(raw));
  EXPECT_EQ(smooth.stretches.size(), smooth.positions_mm.size());
}

// The path begins anew with each stroke, grows along it, and is as long as what was touched.
TEST(WeightedPoints, PathGrowsAlongEachStroke) {
  strokes::Curves curves = noisy_arc(0, 100, 0.5, 0);
  const strokes::Curves second = noisy_arc(1, 50, 0.5, 0);
  curves.insert(curves.end(), second.begin(), second.end());
  for (strokes::CurvePoint& point : curves) point.position_mm.z() += 10 * point.curve;
  const WeightedPoints points = choose_points(curves, 800);
  ASSERT_EQ(points.path_mm.size(), curves.size());
  EXPECT_EQ(points.path_mm.front(), 0);
  EXPECT_EQ(points.path_mm[100], 0);
  for (std::size_t i = 1; i < 100; ++i) EXPECT_GT(points.path_mm[i], points.path_mm[i - 1]);
  // Cells of 1 mm that an arc cuts across its corners count as whole ones.
  EXPECT_GT(points.path_mm[99], 50);
  EXPECT_LT(points.path_mm[99], 1.6 * 50);
  EXPECT_NEAR(points.path_mm.back() / points.path_mm[99], 0.5, 0.1);
}

// A stroke too coarse to be smoothed keeps its samples, beside one that is smoothed.
TEST(WeightedPoints, CoarseStrokesKeepTheirSamples) {
  strokes::Curves curves = noisy_arc(0, 180, 0.4, 0.1);
  const WeightedPoints first = choose_points(curves, 800, strokes::oriented_points(curves));
  const strokes::Curves coarse = noisy_arc(1, 12, 3.0, 0.1);
  curves.insert(curves.end(), coarse.begin(), coarse.end());
  const WeightedPoints both = choose_points(curves, 800, strokes::oriented_points(curves));
  ASSERT_EQ(both.positions_mm.size(), first.positions_mm.size() + coarse.size());
  EXPECT_EQ(both.positions_mm.back(), coarse.back().position_mm);
  EXPECT_GT(both.stretches.back(), first.stretches.back());
}

}  // namespace arthronaut::registration
