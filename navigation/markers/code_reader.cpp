#include "navigation/markers/code_reader.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace arthronaut::markers {
namespace {

constexpr double kSpread = 0.2;  // of the samples within a cell
constexpr float kSaturatedLight = 255;
constexpr double kMinRange = 4;         // in light
constexpr double kMinExplained = 0.75;  // share of the cells' variance
constexpr int kMaxWrongInside = 1, kMaxWrong = 2;

using CellLight = std::array<float, kMaxCells * kMaxCells>;

bool sample_cells(const LinearImage& image, const camera::CameraModel& camera,
                  const Eigen::Matrix3d& homography, int cells, CellLight& light) {
  for (int row = 0; row < cells; ++row) {
    for (int column = 0; column < cells; ++column) {
      float sum = 0;
      int count = 0;
      for (int k = 0; k < 5; ++k) {
        // The middle and four points around it.
        const double dx = k == 0 ? 0 : (k % 2 ? kSpread : -kSpread),
                     dy = k == 0 ? 0 : (k < 3 ? kSpread : -kSpread);
        const Eigen::Vector3d place((column + 0.5 + dx) / cells - 0.5, 0.5 - (row + 0.5 + dy) / cells, 1);
        const auto pixel = camera.project(homography * place);
        if (!pixel || !image.contains(pixel->x(), pixel->y())) return false;
        const float value = image.sample(static_cast<float>(pixel->x()), static_cast<float>(pixel->y()));
        sum += value < 0 ? kSaturatedLight : value;
        ++count;
      }
      light[row * cells + column] = sum / static_cast<float>(count);
    }
  }
  return true;
}

// The cell of the square that the marker's cell falls on when its top-left is corner `turn`.
int turned_cell(int row, int column, int turn, int cells) {
  const int last = cells - 1;
  switch (turn) {
    case 1:
      return column * cells + (last - row);
    case 2:
      return (last - row) * cells + (last - column);
    case 3:
      return (last - column) * cells + row;
    default:
      return row * cells + column;
  }
}

// Fits light = (1, x, y) bias + code * (1, x, y) gain and counts the cells on the wrong side of the middle.
bool fits(const CellLight& light, const MarkerCode& code, int turn, int& wrong) {
  const int cells = code.cells;
  Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
  double sum = 0, squares = 0;
  const auto regressors = [&](int row, int column) {
    const double x = (column + 0.5) / cells - 0.5, y = (row + 0.5) / cells - 0.5;
    const double c = code.is_bright(row, column) ? 1 : 0;
    Eigen::Matrix<double, 6, 1> r;
    r << 1, x, y, c, c * x, c * y;
    return r;
  };
  for (int row = 0; row < cells; ++row) {
    for (int column = 0; column < cells; ++column) {
      const double value = light[turned_cell(row, column, turn, cells)];
      const auto r = regressors(row, column);
      normal += r * r.transpose();
      right += value * r;
      sum += value;
      squares += value * value;
    }
  }
  normal.diagonal().array() += 1e-6;
  const Eigen::Matrix<double, 6, 1> fit = normal.ldlt().solve(right);
  double residual = 0;
  int wrong_inside = 0;
  wrong = 0;
  for (int row = 0; row < cells; ++row) {
    for (int column = 0; column < cells; ++column) {
      const double value = light[turned_cell(row, column, turn, cells)];
      const auto r = regressors(row, column);
      const double error = value - fit.dot(r);
      residual += error * error;
      const double x = r[1], y = r[2];
      const double gain = fit[3] + fit[4] * x + fit[5] * y, bias = fit[0] + fit[1] * x + fit[2] * y;
      if (gain < kMinRange) return false;
      const bool is_bright = value > bias + 0.5 * gain;
      if (is_bright == code.is_bright(row, column)) continue;
      ++wrong;
      wrong_inside += row > 0 && column > 0 && row + 1 < cells && column + 1 < cells;
    }
  }
  const double variance = squares - sum * sum / (cells * cells);
  return wrong_inside <= kMaxWrongInside && wrong <= kMaxWrong && residual < (1 - kMinExplained) * variance;
}

}  // namespace

std::optional<ReadCode> read_code(const LinearImage& image, const camera::CameraModel& camera,
                                  const Corners& square, std::span<const MarkerCode> codes) {
  if (codes.empty()) return std::nullopt;
  const auto homography = square_homography(square, 1.0);
  CellLight light{};
  const int cells = codes.front().cells;
  if (!homography || !sample_cells(image, camera, *homography, cells, light)) return std::nullopt;
  const auto [lowest, highest] = std::minmax_element(light.begin(), light.begin() + cells * cells);
  if (*highest - *lowest < kMinRange) return std::nullopt;
  std::optional<ReadCode> best;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    for (int turn = 0; turn < 4; ++turn) {
      int wrong = 0;
      if (!fits(light, codes[i], turn, wrong)) continue;
      if (!best || wrong < best->wrong_cells) best = ReadCode{static_cast<int>(i), turn, wrong};
    }
  }
  return best;
}

}  // namespace arthronaut::markers
