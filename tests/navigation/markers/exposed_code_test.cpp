#include "navigation/markers/exposed_code.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "navigation/markers/product_sum.h"

namespace arthronaut::markers {
namespace {

using geometry::RigidTransform;
using geometry::Vector6d;

constexpr double kSize_mm = 4;

ExposedPose moving_pose() {
  ExposedPose pose;
  pose.camera_from_marker = {
      Eigen::Quaterniond(Eigen::AngleAxisd(geometry::kPi, Eigen::Vector3d::UnitX())) *
          Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 0.5).normalized())),
      {0.7, -0.4, 22}};
  pose.velocity << 0.06, -0.04, 0.02, 0.002, -0.003, 0.004;
  pose.change << 0.02, 0.03, 0, 0, 0, -0.005;
  return pose;
}

// Rays all over the marker and its margin.
LookedAt some_rays(const RigidTransform& camera_from_marker, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-0.6 * kSize_mm, 0.6 * kSize_mm), sigma(0.1, 0.22);
  LookedAt at;
  for (int i = 0; i < kPixelsTogether; ++i) {
    const Eigen::Vector3f ray =
        (camera_from_marker * Eigen::Vector3d(place(random), place(random), 0)).normalized().cast<float>();
    at.ray_x[i] = ray.x();
    at.ray_y[i] = ray.y();
    at.ray_z[i] = ray.z();
    at.sigma_x[i] = static_cast<float>(sigma(random));
    at.sigma_y[i] = static_cast<float>(sigma(random));
  }
  return at;
}

// By the definition: where the ray meets the plane at each moment, the code smeared by a Gaussian, which for
// cells is a sum over them of products of two steps.
double level_by_definition(const MarkerCode& code, const ExposedPose& pose, int moments, const LookedAt& at,
                           int i, double smear = 1) {
  double sum = 0;
  for (int k = 0; k < moments; ++k) {
    const double time = (k + 0.5) / moments - 0.5;
    const RigidTransform marker_from_camera =
        (pose.camera_from_marker * geometry::exp(time * pose.velocity + 0.5 * time * time * pose.change))
            .inverse();
    const Eigen::Vector3d eye = marker_from_camera.translation_mm,
                          way = marker_from_camera.rotate({at.ray_x[i], at.ray_y[i], at.ray_z[i]});
    const Eigen::Vector3d place = eye - eye.z() / way.z() * way;
    const double column = (place.x() / kSize_mm + 0.5) * code.cells,
                 row = (0.5 - place.y() / kSize_mm) * code.cells;
    const auto share = [](double from, double to, double of, double sigma) {
      return 0.5 *
             (std::erf((to - of) / sigma / std::sqrt(2.0)) - std::erf((from - of) / sigma / std::sqrt(2.0)));
    };
    double dark = 0;
    for (int r = 0; r < code.cells; ++r) {
      for (int c = 0; c < code.cells; ++c) {
        if (!code.is_bright(r, c))
          dark +=
              share(c, c + 1, column, smear * at.sigma_x[i]) * share(r, r + 1, row, smear * at.sigma_y[i]);
      }
    }
    sum += (1 - dark) / moments;
  }
  return sum;
}

// To what single precision and the differences leave: the largest derivatives are some 5 a mm or a radian.
// Cells beyond the next one are left out, which tells where the smear is more than a fifth of a cell.
TEST(ExposedCode, LooksAsItsDefinitionSays) {
  const MarkerCode code = codes_4x4_50()[3];
  constexpr int kMoments = 7;
  for (unsigned seed = 0; seed < 30; ++seed) {
    const ExposedPose pose = moving_pose();
    const LookedAt at = some_rays(pose.camera_from_marker, seed);
    ExposedCode exposed(code, kSize_mm);
    exposed.move(pose, kMoments);
    SeenLevels levels;
    exposed.look(at, levels);
    const auto numeric = [&](int i, const auto& changed) {
      constexpr double kStep = 1e-4;
      ExposedPose more = pose, less = pose;
      changed(more, kStep);
      changed(less, -kStep);
      return (level_by_definition(code, more, kMoments, at, i) -
              level_by_definition(code, less, kMoments, at, i)) /
             (2 * kStep);
    };
    for (int i = 0; i < kPixelsTogether; ++i) {
      EXPECT_NEAR(levels.level[i], level_by_definition(code, pose, kMoments, at, i), 0.001);
      for (int k = 0; k < 6; ++k) {
        EXPECT_NEAR(levels.by_pose[k][i],
                    numeric(i,
                            [k](ExposedPose& p, double step) {
                              p.camera_from_marker =
                                  p.camera_from_marker * geometry::exp(step * Vector6d::Unit(k));
                            }),
                    0.03)
            << k;
      }
      for (int k = 0; k < 3; ++k) {
        const int axis = k < 2 ? k : 5;
        EXPECT_NEAR(levels.by_velocity[k][i],
                    numeric(i, [axis](ExposedPose& p, double step) { p.velocity[axis] += step; }), 0.03);
        EXPECT_NEAR(levels.by_change[k][i],
                    numeric(i, [axis](ExposedPose& p, double step) { p.change[axis] += step; }), 0.03);
      }
      const double by_smear = (level_by_definition(code, pose, kMoments, at, i, 1.001) -
                               level_by_definition(code, pose, kMoments, at, i, 0.999)) /
                              0.002;
      EXPECT_NEAR(levels.by_smear[i], by_smear, 0.03);
    }
  }
}

