#include "navigation/markers/code_reader.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace arthronaut::markers {
namespace {

constexpr double kSpread = 0.2;         // of the samples within a cell
constexpr int kMinSamples = 3;          // of five that are not saturated
constexpr double kMinRange = 4;         // in light
constexpr double kMinExplained = 0.75;  // share of the cells' variance
constexpr int kMaxWrongInside = 1, kMaxWrong = 2;
// With cells that say nothing.
constexpr int kMinInside = 10, kMinKnown = 22;
constexpr float kUnknown = -1, kSaturatedLight = 255;
// When a pose is supposed: how far a cell may be from its level, as a share of the range; what has to agree.
constexpr double kAgrees = 0.3;
constexpr double kMinAgreeing = 0.45;
constexpr int kMinAgreeingInside = 7, kMaxOppositeInside = 3, kClearLead = 4, kLead = 5;
constexpr int kMinCoveredScore = 6;
constexpr int kSeePasses = 4;

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

// light = (1, x, y) bias + code (1, x, y) gain, by least squares. Most of what is looked at is no marker, and
// every code is tried on it at every turn: the normal equations are put together of the sums over all cells
// and over the bright ones.
class LightFit {
 public:
  void add(double weight, double x, double y, double value, bool is_bright) {
    const double wx = weight * x, wy = weight * y, wv = weight * value;
    const Sums part = {weight, wx, wy, wx * x, wx * y, wy * y, wv, wv * x, wv * y};
    for (std::size_t i = 0; i < part.size(); ++i) all_[i] += part[i];
    if (!is_bright) return;
    for (std::size_t i = 0; i < part.size(); ++i) bright_[i] += part[i];
  }
  // Slopes are held near 0 by as much.
  void solve(double slope_prior) {
    Eigen::Matrix<double, 6, 6> normal;
    Eigen::Matrix<double, 6, 1> right;
    normal << squares(all_), squares(bright_), squares(bright_), squares(bright_);
    right << all_[6], all_[7], all_[8], bright_[6], bright_[7], bright_[8];
    for (const int slope : {1, 2, 4, 5}) normal(slope, slope) += slope_prior;
    normal.diagonal().array() += 1e-6;
    fit_ = normal.ldlt().solve(right);
  }
  [[nodiscard]] double bias(double x, double y) const { return fit_[0] + fit_[1] * x + fit_[2] * y; }
  [[nodiscard]] double gain(double x, double y) const { return fit_[3] + fit_[4] * x + fit_[5] * y; }
  [[nodiscard]] double light(double x, double y, bool is_bright) const {
    return is_bright ? bias(x, y) + gain(x, y) : bias(x, y);
  }

 private:
  using Sums = std::array<double, 9>;  // of 1, x, y, xx, xy, yy; of the light times 1, x, y
  static Eigen::Matrix3d squares(const Sums& s) {
    Eigen::Matrix3d matrix;
    matrix << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
    return matrix;
  }
  Sums all_{}, bright_{};
  Eigen::Matrix<double, 6, 1> fit_ = Eigen::Matrix<double, 6, 1>::Zero();
};

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
  const auto place = [cells](int k) { return (k + 0.5) / cells - 0.5; };
  for (int row = 0; row < cells; ++row) {
    for (int column = 0; column < cells; ++column) {
      if (!is_used(row, column)) continue;
      const double value = light[turned_cell(row, column, turn, cells)];
      fit.add(1, place(column), place(row), value, code.is_bright(row, column));
      sum += value;
      squares += value * value;
      ++known;
    }
  }
  if (has_unknown && known < kMinKnown * cells * cells / 36) return false;
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
  const double variance = squares - sum * sum / std::max(1, known);
  return wrong_inside <= kMaxWrongInside && wrong <= kMaxWrong && residual < (1 - kMinExplained) * variance;
}

// A cell, or one of the margin, as the picture shows it.
struct SeenCell {
  double value = 0, x = 0, y = 0;
  int row = 0, column = 0;
  bool is_margin = false, is_inside = false;
  bool is_beside_white = false;  // a saturated one
};
constexpr int kMostCells = (kMaxCells + 2) * (kMaxCells + 2);
using SeenCells = std::array<SeenCell, kMostCells>;

