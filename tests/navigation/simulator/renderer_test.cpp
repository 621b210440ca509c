#include "navigation/simulator/renderer.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "navigation/simulator/instruments.h"
#include "navigation/simulator/simulated_operation.h"

namespace arthronaut::simulator {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// The light that made a grey level: the renderer's gamma undone.
double light_of(const camera::Frame& frame, const Vector2d& pixel) {
  const int x = static_cast<int>(std::floor(pixel.x())), y = static_cast<int>(std::floor(pixel.y()));
  const double fx = pixel.x() - x, fy = pixel.y() - y;
  const auto at = [&](int column, int row) {
    return std::pow(frame.bgr[static_cast<std::size_t>(3 * (row * frame.width + column) + 1)] / 255.0, 2.2);
  };
  return (1 - fy) * ((1 - fx) * at(x, y) + fx * at(x + 1, y)) +
         fy * ((1 - fx) * at(x, y + 1) + fx * at(x + 1, y + 1));
}

// How far the drawn edge lies from `on_edge` along the unit `outward` (dark inside, bright outside), in
// pixels: where the linear profile has gone half-way. Blur is symmetric, so that this is where the edge truly
// is.
double edge_offset_px(const camera::Frame& frame, const Vector2d& on_edge, const Vector2d& outward) {
  double dark = 0, bright = 0;
  for (const double s : {3.6, 4.2, 4.8, 5.4}) {
    dark += 0.25 * light_of(frame, on_edge - s * outward);
    bright += 0.25 * light_of(frame, on_edge + s * outward);
  }
  const auto share_at = [&](double s) {
    return (light_of(frame, on_edge + s * outward) - dark) / (bright - dark);
  };
  double low = -2, high = 2;
  for (int step = 0; step < 30; ++step) {
    const double middle = 0.5 * (low + high);
    (share_at(middle) < 0.5 ? low : high) = middle;
  }
  return low;
}

struct Side {
  double start_px, end_px;  // offset of the fitted edge at the side's two ends
  Vector2d normal_at_start, normal_at_end;
};

Side measure_side(const camera::Frame& frame, const camera::CameraModel& camera,
                  const geometry::RigidTransform& camera_from_marker, const Vector3d& a, const Vector3d& b) {
  // Straight-line fit of the offsets along the side: a + b s.
  double n = 0, sum_s = 0, sum_ss = 0, sum_o = 0, sum_so = 0;
  const auto normal_at = [&](double s) -> Vector2d {
    const Vector2d from = *camera.project(camera_from_marker * (a + (s - 1e-3) * (b - a)));
    const Vector2d to = *camera.project(camera_from_marker * (a + (s + 1e-3) * (b - a)));
    const Vector2d along = (to - from).normalized();
    // Corners go clockwise in the picture: outside is on the left hand, which is (y, -x) with y down.
    return {along.y(), -along.x()};
  };
  for (double s = 0.12; s <= 0.88; s += 0.01) {
    const Vector2d pixel = *camera.project(camera_from_marker * (a + s * (b - a)));
    const double offset = edge_offset_px(frame, pixel, normal_at(s));
    n += 1;
    sum_s += s;
    sum_ss += s * s;
    sum_o += offset;
    sum_so += s * offset;
  }
  const double slope = (n * sum_so - sum_s * sum_o) / (n * sum_ss - sum_s * sum_s),
               at0 = (sum_o - slope * sum_s) / n;
  return {at0, at0 + slope, normal_at(0.001), normal_at(0.999)};
}

// The corners of a drawn marker, as lines through its four edges give them, lie within 0.05 px of where the
// camera model puts them: at three lens angles, wet and dry, in the middle and near the rim, at any turn.
// Half a pixel of shift, a missed half sample or light averaged after gamma would each show here.
TEST(Renderer, PutsMarkerCornersWhereTheCameraDoes) {
  const camera::Calibration calibration = standard_camera();
  Renderer renderer(nullptr, {.blur_sigma_px = 1.0, .read_noise_levels = 0, .shot_noise_share = 0});
  struct View {
    double lens_deg, index, turn_deg, tilt_deg;
    Vector3d center;
  };
  double worst_px = 0;
  for (const View& view : {View{0, 1.3345, 0, 20, {0, 0, 20}}, View{-60, 1.3345, 31, 35, {-5, 4, 18}},
                           View{75, 1.0, 90, 25, {6, -3, 17}}, View{10, 1.3345, 3, 15, {1, 9, 22}}}) {
    const camera::CameraModel camera(calibration, geometry::rad_from_deg(view.lens_deg), view.index);
    const Eigen::Quaterniond facing(Eigen::AngleAxisd(geometry::kPi, Vector3d::UnitX()));
    const Eigen::Quaterniond tilt(
        Eigen::AngleAxisd(geometry::rad_from_deg(view.tilt_deg), Vector3d(0.6, 0.8, 0)));
    const Eigen::Quaterniond turn(
        Eigen::AngleAxisd(geometry::rad_from_deg(view.turn_deg), Vector3d::UnitZ()));
    const geometry::RigidTransform camera_from_marker{tilt * facing * turn, view.center};
    Scene scene;
    add_world_marker({.bone = bones::BoneKind::Femur, .marker_id = 0, .size_mm = 4}, camera_from_marker,
                     scene.solids);
    camera::Frame frame;
    renderer.render(scene, camera, calibration.reference_mark_angle_deg + view.lens_deg, 1, frame);

    const std::array<Vector3d, 4> corners{Vector3d(-2, 2, 0), {2, 2, 0}, {2, -2, 0}, {-2, -2, 0}};
    std::array<Side, 4> sides;
    for (std::size_t i = 0; i < 4; ++i) {
      sides[i] = measure_side(frame, camera, camera_from_marker, corners[i], corners[(i + 1) % 4]);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const Side &before = sides[(i + 3) % 4], &after = sides[i];
      Eigen::Matrix2d normals;
      normals << before.normal_at_end.transpose(), after.normal_at_start.transpose();
      const Vector2d shift = normals.inverse() * Vector2d(before.end_px, after.start_px);
      EXPECT_LT(shift.norm(), 0.05) << "corner " << i << ", lens " << view.lens_deg;
      worst_px = std::max(worst_px, shift.norm());
    }
  }
  RecordProperty("worst_corner_px", std::to_string(worst_px));
}

// The same arguments give the same bytes; another seed only other noise.
TEST(Renderer, IsAFunctionOfItsArguments) {
  const camera::CameraModel camera(standard_camera(), 0, 1.3345);
  Scene scene;
  scene.solids.push_back(make_rod({-5, 0, 20}, {5, 2, 24}, 2, steel()));
  camera::Frame first, again, other;
  Renderer(nullptr, {}).render(scene, camera, 278, 5, first);
  Renderer(nullptr, {}).render(scene, camera, 278, 5, again);
  Renderer(nullptr, {}).render(scene, camera, 278, 6, other);
  EXPECT_EQ(first.bgr, again.bgr);
  EXPECT_NE(first.bgr, other.bgr);
}

}  // namespace
}  // namespace arthronaut::simulator
