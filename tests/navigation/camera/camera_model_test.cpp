#include "navigation/camera/camera_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "navigation/camera/medium.h"
#include "planning/geometry/error.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::camera {

namespace {

Calibration scope(double xi) {
  return {.image_size_px = {1920, 1080},
          .focal_px = 590,
          .aspect_ratio = 1,
          .principal_point_px = {962, 541.5},
          .distortion_xi = xi,
          .rotation_center_px = {958, 538},
          .reference_mark_angle_deg = 271.3,
          .boundary = {{960.5, 540.2}, 531},
          .refractive_index = 1};
}

// A point in view: within `max_deg` of the axis, 8 to 60 mm away.
Eigen::Vector3d random_point(std::mt19937& random, double max_deg) {
  std::uniform_real_distribution<double> angle(0, geometry::rad_from_deg(max_deg)),
      turn(-geometry::kPi, geometry::kPi), distance(8, 60);
  const double a = angle(random), t = turn(random);
  return distance(random) *
         Eigen::Vector3d(std::sin(a) * std::cos(t), std::sin(a) * std::sin(t), std::cos(a));
}

struct Setting {
  double xi, index, aspect;
  FluidModel fluid;
};

class CameraModelSettings : public ::testing::TestWithParam<Setting> {
 protected:
  CameraModel camera(double lens_angle_rad = 0.4) const {
    auto calibration = scope(GetParam().xi);
    calibration.aspect_ratio = GetParam().aspect;
    return CameraModel(calibration, lens_angle_rad, GetParam().index, GetParam().fluid);
  }
};

}  // namespace

// Inverse after forward returns to the pixel to 1e-9 px and to the direction to 1e-12 rad: both are closed
// forms, so only rounding is left.
TEST_P(CameraModelSettings, RoundTripIsExact) {
  std::mt19937 random(1);
  const auto model = camera();
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d point = random_point(random, 40);
    const auto pixel = model.project(point);
    ASSERT_TRUE(pixel);
    const auto ray = model.ray(*pixel);
    ASSERT_TRUE(ray);
    EXPECT_LT(geometry::angle_between_rad(*ray, point), 1e-12);
    const auto again = model.project(*ray * 25);
    ASSERT_TRUE(again);
    EXPECT_LT((*again - *pixel).norm(), 1e-9);
  }
}

// Analytic Jacobians against central differences (step 1e-5: truncation below 1e-8, rounding below 1e-7).
TEST_P(CameraModelSettings, JacobiansMatchDifferences) {
  std::mt19937 random(2);
  const auto model = camera();
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d point = random_point(random, 40);
    Eigen::Matrix<double, 2, 3> d_pixel, numeric;
    const auto pixel = model.project(point, d_pixel);
    ASSERT_TRUE(pixel);
    constexpr double kStep = 1e-5;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(k);
      numeric.col(k) = (*model.project(point + step) - *model.project(point - step)) / (2 * kStep);
    }
    EXPECT_LT((d_pixel - numeric).norm(), 1e-6 * d_pixel.norm());

    Eigen::Matrix2d d_tangent, numeric_tangent;
    ASSERT_TRUE(model.undistort(*pixel, d_tangent));
    constexpr double kPixelStep = 1e-3;
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector2d step = kPixelStep * Eigen::Vector2d::Unit(k);
      numeric_tangent.col(k) =
          (*model.undistort(*pixel + step) - *model.undistort(*pixel - step)) / (2 * kPixelStep);
    }
    EXPECT_LT((d_tangent - numeric_tangent).norm(), 1e-6 * d_tangent.norm());
  }
}

