#include <gtest/gtest.h>

#include <set>

#include "planning/geometry/quantile.h"
#include "tests/navigation/calibration/board_scene.h"

namespace arthronaut::calibration {
namespace {

struct Comparison {
  std::size_t found = 0, visible = 0;
  double median_px = 0, rms_px = 0, rms_in_sigmas = 0;
  bool lattice_is_consistent = true;
};

// Matches each corner with the projected corner nearest to it; on a consistent lattice neighbours stay
// neighbours.
Comparison compare(const BoardDetection& detection, const camera::Calibration& scope, const BoardView& view,
                   double square_mm) {
  std::mt19937 random(1);
  const CalibrationPicture truth = picture_of(scope, view, square_mm, 0, 0, random);
  Comparison result;
  result.found = detection.corners.size();
  result.visible = truth.board.corners.size();
  std::map<std::pair<int, int>, Eigen::Vector2i> true_node;
  double sum = 0;
  double sum_in_sigmas = 0;
  std::vector<double> errors;
  for (const BoardCorner& corner : detection.corners) {
    const auto nearest = std::min_element(truth.board.corners.begin(), truth.board.corners.end(),
                                          [&](const BoardCorner& a, const BoardCorner& b) {
                                            return (a.pixel - corner.pixel).squaredNorm() <
                                                   (b.pixel - corner.pixel).squaredNorm();
                                          });
    const double error = (nearest->pixel - corner.pixel).norm();
    if (error > 3) continue;  // beyond 0.92 of the radius, where the truth list ends
    sum += error * error;
    sum_in_sigmas += error * error / (2 * corner.sigma_px * corner.sigma_px);
    errors.push_back(error);
    true_node[{corner.lattice.x(), corner.lattice.y()}] = nearest->lattice;
  }
  result.rms_px = std::sqrt(sum / static_cast<double>(errors.size()));
  result.rms_in_sigmas = std::sqrt(sum_in_sigmas / static_cast<double>(errors.size()));
  result.median_px = geometry::median(errors);
  std::printf("%zu of %zu corners, median %.3f px, rms %.3f px, %.2f sigmas\n", result.found, result.visible,
              result.median_px, result.rms_px, result.rms_in_sigmas);
  for (const auto& [node, lattice] : true_node) {
    const auto right = true_node.find({node.first + 1, node.second});
    if (right != true_node.end() && (right->second - lattice).squaredNorm() != 1)
      result.lattice_is_consistent = false;
  }
  return result;
}

// Boards that run past the view, through strong distortion, at three tilts: most corners (the rest are
// squares of a few pixels), no index wrong, and as exact as each corner says of itself. 0.12 px a corner of
// median sharpness is what noise and 8 bits leave.
TEST(BoardFinder, FindsTheCornersOfABoardThatRunsPastTheView) {
  const camera::Calibration scope = true_scope();
  for (const BoardView& view :
       {BoardView{board_pose(18, 6, 30, 5), 0}, BoardView{board_pose(20, 25, 120, 33), 60},
        BoardView{board_pose(22, 38, 250, 71), -70}}) {
    const GrayPicture picture = draw_board(scope, view, 2, 1.5, 3);
    const Comparison result = compare(find_checkerboard(picture.view()), scope, view, 2);
    EXPECT_GE(result.found, result.visible * 8 / 10);
    EXPECT_LE(result.median_px, 0.12);
    EXPECT_LE(result.rms_in_sigmas, 2.0);
    EXPECT_TRUE(result.lattice_is_consistent);
  }
}

// A saturated patch and a dark bar across the board take corners away but put none in a wrong place.
TEST(BoardFinder, IsNotMisledByGlareAndAnInstrument) {
  const camera::Calibration scope = true_scope();
  const BoardView view{board_pose(20, 25, 120, 33), 0};
  GrayPicture picture = draw_board(scope, view, 2, 1.5, 4);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      auto& pixel = picture.gray[static_cast<std::size_t>(y) * picture.width + x];
      if (std::hypot(x - 900, y - 450) < 110) pixel = 255;
      if (std::abs(x - 1200 - y / 3) < 35 && pixel > 4) pixel = 14;
    }
  const Comparison result = compare(find_checkerboard(picture.view()), scope, view, 2);
  EXPECT_GE(result.found, result.visible / 2);
  EXPECT_LE(result.rms_px, 0.2);
  EXPECT_TRUE(result.lattice_is_consistent);
}

// What is no checkerboard is refused with a reason: nothing, noise, stripes, dots.
TEST(BoardFinder, RefusesWhatIsNoCheckerboard) {
  constexpr int kWidth = 800, kHeight = 600;
  std::mt19937 random(9);
  std::uniform_int_distribution<int> any(0, 255);
  const auto refuse = [&](const char* what, auto&& value_at) {
    std::vector<std::uint8_t> gray(kWidth * kHeight);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        gray[static_cast<std::size_t>(y) * kWidth + x] = static_cast<std::uint8_t>(value_at(x, y));
    const BoardDetection detection = find_checkerboard({gray.data(), kWidth, kHeight, kWidth});
    EXPECT_FALSE(detection.found()) << what;
    EXPECT_FALSE(detection.reason.empty()) << what;
  };
  refuse("nothing", [](int, int) { return 120; });
  refuse("noise", [&](int, int) { return any(random); });
  refuse("stripes", [](int x, int) { return x / 30 % 2 ? 220 : 30; });
  refuse("dots", [](int x, int y) {
    const double dx = (x % 40) - 19.5, dy = (y % 40) - 19.5;
    return dx * dx + dy * dy < 12.0 * 12.0 ? 30 : 220;
  });
}

// Half the picture's size: squares of 10 px beside the rim, a third of whose corners are lopsided, cost
// neither the board nor its index. And distortion twice as strong.
TEST(BoardFinder, FindsSmallSquaresAndStrongDistortion) {
  camera::Calibration small = true_scope();
  small.image_size_px = {960, 540};
  small.focal_px = 295;
  small.principal_point_px = {481, 270.5};
  small.rotation_center_px = {478, 268};
  small.boundary = {{480, 269.8}, 265};
  camera::Calibration strong = small;
  strong.distortion_xi = -0.55;
  for (const camera::Calibration& scope : {small, strong}) {
    const BoardView view{board_pose(22, 30, 70, 20), 0};
    const Comparison seen =
        compare(find_checkerboard(draw_board(scope, view, 1.7, 2, 3).view()), scope, view, 1.7);
    EXPECT_GT(static_cast<double>(seen.found), 0.5 * static_cast<double>(seen.visible));
    EXPECT_TRUE(seen.lattice_is_consistent);
    EXPECT_LT(seen.median_px, 0.15);
  }
}

}  // namespace
}  // namespace arthronaut::calibration
