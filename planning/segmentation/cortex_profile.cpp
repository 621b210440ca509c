#include "planning/segmentation/cortex_profile.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>

namespace arthronaut::segmentation {

namespace {

constexpr int kGroups = 6;
// A group's mean must leave little of a CT's noise, and of what lies beside the bone here and there.
constexpr std::size_t kLeastProfiles = 300;
// About the half-way point, outwards and inwards: further out lies what else there is.
constexpr int kOutward = 6, kInward = 14;
constexpr int kPoints = kOutward + 1 + kInward;
// How well a blurred layer explains a mean profile of a real bone, whose marrow is not of one grey.
constexpr double kMisfit_hu = 10;
// Weak expectations, which decide only what the profiles leave open: whether a low, narrow peak is a dark
// cortex or a thin one, and what lies behind a thick one.
constexpr double kCortex_hu = 1300, kCortexSpread_hu = 500, kMarrow_hu = 200, kMarrowSpread_hu = 300,
                 kThickness_mm = 1.5, kThicknessSpread = 1;
// The blur is another one along the slices than across them, and so is a peak's height: a group of low ones
// is in part of profiles across them. With one blur for all, a bright, thin cortex explained those better
// than the real one did, and its edge lay by 0.3 mm too far in.
constexpr double kBlurSpread = 0.2;  // of the natural logarithm
// A fit beyond these is none: no scanner of bones blurs more, and no blur is less than a voxel's.
constexpr double kLeastBlur_mm = 0.1, kMostBlur_mm = 1.0, kMostMisfit_hu = 40;
// The share rises above one half as the peak sinks; where the layer is thinner than the blur it says little.
constexpr float kMostShare = 0.85F;

struct Group {
  double low = 0, high = 0;                  // means
  std::array<double, kPoints> value = {};    // mean profile
  std::array<std::size_t, kPoints> count{};  // of profiles that reach so far
};

double normal_distribution(double x) { return 0.5 * std::erfc(-x * M_SQRT1_2); }

double grid_mm(int point) { return (point - kOutward) * kProfileStep_mm; }

Group mean_of(const std::vector<CortexProfile>& profiles, std::size_t begin, std::size_t end) {
  Group group;
  for (std::size_t i = begin; i < end; ++i) {
    const CortexProfile& profile = profiles[i];
    group.low += profile.low;
    group.high += profile.high;
    for (int p = 0; p < kPoints; ++p) {
      const double at = profile.edge_mm / kProfileStep_mm + (p - kOutward);
      const double floor = std::floor(at);
      if (floor < 0 || floor + 1 >= static_cast<double>(profile.values.size())) continue;
      const auto before = static_cast<std::size_t>(floor);
      const double value =
          profile.values[before] + (at - floor) * (profile.values[before + 1] - profile.values[before]);
      group.value[static_cast<std::size_t>(p)] += value;
      ++group.count[static_cast<std::size_t>(p)];
    }
  }
  const auto count = static_cast<double>(end - begin);
  group.low /= count;
  group.high /= count;
  for (std::size_t p = 0; p < kPoints; ++p) {
    // A mean over other profiles than its neighbours' would be a step that no bone has.
    if (2 * group.count[p] < end - begin) group.count[p] = 0;
    if (group.count[p] > 0) group.value[p] /= static_cast<double>(group.count[p]);
  }
  return group;
}

// Parameters: log sigma, c, then of each group s, m, log w, x0 and the logarithm of its blur to sigma.
struct Layers {
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  const std::vector<Group>& groups;

  static constexpr int kShared = 2, kOwn = 5, kExpected = 3;
  [[nodiscard]] int inputs() const { return kShared + kOwn * static_cast<int>(groups.size()); }
  [[nodiscard]] int values() const { return 1 + static_cast<int>(groups.size()) * (kPoints + kExpected); }

