#include "navigation/markers/code_evidence.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "navigation/markers/cell_light.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::markers {
namespace {

using geometry::RigidTransform;

constexpr double kMinRange = 4;  // in light
constexpr int kLightPasses = 4;
constexpr double kUsualError = 0.3;  // of the range: what is farther from the light hardly counts for it
// Lines across a boundary, and places along each, as far from its middle, in cells.
constexpr int kLines = 7, kPlaces = 9, kMinPlaces = 3;
constexpr double kLinesReach = 0.36, kPlacesReach = 0.44;
// In steps from dark to bright: what a place may be off by, and what smooth light, with its slope and its
// bend in a cell, may lie over a boundary beside a highlight and far from one.
constexpr double kNoise = 0.06, kDarker = 0.1;
constexpr std::array<double, 3> kNearLight = {0.7, 1.2, 2.0}, kFarLight = {0.1, 0.1, 0.05};
constexpr double kBesideCells = 0.7, kFadesCells = 0.9;
// Lines lie closer to each other than what is wrong with them changes: each counts for so much. And every
// place lies beside two boundaries.
constexpr double kLineWeight = 0.3, kBoundaryWeight = 0.5;
constexpr double kMostOfBoundary = 6;  // by which a boundary may speak for one pair against another
constexpr int kMostFrames = 3;         // more frames say no more of a boundary than so many

// A sharp step from 0 to 1 smeared by a Gaussian and a box, at this distance from it.
double smeared_step(double distance, double sigma, double box) {
  const auto integral = [sigma](double x) {
    const double z = x / sigma;
    return 0.5 * x * std::erfc(-z / std::sqrt(2.0)) +
           sigma * std::exp(-0.5 * z * z) / std::sqrt(2 * geometry::kPi);
  };
  return (integral(distance + 0.5 * box) - integral(distance - 0.5 * box)) / box;
}

// Of a boundary between two cells of which one is inside: its number, and the cells' rows and columns.
struct BoundaryPlace {
  int index, axis;  // crossed along the columns (0) or the rows (1)
  int row, column, other_row, other_column;
  [[nodiscard]] Eigen::Vector2d middle() const {  // in cells from the top left
    return {0.5 * (column + other_column) + 0.5, 0.5 * (row + other_row) + 0.5};
  }
};

template <typename Call>
void each_boundary(int cells, const Call& call) {
  int index = 0;
  for (int lane = 1; lane + 1 < cells; ++lane) {
    for (int line = 1; line < cells; ++line) {
      call(BoundaryPlace{index++, 0, lane, line - 1, lane, line});
      call(BoundaryPlace{index++, 1, line - 1, lane, line, lane});
    }
  }
}

// The picture by places on the marker, in cells from its top left.
struct MarkerView {
  static constexpr double kOutside = -2;
  const LinearImage& image;
  const camera::CameraModel& camera;
  const RigidTransform& pose;
  double size_mm;
  int cells;

  [[nodiscard]] Eigen::Vector3d place_mm(const Eigen::Vector2d& at) const {
    return {(at.x() / cells - 0.5) * size_mm, (0.5 - at.y() / cells) * size_mm, 0};
  }
  // Below 0 where it is saturated.
  [[nodiscard]] double light(const Eigen::Vector2d& at) const {
    const auto pixel = camera.project(pose * place_mm(at));
    if (!pixel || !camera.is_inside_view(*pixel) || !image.contains(pixel->x(), pixel->y())) return kOutside;
    return image.sample(static_cast<float>(pixel->x()), static_cast<float>(pixel->y()));
  }
};

// How the marker is lit, and where on it highlights lie.
class MarkerLight {
 public:
  MarkerLight(const MarkerView& view, const MarkerCode& code) {
    for (int row = -1; row <= code.cells; ++row) {
      for (int column = -1; column <= code.cells; ++column) look(view, code, row, column);
    }
  }
  // Of the inner cells: as much as one of them.
  [[nodiscard]] bool are_any_hidden() const { return hidden_parts_ >= kParts; }
  // The light that most cells agree on. False when there is none.
  bool fit() {
    for (int pass = 0; pass < kLightPasses; ++pass) {
      const LightFit last = fit_;
      const double range = last.gain(0, 0);
      fit_ = LightFit();
      for (const Cell& cell : std::span(all_).first(static_cast<std::size_t>(count_))) {
        const double error =
            pass == 0 ? 0 : (cell.value - last.light(cell.x, cell.y, cell.is_bright)) / (kUsualError * range);
        fit_.add(1 / ((1 + error * error) * (1 + error * error)), cell.x, cell.y, cell.value, cell.is_bright);
      }
      fit_.solve(0.3);
      if (!(fit_.gain(0, 0) > kMinRange)) return false;
    }
    return true;
  }
  // How near a highlight is: 1 beside one, 0 far from any.
  [[nodiscard]] double nearness(const Eigen::Vector2d& at) const {
    double nearest = 1e9;
    for (int k = 0; k < white_count_; ++k) nearest = std::min(nearest, (white_[k] - at).norm());
    const double beyond = std::max(0.0, nearest - kBesideCells) / kFadesCells;
    return std::exp(-beyond * beyond);
  }
  [[nodiscard]] const LightFit& operator*() const { return fit_; }