// `at` takes a place on the marker (in sides, y up) to the camera frame. Saturated cells are left out.
template <typename Place>
int see_cells(const LinearImage& image, const camera::CameraModel& camera, int cells, const Place& at,
              SeenCells& seen) {
  const int wide = cells + 2;
  int count = 0;
  std::array<bool, kMostCells> is_white{};
  for (int i = 0; i < wide * wide; ++i) {
    SeenCell& cell = seen[count];
    cell = SeenCell();
    cell.row = i / wide - 1;
    cell.column = i % wide - 1;
    cell.is_margin = cell.row < 0 || cell.column < 0 || cell.row >= cells || cell.column >= cells;
    cell.is_inside = cell.row > 0 && cell.column > 0 && cell.row + 1 < cells && cell.column + 1 < cells;
    // The margin is no wider than a cell: its half next to the square.
    const auto middle = [cells](int k) { return k < 0 ? -0.4 : k >= cells ? cells + 0.4 : k + 0.5; };
    cell.x = middle(cell.column) / cells - 0.5;
    cell.y = middle(cell.row) / cells - 0.5;
    double sum = 0;
    int samples = 0;
    for (int k = 0; k < 5; ++k) {
      const double spread = (cell.is_margin ? 0.5 : 1) * kSpread / cells;
      const double dx = k == 0 ? 0 : (k % 2 ? spread : -spread), dy = k == 0 ? 0 : (k < 3 ? spread : -spread);
      const auto pixel = camera.project(at(cell.x + dx, -(cell.y + dy)));
      if (!pixel || !camera.is_inside_view(*pixel) || !image.contains(pixel->x(), pixel->y())) continue;
      const float value = image.sample(static_cast<float>(pixel->x()), static_cast<float>(pixel->y()));
      if (value < 0) continue;
      sum += value;
      ++samples;
    }
    is_white[i] = samples < kMinSamples;
    if (is_white[i]) continue;
    cell.value = sum / samples;
    ++count;
  }
  for (int i = 0; i < count; ++i) {
    SeenCell& cell = seen[i];
    for (int row = std::max(0, cell.row); row <= std::min(wide - 1, cell.row + 2); ++row) {
      for (int column = std::max(0, cell.column); column <= std::min(wide - 1, cell.column + 2); ++column)
        cell.is_beside_white |= is_white[row * wide + column];
    }
  }
  return count;
}

// What the cells say of one code whose top-left is corner `turn` of what they were seen on. What covers is
// left out step by step, beginning with the light that most of the cells agree on.
SeenCode judge_cells(std::span<const SeenCell> seen, std::span<const MarkerCode> codes, std::size_t index,
                     int turn) {
  const MarkerCode& code = codes[index];
  const int cells = code.cells;
  // The marker's cell that is seen here.
  const auto is_bright_in = [cells](const MarkerCode& of, const SeenCell& cell, int turned) {
    if (cell.is_margin) return true;
    const int there = turned_cell(cell.row, cell.column, (4 - turned) % 4, cells);
    return of.is_bright(there / cells, there % cells);
  };
  std::array<double, kMostCells> weights;
  std::array<bool, kMostCells> expected;
  const int count = static_cast<int>(seen.size());
  for (int i = 0; i < count; ++i) {
    expected[i] = is_bright_in(code, seen[i], turn);
    weights[i] = 1;
  }
  SeenCode result;
  result.seen = count;
  std::array<std::int8_t, kMostCells> shades;  // 0 dark, 1 bright, -1 neither
  // A highlight only adds light: what is bright beside it speaks against no dark cell.
  const auto contradicts = [&](int i, bool is_bright) {
    return shades[i] == (is_bright ? 0 : 1) && !(shades[i] == 1 && seen[i].is_beside_white);
  };
  LightFit fit;
  for (int pass = 0; pass < kSeePasses; ++pass) {
    fit = LightFit();
    for (int i = 0; i < count; ++i) fit.add(weights[i], seen[i].x, seen[i].y, seen[i].value, expected[i]);
    // A slope of the light is not expected to be larger than the light.
    fit.solve(0.3);
    const double range = fit.gain(0, 0);
    if (!(range > kMinRange)) return result;
    for (int i = 0; i < count; ++i) {
      const double error = (seen[i].value - fit.light(seen[i].x, seen[i].y, expected[i])) / (kAgrees * range);
      const double root = 1 / (1 + error * error);
      weights[i] = root * root;
    }
  }
  for (int i = 0; i < count; ++i) {
    const SeenCell& cell = seen[i];
    const double level = (cell.value - fit.bias(cell.x, cell.y)) / std::max(fit.gain(cell.x, cell.y), 1e-3);
    shades[i] = std::abs(level) < kAgrees ? 0 : std::abs(level - 1) < kAgrees ? 1 : -1;
    result.agreeing += shades[i] == (expected[i] ? 1 : 0);
    if (!cell.is_inside) continue;
    ++result.seen_inside;
    result.agreeing_inside += shades[i] == (expected[i] ? 1 : 0);
    result.opposite_inside += contradicts(i, expected[i]);
  }
  if (!result.agrees()) return result;  // most of what is looked at is no marker
  int other_score = -count;
  for (std::size_t other = 0; other < codes.size(); ++other) {
    for (int other_turn = 0; other_turn < 4; ++other_turn) {
      if (other == index && other_turn == turn) continue;
      int score = 0;
      for (int i = 0; i < count; ++i) {
        if (!seen[i].is_inside) continue;
        const bool is_bright = is_bright_in(codes[other], seen[i], other_turn);
        score += (shades[i] == (is_bright ? 1 : 0)) - contradicts(i, is_bright);
      }
      other_score = std::max(other_score, score);
    }
  }
  result.lead = result.agreeing_inside - result.opposite_inside - other_score;
  return result;
}