// A recording gives the same poses on every machine.
TEST(ExposedKernel, GivesTheSameBitsOnEveryProcessor) {
  if (!processor_has_avx2()) GTEST_SKIP() << "no AVX2 here";
  ExposedMoments moments{};
  moments.cells = 6;
  moments.width = 10;
  moments.cells_per_mm = 1.5F;
  moments.count = 3;
  std::mt19937 random(5);
  for (std::uint16_t& bits : moments.neighbours) bits = static_cast<std::uint16_t>(random() & 511U);
  for (int k = 0; k < moments.count; ++k) {
    const float turn[9] = {1, 0.02F * static_cast<float>(k), 0, -0.02F * static_cast<float>(k), -1, 0, 0, 0,
                           -1};
    std::memcpy(moments.moments[k].marker_from_camera, turn, sizeof turn);
    moments.moments[k].eye[0] = 0.1F * static_cast<float>(k);
    moments.moments[k].eye[1] = 0.3F;
    moments.moments[k].eye[2] = 20;
    moments.moments[k].time = 0.3F * static_cast<float>(k - 1);
  }
  const RigidTransform facing{Eigen::Quaterniond(0, 1, 0, 0), {0, 0, 20}};
  for (unsigned seed = 0; seed < 20; ++seed) {
    const LookedAt at = some_rays(facing, seed);
    SeenLevels plain, wide;
    look_at_code(moments, at, plain);
    look_at_code_avx2(moments, at, wide);
    EXPECT_EQ(std::memcmp(&plain, &wide, sizeof plain), 0);
    // What looks for levels alone gets the same ones.
    SeenLevels plain_level{}, wide_level{};
    look_at_level(moments, at, plain_level);
    look_at_level_avx2(moments, at, wide_level);
    EXPECT_EQ(std::memcmp(plain.level, plain_level.level, sizeof plain.level), 0);
    EXPECT_EQ(std::memcmp(plain.level, wide_level.level, sizeof plain.level), 0);
  }
  std::normal_distribution<float> normal;
  float rows[kPixelsTogether][kProductSize], plain[kProductSize][kProductSize] = {},
                                             wide[kProductSize][kProductSize] = {};
  for (auto& row : rows)
    for (float& value : row) value = normal(random);
  add_products(rows, kProductSize, plain);
  add_products_avx2(rows, kProductSize, wide);
  EXPECT_EQ(std::memcmp(plain, wide, sizeof plain), 0);
}

struct Fitted {
  FittedLight light;
  SeenPixels pixels;
  SeenLevels levels;
};

Fitted some_fit(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> share(0, 1);
  Fitted fit;
  for (float& term : fit.light.terms) term = 20 * (share(random) - 0.5F);
  fit.light.terms[0] = 40 + 100 * share(random);
  fit.light.terms[DirectUnknowns::kBiasTerms] = 80;
  fit.light.gamma = 1 + share(random);
  fit.light.noise = 60;
  fit.light.has_weights = false;
  for (int i = 0; i < kPixelsTogether; ++i) {
    fit.pixels.grey[i] = 255 * share(random);
    fit.pixels.place_x[i] = 2 * share(random) - 1;
    fit.pixels.place_y[i] = 2 * share(random) - 1;
    fit.pixels.weight[i] = share(random);
    fit.levels.level[i] = share(random);
    fit.levels.by_smear[i] = share(random) - 0.5F;
    for (auto& part : fit.levels.by_pose) part[i] = share(random) - 0.5F;
    for (auto& part : fit.levels.by_velocity) part[i] = share(random) - 0.5F;
    for (auto& part : fit.levels.by_change) part[i] = share(random) - 0.5F;
  }
  return fit;
}