 private:
  struct Cell {
    double value, x, y;
    bool is_bright;
  };
  static constexpr int kMostCells = (kMaxCells + 2) * (kMaxCells + 2), kParts = 4;

  void look(const MarkerView& view, const MarkerCode& code, int row, int column) {
    const auto is_within = [&](int k) { return k >= 0 && k < code.cells; };
    // The margin is no wider than a cell: its half next to the square.
    const auto middle = [&](int k) { return k < 0 ? -0.4 : is_within(k) ? k + 0.5 : k + 0.4; };
    const bool is_margin = !is_within(row) || !is_within(column);
    const bool is_inside =
        is_within(row - 1) && is_within(row + 1) && is_within(column - 1) && is_within(column + 1);
    const Eigen::Vector2d at(middle(column), middle(row));
    const double spread = is_margin ? 0.12 : 0.25;
    double sum = 0;
    int known = 0;
    for (int k = 0; k < kParts; ++k) {
      const Eigen::Vector2d part = at + Eigen::Vector2d(k % 2 ? spread : -spread, k / 2 ? spread : -spread);
      const double value = view.light(part);
      if (value >= 0) {
        sum += value;
        ++known;
      } else if (value != MarkerView::kOutside) {
        white_[white_count_++] = part;
        hidden_parts_ += is_inside;
      }
    }
    if (known < kParts) return;
    all_[count_++] = {sum / kParts, at.x() / code.cells - 0.5, at.y() / code.cells - 0.5,
                      is_margin || code.is_bright(row, column)};
  }

  std::array<Cell, kMostCells> all_;
  std::array<Eigen::Vector2d, kParts * kMostCells> white_;
  int count_ = 0, white_count_ = 0, hidden_parts_ = 0;
  LightFit fit_;
};

// What one line across a boundary says of each pair of brightnesses: the likelihood of its light as their
// smeared step, noise, and a smooth light over it that is not below 0, whichever it is.
class LineOfLight {
 public:
  explicit LineOfLight(const Eigen::Vector3d& certainty) : normal_(certainty.asDiagonal()) {
    pull_.fill(Eigen::Vector3d::Zero());
  }
  void add(double across, double level, double step) {
    constexpr double kWeight = 1 / (kNoise * kNoise);
    ++known_;
    const Eigen::Vector3d terms(1, across, across * across);
    normal_ += kWeight * terms * terms.transpose();
    for (int pair = 0; pair < 4; ++pair) {
      const double off = level - (pair / 2 ? 1 - step : 0) - (pair % 2 ? step : 0);
      pull_[pair] += kWeight * off * terms;
      squares_[pair] += kWeight * off * off;
    }
  }
  [[nodiscard]] bool says_anything() const { return known_ >= kMinPlaces; }
  void speak(std::array<double, 4>& likelihoods) const {
    const Eigen::Matrix3d covariance = normal_.inverse();
    for (int pair = 0; pair < 4; ++pair) {
      const Eigen::Vector3d light = covariance * pull_[pair];
      const double is_added = 0.5 * std::erfc(-(light[0] + kDarker) / std::sqrt(2 * covariance(0, 0)));
      likelihoods[pair] += kLineWeight * (-0.5 * (squares_[pair] - pull_[pair].dot(light)) +
                                          std::log(std::max(1e-12, is_added)));
    }
  }

