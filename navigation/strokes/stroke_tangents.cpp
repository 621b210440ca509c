#include "navigation/strokes/stroke_tangents.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "planning/geometry/quantile.h"

namespace arthronaut::strokes {

namespace {

using Points = std::vector<Eigen::Vector3d>;

// Calls f(first, last) for each run of points with the same curve number.
template <typename Function>
void for_each_stroke(const Curves& curves, Function f) {
  for (std::size_t first = 0; first < curves.size();) {
    std::size_t last = first;
    while (last < curves.size() && curves[last].curve == curves[first].curve) ++last;
    f(first, last);
    first = last;
  }
}

double length_at_stride(const Points& points, std::size_t stride) {
  double length_mm = 0;
  for (std::size_t i = stride; i < points.size(); i += stride)
    length_mm += (points[i] - points[i - stride]).norm();
  return length_mm;
}

// Component-wise running median: takes out spikes, keeps corners.
Points running_median(const Points& points, std::size_t half_width) {
  Points smooth(points.size());
  std::vector<double> window;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t reach = std::min({half_width, i, points.size() - 1 - i});
    for (int axis = 0; axis < 3; ++axis) {
      window.clear();
      for (std::size_t j = i - reach; j <= i + reach; ++j) window.push_back(points[j][axis]);
      smooth[i][axis] = geometry::median_in_place(std::span(window));
    }
  }
  return smooth;
}

Points running_mean(const Points& points, std::size_t half_width) {
  Points smooth(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t reach = std::min({half_width, i, points.size() - 1 - i});
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t j = i - reach; j <= i + reach; ++j) sum += points[j];
    smooth[i] = sum / static_cast<double>(2 * reach + 1);
  }
  return smooth;
}

// Noise makes the path of dense samples too long: the samples are smoothed over the shortest stride at which
// walking every second step would hardly shorten the path.
std::vector<double> arc_lengths(const Points& points) {
  constexpr double kStillShortens = 1.1;
  const Points despiked = running_median(points, 2);
  std::size_t stride = 1;
  while (2 * stride < points.size() / 4 &&
         length_at_stride(despiked, stride) > kStillShortens * length_at_stride(despiked, 2 * stride)) {
    stride *= 2;
  }
  const Points smooth = stride > 1 ? running_mean(despiked, 2 * stride) : despiked;
  std::vector<double> arc_mm(points.size(), 0.0);
  for (std::size_t i = 1; i < points.size(); ++i)
    arc_mm[i] = arc_mm[i - 1] + (smooth[i] - smooth[i - 1]).norm();
  return arc_mm;
}

struct LocalCurve {
  Eigen::Matrix3d coefficients;  // columns: value, first, second derivative / 2
  double rms_mm = 0;             // in one coordinate
  double weight = 0;             // effective number of points
};

// A quadratic through the window by reweighted least squares: absolute values first, which a third of lifted
// samples doesn't bend, Tukey's biweight then.
LocalCurve fit_local_curve(std::span<const Eigen::Vector3d> points, std::span<const double> offsets_mm) {
  constexpr int kAbsoluteIterations = 6, kIterations = 10;
  std::vector<double> weights(points.size(), 1.0), residuals(points.size());
  LocalCurve curve;
  double scale_mm = 0;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero(), right = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d basis(1.0, offsets_mm[i], offsets_mm[i] * offsets_mm[i]);
      normal += weights[i] * basis * basis.transpose();
      right += weights[i] * basis * points[i].transpose();
    }
    curve.coefficients = normal.ldlt().solve(right).transpose();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d basis(1.0, offsets_mm[i], offsets_mm[i] * offsets_mm[i]);
      residuals[i] = (points[i] - curve.coefficients * basis).norm();
    }
    // 1.538 is the median length of a three-dimensional unit normal vector.
    scale_mm = std::max(geometry::median(residuals) / 1.538, 0.01);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (iteration < kAbsoluteIterations) {
        weights[i] = 1.0 / std::max(residuals[i], 0.05);
      } else {
        const double u = residuals[i] / (5.0 * scale_mm);
        weights[i] = u < 1 ? (1 - u * u) * (1 - u * u) : 0.0;
      }
    }
  }
  double square_sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    square_sum += weights[i] * residuals[i] * residuals[i];
    curve.weight += weights[i];
  }
  curve.rms_mm = std::sqrt(square_sum / std::max(3.0 * (curve.weight - 3.0), 1.0));
  return curve;
}

void add_oriented_points(const Curves& curves, std::size_t first, std::size_t last,
                         const TangentOptions& options, std::vector<OrientedPoint>& oriented) {
  constexpr std::size_t kMinPoints = 5;
  if (last - first < kMinPoints) return;
  Points points;
  for (std::size_t i = first; i < last; ++i) points.push_back(curves[i].position_mm);
  const std::vector<double> arc_mm = arc_lengths(points);
  std::vector<double> offsets_mm;
  for (double center_mm = options.half_window_mm; center_mm <= arc_mm.back() - options.half_window_mm;
       center_mm += options.spacing_mm) {
    const auto begin = std::lower_bound(arc_mm.begin(), arc_mm.end(), center_mm - options.half_window_mm);
    const auto end = std::upper_bound(begin, arc_mm.end(), center_mm + options.half_window_mm);
    if (static_cast<std::size_t>(end - begin) < kMinPoints) continue;
    offsets_mm.clear();
    for (auto it = begin; it != end; ++it) offsets_mm.push_back(*it - center_mm);
    const auto offset = static_cast<std::size_t>(begin - arc_mm.begin());
    const LocalCurve curve = fit_local_curve({points.data() + offset, offsets_mm.size()}, offsets_mm);

    const Eigen::Vector3d velocity = curve.coefficients.col(1);
    if (velocity.norm() < 0.4 || curve.weight < 4.0) continue;  // turns back, or too little agrees
    OrientedPoint point;
    point.position_mm = curve.coefficients.col(0);
    point.tangent = velocity.normalized();
    point.fit_rms_mm = curve.rms_mm;
    point.tangent_error_rad = curve.rms_mm * std::sqrt(12.0 / curve.weight) / (2 * options.half_window_mm);
    point.curve = curves[first].curve;
    const auto middle = std::lower_bound(begin, end, center_mm);
    point.source_index = first + static_cast<std::size_t>(std::min(middle, end - 1) - arc_mm.begin());
    if (point.tangent_error_rad <= options.max_tangent_error_rad) oriented.push_back(point);
  }
}

}  // namespace

std::vector<OrientedPoint> oriented_points(const Curves& curves, const TangentOptions& options) {
  std::vector<OrientedPoint> oriented;
  for_each_stroke(curves, [&](std::size_t first, std::size_t last) {
    add_oriented_points(curves, first, last, options, oriented);
  });
  return oriented;
}

double smoothed_length_mm(const Curves& curves) {
  double length_mm = 0;
  for_each_stroke(curves, [&](std::size_t first, std::size_t last) {
    Points points;
    for (std::size_t i = first; i < last; ++i) points.push_back(curves[i].position_mm);
    if (points.size() > 1) length_mm += arc_lengths(points).back();
  });
  return length_mm;
}

}  // namespace arthronaut::strokes