// The grey level is the tone curve of the light; its derivatives by what is put in.
TEST(ExposedKernel, ExplainsPixelsAsTheToneCurveSays) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Fitted fit = some_fit(seed);
    fit.light.has_weights = true;
    ExplainedPixels explained;
    explain_pixels(fit.light, fit.pixels, fit.levels, explained);
    const auto grey = [&](int i, double level, double gamma, double more_bias) {
      const double x = fit.pixels.place_x[i], y = fit.pixels.place_y[i];
      const double terms[] = {1, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y};
      double bias = more_bias, gain = 0;
      for (int k = 0; k < DirectUnknowns::kBiasTerms; ++k) bias += fit.light.terms[k] * terms[k];
      for (int k = 0; k < DirectUnknowns::kGainTerms; ++k)
        gain += fit.light.terms[DirectUnknowns::kBiasTerms + k] * terms[k];
      return 255 * std::pow(std::max(0.3, bias + gain * level) / 255, 1 / gamma);
    };
    for (int i = 0; i < kPixelsTogether; ++i) {
      const double level = fit.levels.level[i], gamma = fit.light.gamma,
                   root = std::sqrt(fit.pixels.weight[i]);
      if (grey(i, level, gamma, 0) < 20) continue;  // where the light ends
      EXPECT_NEAR(explained.residual[i], fit.pixels.grey[i] - grey(i, level, gamma, 0), 1e-3);
      EXPECT_EQ(explained.weight[i], fit.pixels.weight[i]);
      const double by_level = (grey(i, level + 1e-4, gamma, 0) - grey(i, level - 1e-4, gamma, 0)) / 2e-4;
      EXPECT_NEAR(explained.code[i], by_level * (level - 0.5), 0.02);
      for (int k = 0; k < 6; ++k)
        EXPECT_NEAR(explained.rows[i][k], root * by_level * fit.levels.by_pose[k][i], 0.02);
      const double by_gamma = (grey(i, level, gamma + 1e-4, 0) - grey(i, level, gamma - 1e-4, 0)) / 2e-4;
      EXPECT_NEAR(explained.rows[i][DirectUnknowns::kGamma], root * by_gamma, 0.02);
      const double by_bias = (grey(i, level, gamma, 1e-3) - grey(i, level, gamma, -1e-3)) / 2e-3;
      EXPECT_NEAR(explained.rows[i][DirectUnknowns::kLight], root * by_bias, 0.002);
      EXPECT_EQ(explained.rows[i][DirectUnknowns::kCount], 0);
    }
  }
}

TEST(ExposedKernel, ExplainsPixelsWithTheSameBitsOnEveryProcessor) {
  if (!processor_has_avx2()) GTEST_SKIP() << "no AVX2 here";
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Fitted fit = some_fit(seed);
    ExplainedPixels plain, wide;
    explain_pixels(fit.light, fit.pixels, fit.levels, plain);
    explain_pixels_avx2(fit.light, fit.pixels, fit.levels, wide);
    EXPECT_EQ(std::memcmp(&plain, &wide, sizeof plain), 0);
  }
}

// To what single precision leaves of sums of 24.
TEST(ProductSum, AddsProductsOfRows) {
  std::mt19937 random(9);
  std::normal_distribution<float> normal;
  ProductSum products;
  ProductSum::Square expected = ProductSum::Square::Zero();
  for (int eight = 0; eight < 3; ++eight) {
    float rows[kPixelsTogether][kProductSize];
    for (auto& row : rows) {
      for (float& value : row) value = normal(random);
      const Eigen::Map<const Eigen::Matrix<float, kProductSize, 1>> column(row);
      expected += column * column.transpose();
    }
    products.add(rows);
  }
  EXPECT_LT((products.take() - expected).cwiseAbs().maxCoeff(), 1e-4F);
  EXPECT_EQ(products.take().cwiseAbs().maxCoeff(), 0);
}

// Without a motion the last of the unknowns are left out, and the sums of the others stay the same to the
// bit.
TEST(ProductSum, LeavesOutWhatAPictureOfOneMomentDoesNotShow) {
  const RigidTransform facing{Eigen::Quaterniond(0, 1, 0, 0), {0, 0, 20}};
  ExposedCode exposed(codes_4x4_50()[0], 4.0);
  exposed.move({facing, geometry::Vector6d::Constant(0.1), geometry::Vector6d::Constant(0.05)}, 1);
  EXPECT_FALSE(exposed.shows_motion());
  Fitted fit = some_fit(3);
  exposed.look(some_rays(facing, 3), fit.levels);
  ExplainedPixels explained;
  explain_pixels(fit.light, fit.pixels, fit.levels, explained);
  ProductSum all, first;
  all.add(explained.rows);
  first.add(explained.rows, DirectUnknowns::kVelocity);
  const ProductSum::Square sum = all.take();
  EXPECT_GT(sum.diagonal().head<6>().minCoeff(), 0);
  EXPECT_EQ(sum, first.take());
  exposed.move({facing, geometry::Vector6d::Constant(0.1), geometry::Vector6d::Zero()}, 2);
  EXPECT_TRUE(exposed.shows_motion());
}

}  // namespace
}  // namespace arthronaut::markers