// How much brighter the margin is than the border, both as far as they are seen.
double margin_contrast(std::span<const SeenCell> seen) {
  std::array<double, 2> sum{}, n{};
  for (const SeenCell& cell : seen) {
    if (cell.is_inside) continue;
    sum[cell.is_margin] += cell.value;
    n[cell.is_margin] += 1;
  }
  return n[0] < 8 || n[1] < 10 ? 0 : sum[1] / n[1] - sum[0] / n[0];
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
        if (!best || wrong < best->wrong_cells) best = ReadCode{static_cast<int>(i), turn, wrong};
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

bool SeenCode::agrees() const {
  return agreeing > kMinAgreeing * seen && agreeing_inside >= kMinAgreeingInside &&
         opposite_inside <= kMaxOppositeInside;
}

bool SeenCode::is_confirmed() const {
  return agrees() && lead >= (opposite_inside == 0 ? kClearLead : kLead);
}

SeenCode see_code(const LinearImage& image, const camera::CameraModel& camera,
                  const geometry::RigidTransform& camera_from_marker, double size_mm,
                  std::span<const MarkerCode> codes, std::size_t index) {
  SeenCells seen;
  const int count = see_cells(
      image, camera, codes[index].cells,
      [&](double x, double y) { return camera_from_marker * Eigen::Vector3d(x * size_mm, y * size_mm, 0); },
      seen);
  return judge_cells(std::span(seen).first(static_cast<std::size_t>(count)), codes, index, 0);
}

std::optional<ReadCode> read_covered_code(const LinearImage& image, const camera::CameraModel& camera,
                                          const Corners& square, std::span<const MarkerCode> codes) {
  const auto homography = square_homography(square, 1.0);
  if (codes.empty() || !homography) return std::nullopt;
  SeenCells seen;
  const int count = see_cells(
      image, camera, codes.front().cells,
      [&](double x, double y) -> Eigen::Vector3d { return *homography * Eigen::Vector3d(x, y, 1); }, seen);
  const auto cells = std::span(seen).first(static_cast<std::size_t>(count));
  if (margin_contrast(cells) < kMinRange) return std::nullopt;
  std::optional<ReadCode> best;
  int most = 0;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    for (int turn = 0; turn < 4; ++turn) {
      const SeenCode code = judge_cells(cells, codes, i, turn);
      const int score = code.agreeing_inside - 2 * code.opposite_inside;
      if (!code.is_confirmed() || score < kMinCoveredScore || score <= most) continue;
      most = score;
      best = ReadCode{static_cast<int>(i), turn, code.opposite_inside};
    }
  }
  return best;
}

}  // namespace arthronaut::markers