// The pixel's derivative to the lens itself, against cameras that have a little more or less of each (steps
// of a millionth to a thousandth: truncation and rounding below 1e-6).
TEST_P(CameraModelSettings, LensJacobiansMatchDifferences) {
  const Eigen::Vector3d point(6, -4, 21);
  const auto jacobian = camera().d_pixel_d_lens(point);
  ASSERT_TRUE(jacobian);
  const double step[4] = {1e-3, 1e-6, 1e-3, 1e-3};
  for (int k = 0; k < 4; ++k) {
    const auto pixel_with = [&](double change) {
      auto calibration = scope(GetParam().xi);
      calibration.aspect_ratio = GetParam().aspect;
      if (k == 0) calibration.focal_px += change;
      if (k == 1) calibration.distortion_xi += change;
      if (k >= 2) {  // a shift of both moves the principal point alike at every lens angle
        calibration.principal_point_px[k - 2] += change;
        calibration.rotation_center_px[k - 2] += change;
      }
      return *CameraModel(calibration, 0.4, GetParam().index, GetParam().fluid).project(point);
    };
    const Eigen::Vector2d numeric = (pixel_with(step[k]) - pixel_with(-step[k])) / (2 * step[k]);
    EXPECT_LT((jacobian->col(k) - numeric).norm(), 1e-6 * (1 + numeric.norm())) << "parameter " << k;
  }
  EXPECT_FALSE(camera().d_pixel_d_lens({0, 0, -1}));
}

INSTANTIATE_TEST_SUITE_P(DryAndWet, CameraModelSettings,
                         ::testing::Values(Setting{-0.3, 1, 1, FluidModel::FlatPort},
                                           Setting{-0.7, 1, 1, FluidModel::FlatPort},
                                           Setting{0.2, 1, 1, FluidModel::FlatPort},
                                           Setting{0, 1, 1, FluidModel::FlatPort},
                                           Setting{-0.3, kSalineIndex, 1, FluidModel::FlatPort},
                                           Setting{-0.7, kWaterIndex, 1, FluidModel::FlatPort},
                                           Setting{0.05, kSalineIndex, 1.02, FluidModel::FlatPort},
                                           Setting{-0.45, kSalineIndex, 1, FluidModel::FocalRule}));

// Turning the lens by delta moves the picture of a fixed lens-frame scene by Rot(delta; q):
// project(K_delta, R_z X) == Rot(delta; q) project(K_0, X).
TEST(CameraModel, LensRotationIdentity) {
  std::mt19937 random(3);
  const auto calibration = scope(-0.4);
  for (const double index : {1.0, kSalineIndex}) {
    const CameraModel straight(calibration, 0, index);
    for (int i = 0; i < 500; ++i) {
      const double delta = std::uniform_real_distribution<double>(-3, 3)(random);
      const CameraModel turned(calibration, delta, index);
      const Eigen::Vector3d point = random_point(random, 40);
      const Eigen::AngleAxisd spin(delta, Eigen::Vector3d::UnitZ());
      const auto expected = calibration.turned(*straight.project(point), delta);
      EXPECT_LT((*turned.project(spin * point) - expected).norm(), 1e-9);
    }
  }
}

// Rot(alpha) turns +x towards +y (down): a quarter turn takes the point right of the centre to below it.
TEST(CameraModel, PositiveLensAngleTurnsXTowardsY) {
  auto calibration = scope(-0.3);
  const Eigen::Vector2d right = calibration.rotation_center_px + Eigen::Vector2d(10, 0);
  EXPECT_LT(
      (calibration.turned(right, geometry::kPi / 2) - calibration.rotation_center_px - Eigen::Vector2d(0, 10))
          .norm(),
      1e-12);
  EXPECT_NEAR(calibration.lens_angle_rad(271.3 + 20), geometry::rad_from_deg(20), 1e-12);
  EXPECT_NEAR(calibration.lens_angle_rad(11.3), geometry::rad_from_deg(100), 1e-12);
  EXPECT_NEAR(calibration.lens_angle_rad(251.3), geometry::rad_from_deg(-20), 1e-12);
}

// The port obeys Snell's law: sin in air = n sin in saline for the same pixel.
TEST(CameraModel, FlatPortObeysSnell) {
  const CameraModel dry(scope(-0.3), 0, 1), wet(scope(-0.3), 0, kSalineIndex);
  for (double r = 10; r < 500; r += 10) {
    const Eigen::Vector2d pixel = dry.principal_point_px() + Eigen::Vector2d(r, 0.3 * r);
    const double air = geometry::angle_between_rad(*dry.ray(pixel), Eigen::Vector3d::UnitZ());
    const double saline = geometry::angle_between_rad(*wet.ray(pixel), Eigen::Vector3d::UnitZ());
    EXPECT_NEAR(std::sin(air), kSalineIndex * std::sin(saline), 1e-12);
  }
}

