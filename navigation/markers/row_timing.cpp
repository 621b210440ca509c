#include "navigation/markers/row_timing.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace arthronaut::markers {
namespace {

// Told from zero by so many sigma: what edges have wrong together (print, lens, compression) stays from frame
// to frame, and is more than their scatter says.
constexpr double kTellingSigmas = 5;
// Fields are half a frame apart or are none; edges between combs tell the time roughly.
constexpr double kBetweenFields = 0.5, kLeastOfFields = 0.25;
// A rolling shutter takes a good part of the frame: less is what edges have wrong together. One that seems to
// take all of it and more is something else that bends the picture, as another medium does.
constexpr double kLeastReadout = 0.15, kMostReadout = 0.95;
// No camera's delay is known better, and none is longer.
constexpr double kLeastSigma = 0.01, kMostDelay = 1;
// Of the way between two fields: each edge is off by half of it, to one side or the other, and corners, which
// several edges make, by half of that.
constexpr double kShareOfComb = 0.25;
// Of the way that a motion changes by from frame to frame: so much may fields that are known be off, each a
// quarter of a frame from the pose's time, by a motion that the frames before tell to an eighth of that.
constexpr double kShareOfChange = 0.03;

}  // namespace

double row_delay(const Eigen::Vector2d& delays, double row, double centre_row, int height_px) {
  return delays[0] * (row - centre_row) / height_px +
         delays[1] * (static_cast<int>(row) % 2 == 0 ? -0.5 : 0.5);
}

Eigen::Vector2d RowTiming::sigmas() const {
  return Eigen::Matrix2d(information_.inverse()).diagonal().cwiseSqrt();
}

Eigen::Vector2d RowTiming::known() const {
  const Eigen::Vector2d sigma = sigmas();
  const auto is_told = [&](int k) { return std::abs(mean_[k]) > kTellingSigmas * sigma[k]; };
  const bool are_fields = is_told(1) && std::abs(mean_[1]) > kLeastOfFields;
  const double readout = std::abs(mean_[0]);
  const bool is_readout = is_told(0) && readout > kLeastReadout && readout < kMostReadout;
  return {is_readout ? mean_[0] : 0, are_fields ? std::copysign(kBetweenFields, mean_[1]) : 0};
}

Eigen::Matrix2d RowTiming::uncertainty() const {
  const Eigen::Vector2d left_in = mean_ - known();
  return information_.inverse() + left_in * left_in.transpose();
}

double RowTiming::comb_px(double moves_px, double change_px) const {
  if (known()[1] != 0) return kShareOfChange * change_px;
  const double sigma = sigmas()[1];
  if (std::abs(mean_[1]) + 2 * sigma < kLeastOfFields) return 0;
  return kShareOfComb * moves_px * std::hypot(mean_[1], sigma);
}

void RowTiming::learn(const RowTrend& trend) {
  const Eigen::Vector2d gain = trend.gain + trend.weight * (known() - mean_);
  const Eigen::Matrix2d information = information_ + trend.weight;
  const Eigen::Vector2d mean = mean_ + information.inverse() * gain;
  if (!mean.allFinite()) return;
  mean_ = mean.cwiseMax(-kMostDelay).cwiseMin(kMostDelay);
  information_ = information;
  // What is known as well as can be stays so, and takes nothing from the other.
  const Eigen::Array2d most = 1 / (kLeastSigma * kLeastSigma) / information_.diagonal().array();
  const Eigen::Vector2d kept = most.min(1.0).sqrt().matrix();
  information_ = kept.asDiagonal() * information_ * kept.asDiagonal();
}

void correct_rows(const RowTiming& timing, double centre_row, int height_px, double sigma_px,
                  std::span<EdgeMeasurement> measurements) {
  const Eigen::Vector2d known = timing.known();
  for (EdgeMeasurement& edge : measurements) {
    if (edge.state != EdgeState::Found) continue;
    const double row = edge.point_px.y() + edge.offset_px * edge.normal.y();
    edge.row_share = (row - centre_row) / height_px;
    edge.by_delays_px[0] = edge.moves_px * edge.row_share;
    edge.offset_px -= known[0] * edge.by_delays_px[0];
    if (known[1] != 0) continue;
    // Between two rows a profile sees both fields, and all the more the steeper it runs: the first harmonic
    // of rows that take turns, weighted as the slope of a smeared edge weighs them.
    constexpr double kHarmonic = 4 / (geometry::kPi * geometry::kPi);
    const double blur = geometry::kPi * edge.normal.y() * sigma_px;
    edge.by_delays_px[1] =
        -edge.moves_px * kHarmonic * std::cos(geometry::kPi * row) * std::exp(-0.25 * blur * blur);
  }
}

}  // namespace arthronaut::markers