  static double value(const Eigen::VectorXd& x, int group, double at_mm) {
    const auto own = x.segment<kOwn>(kShared + kOwn * group);
    const double sigma = std::exp(x[0] + own[4]), c = x[1];
    return own[0] + (c - own[0]) * normal_distribution((at_mm - own[3]) / sigma) +
           (own[1] - c) * normal_distribution((at_mm - own[3] - std::exp(own[2])) / sigma);
  }

  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& residuals) const {
    int r = 0;
    residuals[r++] = (x[1] - kCortex_hu) / kCortexSpread_hu;
    for (int g = 0; g < static_cast<int>(groups.size()); ++g) {
      const Group& group = groups[static_cast<std::size_t>(g)];
      for (int p = 0; p < kPoints; ++p) {
        const auto at = static_cast<std::size_t>(p);
        residuals[r++] = group.count[at] > 0 ? (value(x, g, grid_mm(p)) - group.value[at]) / kMisfit_hu : 0.0;
      }
      const auto own = x.segment<kOwn>(kShared + kOwn * g);
      residuals[r++] = (own[1] - kMarrow_hu) / kMarrowSpread_hu;
      residuals[r++] = (own[2] - std::log(kThickness_mm)) / kThicknessSpread;
      residuals[r++] = own[4] / kBlurSpread;
    }
    return 0;
  }
};

}  // namespace

EdgeShare EdgeShare::of(std::vector<CortexProfile> profiles) {
  EdgeShare share;
  if (profiles.size() < kLeastProfiles * kGroups) return share;
  std::ranges::sort(profiles, {}, [](const CortexProfile& p) { return p.high - p.low; });
  std::vector<Group> groups;
  for (std::size_t g = 0; g < kGroups; ++g)
    groups.push_back(mean_of(profiles, g * profiles.size() / kGroups, (g + 1) * profiles.size() / kGroups));

  const Layers layers{groups};
  Eigen::VectorXd x(layers.inputs());
  x[0] = std::log(0.5);
  x[1] = kCortex_hu;
  for (std::size_t g = 0; g < kGroups; ++g) {
    x.segment<Layers::kOwn>(Layers::kShared + Layers::kOwn * static_cast<Eigen::Index>(g)) << groups[g].low,
        kMarrow_hu, std::log(kThickness_mm), 0, 0;
  }
  Eigen::NumericalDiff<Layers> with_derivatives(layers);
  Eigen::LevenbergMarquardt<Eigen::NumericalDiff<Layers>> solver(with_derivatives);
  solver.parameters.maxfev = 4000;
  const auto status = solver.minimize(x);
  const double sigma = std::exp(x[0]);
  const double misfit = kMisfit_hu * solver.fvec.norm() / std::sqrt(static_cast<double>(solver.fvec.size()));
  if (status == Eigen::LevenbergMarquardtSpace::ImproperInputParameters || !x.allFinite() ||
      !(sigma > kLeastBlur_mm && sigma < kMostBlur_mm && misfit < kMostMisfit_hu))
    return share;
  share.blur_mm_ = sigma;
  share.cortex_hu_ = x[1];
  for (int g = 0; g < kGroups; ++g) {
    const Group& group = groups[static_cast<std::size_t>(g)];
    const double edge_mm = x[Layers::kShared + Layers::kOwn * g + 3];
    const double rise = group.high - group.low;
    const double at_edge = (Layers::value(x, g, edge_mm) - group.low) / rise;
    share.fitted_.push_back(
        {static_cast<float>(rise), std::clamp(static_cast<float>(at_edge), 0.4F, kMostShare)});
  }
  return share;
}

float EdgeShare::at(float rise) const {
  if (fitted_.empty()) return 0.5F;
  const auto above = std::ranges::lower_bound(fitted_, rise, {}, &Point::rise);
  if (above == fitted_.begin()) return above->share;
  if (above == fitted_.end()) return fitted_.back().share;
  const Point &a = *std::prev(above), &b = *above;
  return a.share + (b.share - a.share) * (rise - a.rise) / std::max(b.rise - a.rise, 1e-6F);
}

}  // namespace arthronaut::segmentation