// A camera calibrated in water and used in water refracts nothing; wet with ratio 1 equals dry.
TEST(CameraModel, SameMediumMeansNoRefraction) {
  auto in_water = scope(-0.3);
  in_water.refractive_index = kWaterIndex;
  const CameraModel a(in_water, 0.2, kWaterIndex), b(scope(-0.3), 0.2, 1);
  std::mt19937 random(4);
  for (int i = 0; i < 100; ++i) {
    const auto point = random_point(random, 45);
    EXPECT_LT((*a.project(point) - *b.project(point)).norm(), 1e-10);
  }
}

// The fixed point of refraction: at xi = -1/2 the lens is f sin(theta), and stays so with f n.
TEST(CameraModel, SineLensStaysASineLensInFluid) {
  const CameraModel wet(scope(-0.5), 0, kSalineIndex);
  for (double deg = 1; deg < 40; deg += 3) {
    const double theta = geometry::rad_from_deg(deg);
    const auto pixel = wet.project({30 * std::sin(theta), 0, 30 * std::cos(theta)});
    // With m = n sin(theta): u = 2 f m / (sqrt(1 - m^2) + sqrt(1 + m^2)) = f m (1 + m^4 / 8 + ...).
    const double m = kSalineIndex * std::sin(theta);
    EXPECT_NEAR((*pixel - wet.principal_point_px()).x() / (590 * m), 1, 0.25 * std::pow(m, 4) + 1e-12);
  }
}

// A straight line in space is a circle arc in the picture of a dry division lens: four of its points share
// one circle.
TEST(CameraModel, LinesBecomeCircles) {
  const CameraModel dry(scope(-0.45), 0, 1);
  const Eigen::Vector3d a(-8, 3, 20), b(9, 6, 24);
  Eigen::Matrix4d rows;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector2d x = (*dry.project(a + i / 3.0 * (b - a)) - dry.principal_point_px()) / 590;
    rows.row(i) << x.squaredNorm(), x.x(), x.y(), 1;
  }
  EXPECT_NEAR(rows.determinant(), 0, 1e-12);
}

TEST(CameraModel, SaysNoWhereNoRayGoes) {
  const CameraModel wet(scope(-0.3), 0, kSalineIndex);
  EXPECT_FALSE(wet.project({1, 1, 0}));
  EXPECT_FALSE(wet.project({1, 1, -5}));
  EXPECT_FALSE(wet.project({40, 0, 20}));  // 63 degrees: beyond the critical angle of 48.5
  EXPECT_FALSE(wet.project({std::numeric_limits<double>::quiet_NaN(), 0, 20}));
  const CameraModel pincushion(scope(0.2), 0, 1);
  EXPECT_FALSE(pincushion.project({30, 0, 20}));  // beyond the fold at r_u = 1 / (2 sqrt(xi)) = 1.118
  // The pixels beyond it, at 1 / sqrt(xi), are of no ray: not of one that lies as far within.
  const auto along = [&](double share) {
    return pincushion.undistort(pincushion.principal_point_px() +
                                Eigen::Vector2d(share * pincushion.focal_px() / std::sqrt(0.2), 0));
  };
  EXPECT_TRUE(along(0.99));
  EXPECT_FALSE(along(1.01));
}

TEST(CameraModel, RefusesAnUnusableCalibration) {
  const auto expect_refused = [](auto change) {
    auto calibration = scope(-0.3);
    change(calibration);
    EXPECT_THROW(CameraModel(calibration, 0, 1), InvalidInput);
  };
  expect_refused([](Calibration& c) { c.focal_px = 0; });
  expect_refused([](Calibration& c) { c.focal_px = std::nan(""); });
  expect_refused([](Calibration& c) { c.image_size_px = {0, 0}; });
  expect_refused([](Calibration& c) { c.distortion_xi = -3; });
  EXPECT_THROW(CameraModel(scope(-0.3), 0, 0.1), InvalidInput);
  EXPECT_THROW(CameraModel(scope(-0.3), std::nan(""), 1), InvalidInput);
}

}  // namespace arthronaut::camera
