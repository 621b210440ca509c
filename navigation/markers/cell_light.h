// What reading a code and seeing one share: which cell is which, and the light on them.
#pragma once

#include <Eigen/Cholesky>
#include <array>

namespace arthronaut::markers {

// The cell of the square that the marker's cell falls on when its top-left is corner `turn`.
inline int turned_cell(int row, int column, int turn, int cells) {
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

}  // namespace arthronaut::markers
