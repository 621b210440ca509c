#include "planning/postop/wall_profile.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace arthronaut::postop {

namespace {

constexpr std::size_t kLeastPoints = 10;
constexpr double kFirstBlur_mm = 0.45;
constexpr double kMostBlur_mm = 1.0, kLeastRim_mm = 0.3, kLeastLayer_mm = 0.5, kMostRim_mm = 2,
                 kMostOff_mm = 2;
// Points nearer than this tell the same.
constexpr double kApart_mm = 0.25;
// A rim stands out from both sides by so much, and is no denser than cortex. One thinner than the least
// leaves nothing of its own in the picture.
constexpr double kRimStep_hu = 30, kMostRim_hu = 1200;
// One that stands out by less than this times the scatter of one voxel may be grain, of which rings of up to
// 1.5 times were seen where there was none; rims of 300 to 600 HU stood out by 2.8 times at least.
constexpr double kClearRim = 2;
// Of the step from inside to beyond, that a layer between the two is off either.
constexpr double kLayerStep = 0.15;
// Of its inner side from what was taken for the wall: half of what is asked of a diameter.
constexpr double kLeastOff_mm = 0.15;
enum class Between { Rim, Layer };

double cumulated(double z) { return 0.5 * std::erfc(-z * M_SQRT1_2); }
double density(double z) { return std::exp(-0.5 * z * z) / std::sqrt(2 * M_PI); }

struct Shape {
  double wall_mm, blur_mm, rim_mm;
  bool is_sloping = false;  // what is beyond the wall changes evenly with the distance from it
  Between between = Between::Rim;
};

struct Explained {
  Shape shape;
  Eigen::Vector3d levels;  // HU: inside, rim (or the slope in HU/mm), beyond
  double unexplained;      // sum of squares, weights of mean 1
};

class Explanation {
 public:
  Explanation(const std::vector<WallPoint>& points, double noise_hu, double shared) : points_(points) {
    double count = 0;
    for (const WallPoint& point : points) count += point.count / static_cast<double>(points.size());
    for (const WallPoint& point : points) weights_.push_back(point.count / count);
    constexpr double kLeast = 1e-6;  // of a picture without noise, which is explained to the last bit
    floor_ = kLeast + shared * noise_hu * noise_hu / count * static_cast<double>(points.size());
  }

  // The best wall and blur for a rim of this thickness.
  [[nodiscard]] Explained with_rim(double rim_mm) const {
    Explained best = descended({0, kFirstBlur_mm, rim_mm});
    if (rim_mm == 0) return best;
    // What was taken for the wall may be the rim's outer side, too.
    for (const Shape& from :
         {Shape{0.3, 0.25, rim_mm}, Shape{0.3, 0.7, rim_mm}, Shape{-rim_mm, kFirstBlur_mm, rim_mm}})
      if (const Explained tried = descended(from); tried.unexplained < best.unexplained) best = tried;
    return best;
  }

  // A layer as thick, of a density between those on its sides.
  [[nodiscard]] Explained with_layer(double layer_mm) const {
    Explained best = descended({0, kFirstBlur_mm, layer_mm, false, Between::Layer});
    const Explained tried = descended({-layer_mm, kFirstBlur_mm, layer_mm, false, Between::Layer});
    return tried.unexplained < best.unexplained ? tried : best;
  }

  // A wall without a rim.
  [[nodiscard]] Explained sloping() const { return descended({0, kFirstBlur_mm, 0, true}); }

 private:
  // The best levels for a shape.
  [[nodiscard]] Explained levelled(const Shape& shape) const {
    // Without a rim its share is none, and its level is held by the first summand.
    Eigen::Matrix3d normal = Eigen::Matrix3d::Identity() * 1e-6;
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    double squares = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const WallGrey grey = wall_grey(points_[i].off_mm - shape.wall_mm, shape.rim_mm, shape.blur_mm);
      const Eigen::Vector3d row(grey.inside, shape.is_sloping ? past_mm(points_[i].off_mm, shape) : grey.rim,
                                grey.beyond);
      normal += weights_[i] * row * row.transpose();
      right += weights_[i] * points_[i].hu * row;
      squares += weights_[i] * points_[i].hu * points_[i].hu;
    }
    const Eigen::Vector3d levels = normal.ldlt().solve(right);
    Explained explained{shape, levels, std::max(0.0, squares - right.dot(levels)) + floor_};
    const bool is_rim = levels[1] > std::max(levels[0], levels[2]) + kRimStep_hu && levels[1] < kMostRim_hu;
    const double up = (levels[1] - levels[0]) / (levels[2] - levels[0]);
    const bool is_layer = up > kLayerStep && up < 1 - kLayerStep;
    if (shape.rim_mm > 0 && !(shape.between == Between::Rim ? is_rim : is_layer))
      explained.unexplained = std::numeric_limits<double>::infinity();
    return explained;
  }

  // How far beyond the wall, as seen through the blur.
  [[nodiscard]] static double past_mm(double off_mm, const Shape& shape) {
    const double z = (off_mm - shape.wall_mm) / shape.blur_mm;
    return shape.blur_mm * (z * cumulated(z) + density(z));
  }

