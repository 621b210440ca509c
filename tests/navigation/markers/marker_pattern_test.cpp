#include "navigation/markers/marker_pattern.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "navigation/markers/code_reader.h"
#include "tests/navigation/markers/rendered_marker.h"

namespace arthronaut::markers {
namespace {

int turned_distance(const MarkerCode& a, const MarkerCode& b, int turns) {
  int distance = 0;
  for (int row = 0; row < a.cells; ++row) {
    for (int column = 0; column < a.cells; ++column) {
      int r = row, c = column;
      for (int t = 0; t < turns; ++t) {
        const int next = a.cells - 1 - r;
        r = c;
        c = next;
      }
      distance += a.is_bright(row, column) != b.is_bright(r, c);
    }
  }
  return distance;
}

// One wrong cell never makes another marker: the promise of code_reader.h rests on this distance.
TEST(MarkerCodes, DifferInAtLeastFourCellsInAnyTurn) {
  const auto codes = codes_4x4_50();
  ASSERT_EQ(codes.size(), 50u);
  const auto least_of_first = [&](std::size_t count) {
    int least = 100;
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = i; j < count; ++j) {
        for (int turns = i == j ? 1 : 0; turns < 4; ++turns)
          least = std::min(least, turned_distance(codes[i], codes[j], turns));
      }
    }
    return least;
  };
  EXPECT_EQ(least_of_first(50), 4);
  EXPECT_EQ(least_of_first(5), 6);  // the standard markers
}

// Every sample stands where the printed brightness steps, with its four cells as printed, in the frame with y
// up.
TEST(EdgeSamples, StandOnTheStepsOfTheCode) {
  const MarkerCode code = codes_4x4_50()[2];
  const auto light = [&](double x, double y) {
    const int column = static_cast<int>(std::floor((x + 0.5) * code.cells)),
              row = static_cast<int>(std::floor((0.5 - y) * code.cells));
    if (row < 0 || column < 0 || row >= code.cells || column >= code.cells) return true;
    return code.is_bright(row, column);
  };
  const auto samples = edge_samples(code);
  EXPECT_GT(samples.size(), 150u);
  for (const EdgeSample& sample : samples) {
    for (int k = 0; k < 4; ++k) {
      const double across = (k - 1.5) / code.cells;
      EXPECT_EQ(light(sample.x + (sample.axis == 0 ? across : 0), sample.y + (sample.axis == 1 ? across : 0)),
                sample.cells[k] > 0.5F);
    }
    EXPECT_NE(sample.cells[1], sample.cells[2]);
    const double outermost = std::max(std::abs(sample.x), std::abs(sample.y));
    EXPECT_EQ(sample.side >= 0,
              std::abs(outermost - 0.5) < 1e-12 && std::abs(sample.axis == 0 ? sample.x : sample.y) > 0.49);
  }
}

// Squares with random cells inside a dark border pass for one of five markers about as often as the header
// says: 5 times 17 * 4 / 65536, that is 0.5 %; ten in 2000. 25 would be beyond 4 sigma, and none would be so
// rare that the stated rate is wrong.
TEST(CodeReader, RarelyTakesARandomSquareForAMarker) {
  const camera::CameraModel camera = small_scope();
  auto codes = codes_4x4_50();
  codes.resize(5);
  const auto pose = facing_pose(0, 0, 14, 8, -6, 3);
  Corners tangent;
  const auto corners_mm = square_corners_mm(4);
  for (int k = 0; k < 4; ++k) tangent[k] = (pose * corners_mm[k]).hnormalized();
  std::mt19937 random(17);
  // The picture is painted cell by cell: rendering thousands would take minutes.
  std::vector<std::uint8_t> grey(800 * 600);
  const LinearTable table(1.6);
  std::vector<std::pair<int, int>> cells;  // pixel, cell of the code or -1 for the margin
  for (int y = 230; y < 370; ++y) {
    for (int x = 330; x < 470; ++x) {
      const auto ray = camera.ray(Eigen::Vector2d(x, y)).value();
      const auto back = pose.inverse();
      const Eigen::Vector3d direction = back.rotate(ray);
      const Eigen::Vector3d place = back.translation_mm - back.translation_mm.z() / direction.z() * direction;
      const int column = static_cast<int>(std::floor((place.x() / 4 + 0.5) * 6));
      const int row = static_cast<int>(std::floor((0.5 - place.y() / 4) * 6));
      const bool inside = row >= 0 && column >= 0 && row < 6 && column < 6;
      cells.emplace_back(y * 800 + x, inside ? row * 6 + column : -1);
    }
  }
  int taken = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    MarkerCode code = codes[0];
    for (int row = 1; row < 5; ++row) {
      for (int column = 1; column < 5; ++column) code.bright[row * 6 + column] = (random() & 1) != 0;
    }
    for (const auto& [index, cell] : cells) grey[index] = cell < 0 || code.bright[cell] ? 200 : 40;
    const LinearImage image({grey.data(), 800, 600, 800}, table);
    taken += read_code(image, camera, tangent, codes).has_value();
  }
  RecordProperty("taken_of_2000", taken);
  EXPECT_LT(taken, 25);
  EXPECT_GT(taken, 0);
}

}  // namespace
}  // namespace arthronaut::markers
