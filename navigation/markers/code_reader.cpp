#include "navigation/markers/code_reader.h"

#include <algorithm>

#include "navigation/markers/cell_light.h"

namespace arthronaut::markers {
namespace {

constexpr double kSpread = 0.2;         // of the samples within a cell
constexpr int kMinSamples = 3;          // of five that are not saturated
constexpr double kMinRange = 4;         // in light
constexpr double kMinExplained = 0.75;  // share of the cells' variance
constexpr int kMaxWrongInside = 1, kMaxWrong = 2;
// With cells that say nothing.
constexpr int kMinInside = 10, kMinKnown = 22;
// A code that explains that share of the variance by a light that slopes explains this of it by an even one.
constexpr double kMinExplainedEvenly = 0.15;
constexpr float kUnknown = -1, kSaturatedLight = 255;

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
        if (value < 0) continue;
        sum += value;
        ++count;
      }
      light[row * cells + column] = count >= kMinSamples ? sum / static_cast<float>(count) : kUnknown;
    }
  }
  return true;
}

// Cells beside one that is not known.
std::array<bool, kMaxCells * kMaxCells> beside_unknown(const CellLight& light, int cells) {
  std::array<bool, kMaxCells * kMaxCells> beside{};
  for (int i = 0; i < cells * cells; ++i) {
    if (light[i] != kUnknown) continue;
    for (int row = std::max(0, i / cells - 1); row <= std::min(cells - 1, i / cells + 1); ++row) {
      for (int column = std::max(0, i % cells - 1); column <= std::min(cells - 1, i % cells + 1); ++column)
        beside[row * cells + column] = true;
    }
  }
  return beside;
}

// Fits light = (1, x, y) bias + code * (1, x, y) gain and counts the cells on the wrong side of the middle.
bool fits(const CellLight& light, const std::array<bool, kMaxCells * kMaxCells>& is_tainted, bool has_unknown,
          const MarkerCode& code, int turn, int& wrong) {
  const int cells = code.cells;
  LightFit fit;
  double sum = 0, squares = 0;
  int known = 0;
  // A highlight only adds light: beside it, what should be dark and is not says nothing.
  const auto is_used = [&](int row, int column) {
    const int cell = turned_cell(row, column, turn, cells);
    return light[cell] != kUnknown && !(is_tainted[cell] && !code.is_bright(row, column));
  };
  // First by an even light, which is quick: most squares are no marker.
  double bright_sum = 0;
  int bright = 0;
  for (int row = 0; row < cells; ++row) {
    for (int column = 0; column < cells; ++column) {
      if (!is_used(row, column)) continue;
      const double value = light[turned_cell(row, column, turn, cells)];
      sum += value;
      squares += value * value;
      ++known;
      if (!code.is_bright(row, column)) continue;
      bright_sum += value;
      ++bright;
    }
  }
  if (has_unknown && known < kMinKnown * cells * cells / 36) return false;
  const double variance = squares - sum * sum / std::max(1, known);
  const double lead = bright_sum - bright * sum / std::max(1, known);
  if (lead <= 0 ||
      lead * lead < kMinExplainedEvenly * variance * bright * (1 - bright / std::max(1.0, 1.0 * known)))
    return false;
  const auto place = [cells](int k) { return (k + 0.5) / cells - 0.5; };
  for (int row = 0; row < cells; ++row) {
    for (int column = 0; column < cells; ++column) {
      if (!is_used(row, column)) continue;
      const double value = light[turned_cell(row, column, turn, cells)];
      fit.add(1, place(column), place(row), value, code.is_bright(row, column));
    }
  }
  fit.solve(0);
  double residual = 0;
  int wrong_inside = 0, inside = 0;
  wrong = 0;
  for (int row = 0; row < cells; ++row) {
    for (int column = 0; column < cells; ++column) {
      const int cell = turned_cell(row, column, turn, cells);
      if (light[cell] == kUnknown) continue;
      const double value = light[cell];
      const double x = place(column), y = place(row), gain = fit.gain(x, y), bias = fit.bias(x, y);
      if (gain < kMinRange) return false;
      const bool is_bright = value > bias + 0.5 * gain;
      if (is_bright && is_tainted[cell] && !code.is_bright(row, column)) continue;
      const double error = value - fit.light(x, y, code.is_bright(row, column));
      if (is_used(row, column)) residual += error * error;
      const bool is_inside = row > 0 && column > 0 && row + 1 < cells && column + 1 < cells;
      inside += is_inside;
      if (is_bright == code.is_bright(row, column)) continue;
      ++wrong;
      wrong_inside += is_inside;
    }
  }
  if (has_unknown && (wrong_inside > 0 || inside < kMinInside * (cells - 2) * (cells - 2) / 16)) return false;
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
  float lowest = 1e9F, highest = -1e9F;
  bool has_unknown = false;
  for (int i = 0; i < cells * cells; ++i) {
    if (light[i] == kUnknown) {
      has_unknown = true;
      continue;
    }
    lowest = std::min(lowest, light[i]);
    highest = std::max(highest, light[i]);
  }
  if (has_unknown) highest = kSaturatedLight;
  if (highest - lowest < kMinRange) return std::nullopt;
  const auto read = [&](const CellLight& cell_light, const auto& is_tainted, bool are_missing) {
    std::optional<ReadCode> best;
    for (std::size_t i = 0; i < codes.size(); ++i) {
      for (int turn = 0; turn < 4; ++turn) {
        int wrong = 0;
        if (!fits(cell_light, is_tainted, are_missing, codes[i], turn, wrong)) continue;
        if (!best || wrong < best->wrong_cells)
          best = ReadCode{static_cast<int>(i), turn, wrong, are_missing};
      }
    }
    return best;
  };
  // In a picture that is too bright, the bright cells are saturated, and nothing else is.
  CellLight as_bright = light;
  std::replace(as_bright.begin(), as_bright.begin() + cells * cells, kUnknown, kSaturatedLight);
  const auto best = read(as_bright, std::array<bool, kMaxCells * kMaxCells>{}, false);
  return best || !has_unknown ? best : read(light, beside_unknown(light, cells), true);
}

}  // namespace arthronaut::markers
