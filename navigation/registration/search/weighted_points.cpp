#include "navigation/registration/search/weighted_points.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <unordered_map>

#include "navigation/registration/bone/cell_key.h"

namespace arthronaut::registration {

namespace {

void weigh(WeightedPoints& points) {
  // Cells of 1 mm.
  const auto key = [](const Eigen::Vector3d& p_mm) { return cell_key(p_mm.array().floor().cast<int>()); };
  std::unordered_map<std::uint64_t, int> count;
  for (const Eigen::Vector3d& p : points.positions_mm) ++count[key(p)];
  points.weights.clear();
  points.weight_sum = 0;
  points.centroid_mm.setZero();
  for (const Eigen::Vector3d& p : points.positions_mm) {
    const double weight = 1.0 / count[key(p)];
    points.weights.push_back(weight);
    points.weight_sum += weight;
    points.centroid_mm += weight * p;
  }
  if (points.weight_sum > 0) points.centroid_mm /= points.weight_sum;
}

// The smoothed points of each stroke in place of its samples, where they span most of it. oriented: in the
// order of the curves.
strokes::Curves smoothed(const strokes::Curves& curves, const std::vector<strokes::OrientedPoint>& oriented) {
  strokes::Curves result;
  auto next = oriented.begin();
  for (std::size_t first = 0; first < curves.size();) {
    std::size_t last = first;
    while (last < curves.size() && curves[last].curve == curves[first].curve) ++last;
    const auto begin = next;
    while (next != oriented.end() && next->source_index < last) ++next;
    const bool is_covered =
        next - begin > 1 && 2 * ((next - 1)->source_index - begin->source_index) >= last - first;
    if (is_covered) {
      for (auto it = begin; it != next; ++it) {
        result.push_back(curves[it->source_index]);
        result.back().position_mm = it->position_mm;
      }
    } else {
      result.insert(result.end(), curves.begin() + static_cast<std::ptrdiff_t>(first),
                    curves.begin() + static_cast<std::ptrdiff_t>(last));
    }
    first = last;
  }
  return result;
}

}  // namespace

WeightedPoints choose_points(const strokes::Curves& curves, std::size_t max_count,
                             const std::vector<strokes::OrientedPoint>& oriented) {
  constexpr double kStretch_mm = 12.0;
  const strokes::Curves smooth = smoothed(curves, oriented);
  WeightedPoints points;
  const std::size_t count = std::min(smooth.size(), max_count);
  std::vector<int> curve_of;
  for (std::size_t i = 0; i < count; ++i) {
    const strokes::CurvePoint& point = smooth[i * smooth.size() / count];
    points.positions_mm.push_back(point.position_mm);
    points.shaft_directions.push_back(point.shaft_direction);
    curve_of.push_back(point.curve);
  }
  weigh(points);
  double begun_mm = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_first = i == 0;
    const bool is_new = !is_first && (curve_of[i] != curve_of[i - 1] || begun_mm >= kStretch_mm);
    if (is_new) begun_mm = 0;
    points.stretches.push_back(is_first ? 0 : points.stretches.back() + (is_new ? 1 : 0));
    begun_mm += points.weights[i];
    const bool is_new_stroke = is_first || curve_of[i] != curve_of[i - 1];
    points.path_mm.push_back(is_new_stroke ? 0 : points.path_mm.back() + points.weights[i]);
  }
  return points;
}

WeightedPoints draw_points(const WeightedPoints& points, std::size_t count, std::uint64_t seed) {
  std::vector<std::size_t> order(points.positions_mm.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937_64 random(seed);
  count = std::min(count, order.size());
  WeightedPoints drawn;
  for (std::size_t i = 0; i < count; ++i) {
    std::swap(order[i], order[i + random() % (order.size() - i)]);
    drawn.positions_mm.push_back(points.positions_mm[order[i]]);
    if (!points.offsets_mm.empty()) drawn.offsets_mm.push_back(points.offsets_mm[order[i]]);
  }
  weigh(drawn);
  return drawn;
}

}  // namespace arthronaut::registration