 private:
  Eigen::Matrix3d normal_;
  std::array<Eigen::Vector3d, 4> pull_;
  std::array<double, 4> squares_{};
  int known_ = 0;
};

// Logarithms of the likelihoods of what is on both sides; false where nothing is seen.
bool look_at_boundary(const MarkerView& view, const MarkerLight& lit, const Smear& smear,
                      const BoundaryPlace& boundary, std::array<double, 4>& likelihoods) {
  const Eigen::Vector2d middle = boundary.middle();
  const Eigen::Vector3d place_mm = view.place_mm(middle);
  Eigen::Matrix<double, 2, 3> d_pixel;
  if (!view.camera.project(view.pose * place_mm, d_pixel)) return false;
  const Eigen::Matrix<double, 2, 3> d_marker = d_pixel * view.pose.matrix();
  const Eigen::Vector2d along = d_marker.col(1 - boundary.axis);
  const Eigen::Vector2d normal = Eigen::Vector2d(-along.y(), along.x()).normalized();
  const double cell_px = std::abs(normal.dot(d_marker.col(boundary.axis))) * view.size_mm / view.cells;
  const Eigen::Vector3d moved = smear.motion.head<3>() + smear.motion.tail<3>().cross(place_mm);
  const double box = std::hypot(1.0, normal.dot(d_marker * moved)) / cell_px,
               sigma = smear.sigma_px / cell_px;
  std::array<double, kPlaces> across, step;
  for (int k = 0; k < kPlaces; ++k) {
    across[k] = kPlacesReach * (2.0 * k / (kPlaces - 1) - 1);
    step[k] = smeared_step(across[k], sigma, box);
  }
  const double nearness = lit.nearness(middle);
  Eigen::Vector3d certainty;
  for (int k = 0; k < 3; ++k)
    certainty[k] = 1 / std::pow(kFarLight[k] + nearness * (kNearLight[k] - kFarLight[k]), 2);
  const double x = middle.x() / view.cells - 0.5, y = middle.y() / view.cells - 0.5;
  const double gain = std::max((*lit).gain(x, y), kMinRange), bias = (*lit).bias(x, y);
  likelihoods = {};
  bool is_seen = false;
  for (int line = 0; line < kLines; ++line) {
    const double beside = kLinesReach * (2.0 * line / (kLines - 1) - 1);
    LineOfLight seen(certainty);
    for (int k = 0; k < kPlaces; ++k) {
      const double light = view.light(middle + (boundary.axis == 0 ? Eigen::Vector2d(across[k], beside)
                                                                   : Eigen::Vector2d(beside, across[k])));
      if (light >= 0) seen.add(across[k], (light - bias) / gain, step[k]);
    }
    if (!seen.says_anything()) continue;
    seen.speak(likelihoods);
    is_seen = true;
  }
  return is_seen;
}

}  // namespace

bool CodeEvidence::add(const LinearImage& image, const camera::CameraModel& camera,
                       const RigidTransform& pose, double size_mm, const MarkerCode& code,
                       const Smear& smear) {
  const MarkerView view{image, camera, pose, size_mm, code.cells};
  MarkerLight lit(view, code);
  if (!lit.are_any_hidden()) return false;
  if (!lit.fit()) return true;
  each_boundary(code.cells, [&](const BoundaryPlace& place) {
    std::array<double, 4> likelihoods;
    if (!look_at_boundary(view, lit, smear, place, likelihoods)) return;
    Boundary& boundary = boundaries_[place.index];
    ++boundary.frames;
    // What no pair explains says nothing.
    for (int pair = 0; pair < 4; ++pair) {
      const double over = likelihoods[pair] + kMostOfBoundary;
      boundary.sum[pair] += static_cast<float>(std::max(over, 0.0) + std::log1p(std::exp(-std::abs(over))));
    }
  });
  return true;
}

double CodeEvidence::likelihood(const MarkerCode& code, int turn) const {
  double sum = 0;
  each_boundary(code.cells, [&](const BoundaryPlace& place) {
    const Boundary& boundary = boundaries_[place.index];
    if (boundary.frames == 0) return;
    const auto is_bright = [&](int row, int column) {
      const int there = turned_cell(row, column, (4 - turn) % 4, code.cells);
      return code.is_bright(there / code.cells, there % code.cells);
    };
    const int pair = 2 * is_bright(place.row, place.column) + is_bright(place.other_row, place.other_column);
    sum += boundary.sum[pair] * std::min(1.0, static_cast<double>(kMostFrames) / boundary.frames);
  });
  return kBoundaryWeight * sum;
}

double CodeEvidence::lead(const KnownCodes& codes, std::size_t index) const {
  double others = -1e9;
  const auto consider = [&](const MarkerCode& code, int first_turn) {
    for (int turn = first_turn; turn < 4; ++turn) others = std::max(others, likelihood(code, turn));
  };
  for (std::size_t i = 0; i < codes.declared.size(); ++i) {
    if (i == index || !codes.is_elsewhere(i)) consider(codes.declared[i], i == index ? 1 : 0);
  }
  for (const MarkerCode& other : codes.dictionary) {
    const auto is_other = [&](const MarkerCode& declared) { return declared.id == other.id; };
    if (std::none_of(codes.declared.begin(), codes.declared.end(), is_other)) consider(other, 0);
  }
  return likelihood(codes.declared[index], 0) - others;
}

}  // namespace arthronaut::markers
