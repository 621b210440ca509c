#include "navigation/camera/undistorted_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "navigation/camera/medium.h"
#include "navigation/camera/undistorted_picture.h"

namespace arthronaut::camera {
namespace {

constexpr int kSize_px = 900;  // of the picture on the screen: what is said in px below

Calibration scope() {
  Calibration calibration;
  calibration.image_size_px = {1920, 1080};
  calibration.focal_px = 590;
  calibration.principal_point_px = {975, 530};  // 20 px off the centre of rotation: turning matters
  calibration.rotation_center_px = {958, 538};
  calibration.distortion_xi = -0.3;
  calibration.boundary = {{960.5, 540.2}, 531};
  return calibration;
}

Eigen::Vector2d place_of(int column, int row) {
  return {(2 * column + 1.0) / kSize_px - 1, (2 * row + 1.0) / kSize_px - 1};
}

struct Case {
  double xi, index;
  FluidModel fluid;
};
const Case kCases[] = {{-0.3, kAirIndex, FluidModel::FlatPort},
                       {-0.3, kSalineIndex, FluidModel::FlatPort},
                       {-0.45, kSalineIndex, FluidModel::FlatPort},
                       {-0.45, kWaterIndex, FluidModel::FocalRule},
                       {0.0, kAirIndex, FluidModel::FlatPort}};

// One table, made at one lens angle, says at every other angle what the model says there, in every medium.
TEST(UndistortedView, OneTableServesEveryLensAngle) {
  for (const Case& c : kCases) {
    Calibration calibration = scope();
    calibration.distortion_xi = c.xi;
    const UndistortedView view(CameraModel(calibration, 0.2, c.index, c.fluid));
    for (const double angle_rad : {0.2, 1.4, 3.1, 5.0}) {
      const CameraModel camera(calibration, angle_rad, c.index, c.fluid);
      ASSERT_TRUE(view.fits(camera));
      double worst_px = 0;
      for (int row = 0; row < kSize_px; row += 7) {
        for (int column = 0; column < kSize_px; column += 7) {
          const Eigen::Vector2d place = place_of(column, row);
          const Eigen::Vector2d pixel = view.pixel_from_view(camera, place);
          if (!camera.is_inside_view(pixel)) continue;
          const auto exact = view.view_from_pixel(camera, pixel);
          ASSERT_TRUE(exact);
          worst_px = std::max(worst_px, (*exact - place).norm() * kSize_px / 2);
        }
      }
      EXPECT_LT(worst_px, 0.1) << "xi " << c.xi << ", index " << c.index << ", angle " << angle_rad;
    }
  }
}

// What is straight in space is straight on the screen, to less than half a pixel; places of the overlay are
// exact.
TEST(UndistortedView, StraightStaysStraight) {
  const CameraModel camera(scope(), 0.7, kSalineIndex);
  const UndistortedView view(camera);
  const Eigen::Vector3d from(-9, 6, 16), to(10, 11, 24);
  std::vector<Eigen::Vector2d> raw, shown;
  for (double share = 0; share <= 1; share += 0.02) {
    const auto pixel = camera.project(from + share * (to - from));
    ASSERT_TRUE(pixel);
    if (!camera.is_inside_view(*pixel)) continue;
    raw.push_back(*pixel);
    shown.push_back(*view.view_from_pixel(camera, *pixel) * kSize_px / 2);
  }
  ASSERT_GT(shown.size(), 30U);
  const auto bend = [](const std::vector<Eigen::Vector2d>& points) {
    const Eigen::Vector2d along = (points.back() - points.front()).normalized();
    double worst = 0;
    for (const Eigen::Vector2d& p : points) {
      const Eigen::Vector2d arm = p - points.front();
      worst = std::max(worst, std::abs(arm.x() * along.y() - arm.y() * along.x()));
    }
    return worst;
  };
  EXPECT_GT(bend(raw), 3) << "the lens bends it";
  EXPECT_LT(bend(shown), 1e-6);
}

// The whole round view is on the screen, and not much more; a lens that sees beyond 60 degrees is cut there.
TEST(UndistortedView, ShowsTheWholeRoundView) {
  const CameraModel camera(scope(), 2.0, kSalineIndex);
  const UndistortedView view(camera);
  double farthest = 0;
  for (int i = 0; i < 64; ++i) {
    const Eigen::Vector2d rim = camera.boundary().center_px + 531 * Eigen::Vector2d(std::cos(i), std::sin(i));
    farthest = std::max(farthest, view.view_from_pixel(camera, rim)->norm());
  }
  EXPECT_LE(farthest, 1 + 1e-3);
  EXPECT_GT(farthest, 0.99);
  Calibration wide = scope();
  wide.distortion_xi = -0.9;
  const UndistortedView cut{CameraModel(wide, 0, kAirIndex)};
  EXPECT_DOUBLE_EQ(cut.half_extent(), UndistortedView::kMaxHalfExtent);
}

// Another medium or another zoom needs another table.
TEST(UndistortedView, FitsItsOwnLensAndMediumAlone) {
  const Calibration calibration = scope();
  const UndistortedView view(CameraModel(calibration, 0, kSalineIndex));
  EXPECT_FALSE(view.fits(CameraModel(calibration, 0, kAirIndex)));
  Calibration zoomed = calibration;
  zoomed.focal_px *= 1.1;
  EXPECT_FALSE(view.fits(CameraModel(zoomed, 0, kSalineIndex)));
}

// A raw picture of a straight dark thread in space, as the lens bends it.
Frame picture_of_thread(const CameraModel& camera, double distance_from_axis) {
  constexpr double kHalfWidth = 0.012;  // tangent
  Frame frame;
  frame.width = 1920;
  frame.height = 1080;
  frame.bgr.assign(static_cast<std::size_t>(3) * 1920 * 1080, 200);
  for (int y = 0; y < 1080; ++y) {
    for (int x = 0; x < 1920; ++x) {
      const auto tangent = camera.undistort(Eigen::Vector2d(x, y));
      if (!tangent) continue;
      const double off = std::abs(tangent->x() + 0.2 * tangent->y() - distance_from_axis) / kHalfWidth;
      const auto gray = static_cast<std::uint8_t>(200 - 150 * std::exp(-off * off));
      std::fill_n(frame.bgr.begin() + 3 * (static_cast<std::ptrdiff_t>(y) * 1920 + x), 3, gray);
    }
  }
  return frame;
}

// The picture made on the CPU: the thread's middle, row by row, lies on one straight line where the model
// says, after the lens was turned as well; what is outside the round view is black.
TEST(UndistortedPicture, StraightensAThread) {
  UndistortedPicture picture;
  const auto view = std::make_shared<UndistortedView>(CameraModel(scope(), 0, kSalineIndex));
  for (const double angle_rad : {0.0, 1.9}) {
    const CameraModel camera(scope(), angle_rad, kSalineIndex);
    const double off_axis = 0.35;
    const Frame frame = picture_of_thread(camera, off_axis);
    const std::vector<std::uint8_t>& bgr = picture.draw(frame, camera, view, kSize_px);
    ASSERT_EQ(bgr.size(), static_cast<std::size_t>(3) * kSize_px * kSize_px);
    EXPECT_EQ(bgr[0], 0);
    int rows = 0;
    for (int row = 250; row < 650; row += 10) {
      double weight = 0, sum = 0;
      const double expected =
          ((off_axis - 0.2 * place_of(0, row).y() * view->half_extent()) / view->half_extent() + 1) / 2 *
              kSize_px -
          0.5;
      for (int column = static_cast<int>(expected) - 30; column <= static_cast<int>(expected) + 30;
           ++column) {
        const double dark = 200.0 - bgr[3 * static_cast<std::size_t>(row * kSize_px + column)];
        weight += dark;
        sum += dark * column;
      }
      EXPECT_NEAR(sum / weight, expected, 0.25) << "row " << row << ", angle " << angle_rad;
      ++rows;
    }
    EXPECT_EQ(rows, 40);
  }
}

}  // namespace
}  // namespace arthronaut::camera