  // By ever smaller steps of the wall and of the blur.
  [[nodiscard]] Explained descended(const Shape& from) const {
    Explained now = levelled(from);
    for (double step = 0.2; step > 0.006; step *= 0.5) {
      for (bool is_better = true; is_better;) {
        is_better = false;
        for (int way = 0; way < 4; ++way) {
          const double by = way % 2 ? step : -step;
          Shape shape = now.shape;
          (way < 2 ? shape.wall_mm : shape.blur_mm) += way < 2 ? by : 0.5 * by;
          if (std::abs(shape.wall_mm) > kMostOff_mm || shape.blur_mm < kLeastSeenBlur_mm ||
              shape.blur_mm > (shape.is_sloping ? kMostSeenBlur_mm : kMostBlur_mm))
            continue;
          const Explained tried = levelled(shape);
          if (!(tried.unexplained < now.unexplained * (1 - 1e-6))) continue;
          now = tried;
          is_better = true;
        }
      }
    }
    return now;
  }

  const std::vector<WallPoint>& points_;
  std::vector<double> weights_;
  double floor_ = 0;
};

}  // namespace

bool WallProfile::is_like(const WallProfile& other) const {
  constexpr double kApartWall_mm = 0.05, kApartBlur = 0.1;
  return std::isfinite(wall_sigma_mm + other.wall_sigma_mm) && has_rim() == other.has_rim() &&
         (!has_rim() || std::abs(wall_mm - other.wall_mm) < kApartWall_mm) &&
         std::abs(plain_blur_mm - other.plain_blur_mm) < kApartBlur * other.plain_blur_mm;
}

WallGrey wall_grey(double off_mm, double rim_mm, double blur_mm) {
  const double at_wall = off_mm / blur_mm, at_rim = (off_mm - rim_mm) / blur_mm,
               past_wall = cumulated(at_wall), past_rim = cumulated(at_rim),
               wall_slope = density(at_wall) / blur_mm, rim_slope = density(at_rim) / blur_mm;
  return {1 - past_wall, past_wall - past_rim, past_rim, -wall_slope, wall_slope - rim_slope, rim_slope};
}

WallProfile explain_wall(const std::vector<WallPoint>& points, double noise_hu, double shared) {
  if (points.size() < kLeastPoints) return {.wall_sigma_mm = std::numeric_limits<double>::infinity()};
  const Explanation explanation(points, noise_hu, shared);
  const Explained plain = explanation.with_rim(0);
  std::vector<Explained> rimmed;
  for (double rim_mm = kLeastRim_mm; rim_mm < kMostRim_mm + 0.01; rim_mm += 0.1)
    rimmed.push_back(explanation.with_rim(rim_mm));
  const double best = std::min_element(rimmed.begin(), rimmed.end(), [](const auto& a, const auto& b) {
                        return a.unexplained < b.unexplained;
                      })->unexplained;
  // As many points tell something of their own: the likelihood goes with the unexplained to minus half of
  // that. A rim takes two numbers more, thickness and density.
  const double told = (points.back().off_mm - points.front().off_mm) / kApart_mm;
  const bool is_rim_likely = told * std::log(plain.unexplained / best) > 2 * std::log(told);
  // Where the wall lies by all that would do, weighed by how likely that is; against what a rim's two numbers
  // cost, none is favoured by so much as above. Of rims that do alike, the best one is off by chance.
  // `best` is infinite where no rim does at all.
  const double likeliest = std::min(best, plain.unexplained);
  double share = 0, sum = 0, squares = 0;
  const auto weigh = [&](const Explained& one, double favour) {
    if (!std::isfinite(one.unexplained)) return;
    const double likely = favour * std::pow(likeliest / one.unexplained, 0.5 * told);
    share += likely;
    sum += likely * one.shape.wall_mm;
    squares += likely * one.shape.wall_mm * one.shape.wall_mm;
  };
  weigh(plain, told);
  for (const Explained& one : rimmed) weigh(one, 1.0);
  const double mean_mm = sum / share, variance = std::max(0.0, squares / share - mean_mm * mean_mm);
  const auto off_mean = [&](const Explained& one) {
    return std::isfinite(one.unexplained) ? std::abs(one.shape.wall_mm - mean_mm)
                                          : std::numeric_limits<double>::infinity();
  };
  const Explained& rim = *std::min_element(
      rimmed.begin(), rimmed.end(), [&](const auto& a, const auto& b) { return off_mean(a) < off_mean(b); });
  const double rim_step_hu = rim.levels[1] - std::max(rim.levels[0], rim.levels[2]);
  const bool has_rim = is_rim_likely && rim_step_hu > kClearRim * noise_hu;
  const Explained& taken = has_rim ? rim : plain;
  const Explained sloping = explanation.sloping();
  WallProfile profile{.wall_mm = taken.shape.wall_mm,
                      .blur_mm = taken.shape.blur_mm,
                      .plain_blur_mm = sloping.shape.blur_mm,
                      .wall_sigma_mm = std::hypot(std::sqrt(variance), taken.shape.wall_mm - mean_mm)};
  // A layer takes one number more than marrow that changes, two more than an even one.
  double least = std::min(sloping.unexplained, taken.unexplained), inner_mm = 0;
  for (double layer_mm = kLeastLayer_mm; layer_mm < kMostRim_mm + 0.01; layer_mm += 0.25) {
    const Explained layered = explanation.with_layer(layer_mm);
    if (!(told * std::log(least / layered.unexplained) > (profile.layer_mm > 0 ? 0 : 2) * std::log(told)))
      continue;
    least = layered.unexplained;
    profile.layer_mm = layer_mm;
    inner_mm = layered.shape.wall_mm;
  }
  // Where its inner side is what was taken for the wall, the layer is marrow, and what is beyond it cortex.
  if (inner_mm > -kLeastOff_mm) profile.layer_mm = 0;
  if (has_rim) {
    profile.rim_mm = taken.shape.rim_mm;
    profile.rim_hu = taken.levels[1];
  }
  return profile;
}

}  // namespace arthronaut::postop
