#include "navigation/markers/direct_alignment.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "navigation/markers/product_sum.h"
#include "planning/geometry/quantile.h"

namespace arthronaut::markers {
namespace {

using geometry::RigidTransform;
using geometry::Vector6d;

constexpr int kVelocity = DirectUnknowns::kVelocity, kChange = DirectUnknowns::kChange,
              kSmear = DirectUnknowns::kSmear, kGamma = DirectUnknowns::kGamma,
              kLight = DirectUnknowns::kLight;
constexpr int kBiasTerms = DirectUnknowns::kBiasTerms, kGainTerms = DirectUnknowns::kGainTerms,
              kLightTerms = DirectUnknowns::kLightTerms, kCount = DirectUnknowns::kCount;
using Vector = Eigen::Matrix<double, kCount, 1>;
using Matrix = Eigen::Matrix<double, kCount, kCount>;
using Light = Eigen::Matrix<float, kLightTerms, 1>;

constexpr int kMinPixels = 120, kMinEdges = 20;
constexpr int kBoundEdges = 15;  // edges that the unknowns fit by themselves
constexpr int kRoughPixels = 300, kRoughStride = 3;
constexpr double kRoughlySettledPx = 0.3;
constexpr int kLikelyPixels = 2048;  // memory set aside
constexpr double kTukey = 4.685;
constexpr double kMinNoiseGrey = 1.5, kMaxNoiseGrey = 6, kMinNoiseLight = 2;
// Neighbouring pixels share what is wrong with them: so many count as one beside what is known beforehand.
constexpr double kCorrelatedPixels = 6;
constexpr double kSmearSigmaPx = 0.15, kGammaSigma = 0.15;
constexpr double kMomentsPerSigma = 1.6;  // moments of the exposure lie so many sigma apart, at most
constexpr double kSettledPx = 0.04, kSettledEnoughPx = 0.4;
constexpr int kCoarseIterations = 2, kMinIterations = 3;
// From here on a fit is given up that would not get there in time.
constexpr int kHopefulIterations = 5;
// The same when it went too far, and so many times its last step in each iteration would not bring it back.
constexpr double kWayBack = 2;
// Residuals that still get smaller, though the pose stands, mean that what covers is not out yet.
constexpr double kSettledShare = 0.95;

float tukey_weight(float ratio) {
  const float part = ratio / static_cast<float>(kTukey);
  if (std::abs(part) >= 1) return 0;
  const float left = 1 - part * part;
  return left * left;
}

using Terms = Eigen::Matrix<float, 10, 1>;
Terms terms_at(const Eigen::Vector2f& place) {
  const float x = place.x(), y = place.y();
  Terms terms;
  terms << 1, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y;
  return terms;
}

// How far the sides move in the picture over the exposure.
double motion_px(const Vector6d& twist, double size_mm, double px_per_mm) {
  return px_per_mm * (twist.head<3>().norm() + 0.5 * size_mm * twist.tail<3>().norm());
}

// How much of what the pixels show is the code: its part of the model against the residuals.
struct CodeShare {
  double n = 0, sum = 0, squares = 0, residuals = 0;
  void add(double weight, double code, double residual) {
    n += weight;
    sum += weight * code;
    squares += weight * code * code;
    residuals += weight * residual * residual;
  }
  // As a correlation would be, if light without the code were no help in explaining the pixels.
  [[nodiscard]] double likeness() const {
    const double spread = n > 0 ? squares - sum * sum / n : 0;
    return spread > 0 ? std::sqrt(spread / (spread + residuals)) : 0;
  }
};

}  // namespace

DirectFit::DirectFit() : pixels_(kLikelyPixels) {
  residuals_.reserve(kLikelyPixels);
  levels_.reserve(kLikelyPixels / kPixelsTogether + 1);
  light_.reserve(kLikelyPixels);
  light_rows_.reserve(kLikelyPixels);
  sorted_.reserve(kLikelyPixels);
  edge_gradients_.resize(2 * (kMaxCells + 1) * kMaxCells);
}

struct DirectFit::State {
  ExposedCode exposed;
  ExposedPose pose;
  double smear = 0;  // logarithm of the factor on the pixels' sigmas
  float smear_factor = 1;
  double gamma = 1;
  Light light = Light::Zero();
  float coarse = 0;  // smear on purpose, in cells
  double noise = kMinNoiseGrey;

  void find_levels(std::span<const PixelBlocks::Block> blocks, std::span<SeenLevels> levels) const {
    const auto wider = [this](float sigma) {
      const float smeared = smear_factor * sigma;
      return coarse > 0 ? std::sqrt(smeared * smeared + coarse * coarse) : smeared;
    };
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      LookedAt at = blocks[b].at;
      for (int lane = 0; lane < kPixelsTogether; ++lane) {
        at.sigma_x[lane] = wider(at.sigma_x[lane]);
        at.sigma_y[lane] = wider(at.sigma_y[lane]);
      }
      exposed.look(at, levels[b]);
    }
  }
  bool apply(const Vector& step) {
    if (!step.allFinite() || step.head<3>().norm() > 3 || step.segment<3>(3).norm() > 0.5) return false;
    pose.camera_from_marker = pose.camera_from_marker * geometry::exp(step.head<6>());
    for (int i = 0; i < 3; ++i) {
      pose.velocity[i < 2 ? i : 5] += step[kVelocity + i];
      pose.change[i < 2 ? i : 5] += step[kChange + i];
    }
    smear = std::clamp(smear + step[kSmear], -0.7, 0.9);
    smear_factor = static_cast<float>(std::exp(smear));
    gamma = std::clamp(gamma + step[kGamma], 1.0, 3.0);
    light += step.segment<kLightTerms>(kLight).cast<float>();
    return pose.camera_from_marker.translation_mm.z() > 0;
  }
  // From here back to where the fit started.
  [[nodiscard]] Vector lag(const DirectStart& start) const {
    const auto in_plane = [](const Vector6d& twist) { return Eigen::Vector3d(twist[0], twist[1], twist[5]); };
    Vector lag = Vector::Zero();
    lag.segment<3>(kVelocity) = in_plane(start.pose.velocity - pose.velocity);
    lag.segment<3>(kChange) = in_plane(start.pose.change - pose.change);
    lag[kSmear] = -smear;
    lag[kGamma] = start.gamma - gamma;
    return lag;
  }
};

struct DirectFit::Linearised {
  Matrix products = Matrix::Zero();  // J^T W J
  Vector pull = Vector::Zero();      // J^T W r
  Matrix normal = Matrix::Zero();    // with noise and what is known beforehand
  Vector prior = Vector::Zero();
  CodeShare code_share;
  double scale = 0;  // robust, of the residuals
  int used = 0;
};

// What light the start asks for is linear, in light; three times over, so that what is covered drops out.
void DirectFit::guess_light(State& state) {
  const auto gamma = static_cast<float>(state.gamma);
  const int count = pixels_.count();
  residuals_.resize(count);
  light_.resize(count);
  light_rows_.resize(count);
  for (int i = 0; i < count; ++i) {
    const SeenPixels& seen = pixels_.seen(i);
    const int lane = i % kPixelsTogether;
    light_[i] = 255 * std::pow(seen.grey[lane] / 255, gamma);
    const Terms terms = terms_at({seen.place_x[lane], seen.place_y[lane]});
    const float level = levels_[i / kPixelsTogether].level[lane];
    for (int k = 0; k < kBiasTerms; ++k) light_rows_[i][k] = terms[k];
    for (int k = 0; k < kGainTerms; ++k) light_rows_[i][kBiasTerms + k] = level * terms[k];
  }
  for (int pass = 0; pass < 3; ++pass) {
    using Square = Eigen::Matrix<float, kLightTerms, kLightTerms>;
    Square normal = 1e-2F * Square::Identity();
    Light right = Light::Zero();
    for (int i = 0; i < count; ++i) {
      const Light& row = light_rows_[i];
      const Light weighed = pixels_.weight(i) * row;
      // By columns from the diagonal on, four rows at a time: the half that is looked at.
      for (int column = 0; column < kLightTerms; ++column) {
        const int first = column / 4 * 4;
        for (int k = first; k < kLightTerms; ++k) normal(k, column) += weighed[k] * row[column];
      }
      right += pixels_.weight(i) * light_[i] * row;
    }
    state.light = normal.ldlt().solve(right);
    sorted_.clear();
    for (int i = 0; i < count; ++i) {
      residuals_[i] = light_[i] - state.light.dot(light_rows_[i]);
      sorted_.push_back(std::abs(residuals_[i]));
    }
    const auto scale =
        static_cast<float>(std::max(kMinNoiseLight, 1.8 * geometry::median_in_place(std::span(sorted_))));
    for (int i = 0; i < count; ++i) pixels_.weight(i) = tukey_weight(residuals_[i] / scale);
  }
}

void DirectFit::linearise(const State& state, bool is_first, Linearised& result) {
  static_assert(kCount <= kRow && kRow == kProductSize && kVelocity % kPixelsTogether == 0);
  result = Linearised();
  ProductSum products;
  for (Row& gradient : edge_gradients_) gradient.setZero();
  sorted_.clear();
  FittedLight light;
  Eigen::Map<Light>(light.terms) = state.light;
  light.gamma = static_cast<float>(state.gamma);
  light.noise = static_cast<float>(state.noise);
  light.has_weights = is_first;
  const auto explain = processor_has_avx2() ? explain_pixels_avx2 : explain_pixels;
  ExplainedPixels explained;
  int left = pixels_.count();
  const int telling = state.exposed.shows_motion() ? kRow : kVelocity;
  for (std::size_t b = 0; b < levels_.size(); ++b, left -= kPixelsTogether) {
    const PixelBlocks::Block& block = pixels_.blocks()[b];
    explain(light, block.seen, levels_[b], explained);
    for (int lane = 0; lane < kPixelsTogether; ++lane) {
      Eigen::Map<Row> row(explained.rows[lane]);
      const float weight = explained.weight[lane], residual = explained.residual[lane];
      if (lane >= left) {
        row.setZero();
        continue;
      }
      sorted_.push_back(std::abs(residual));
      if (weight <= 0) continue;
      ++result.used;
      result.code_share.add(weight, explained.code[lane], residual);
      edge_gradients_[block.edge[lane]] += std::sqrt(weight) * residual * row;
    }
    products.add(explained.rows, telling);
  }
  result.scale = 1.4826 * geometry::median_in_place(std::span(sorted_));
  result.products = products.take().topLeftCorner<kCount, kCount>().cast<double>();
  for (const Row& part : edge_gradients_) result.pull += part.head<kCount>().cast<double>();
}

bool DirectFit::scattered_covariance(const Linearised& at, double certainty,
                                     geometry::Matrix6d& covariance) const {
  // Of the inverse only what belongs to the pose is needed.
  const Eigen::Matrix<double, kCount, 6> inverse =
      at.normal.ldlt().solve(Eigen::Matrix<double, kCount, 6>::Identity());
  geometry::Matrix6d scatter = inverse.transpose() * at.prior.asDiagonal() * inverse;
  int edges = 0;
  for (const Row& part : edge_gradients_) {
    if (part.isZero()) continue;
    ++edges;
    const Vector6d pull = inverse.transpose() * (certainty * part.head<kCount>().cast<double>());
    scatter.noalias() += pull * pull.transpose();
  }
  if (edges < kMinEdges) return false;
  const double small_sample = edges / static_cast<double>(edges - kBoundEdges);
  covariance = small_sample * scatter;
  return covariance.allFinite();
}

DirectPose DirectFit::refine(const camera::GrayView& frame, const camera::CameraModel& camera,
                             const MarkerCode& code, std::span<const EdgeSample> samples, double size_mm,
                             const DirectStart& start, const DirectOptions& options) {
  DirectPose result;
  result.outcome = DirectPose::Outcome::OutOfView;
  pixels_.clear();
  const auto take_more = [&](std::size_t first, std::size_t every) {
    take_pixels(frame, camera, code.cells, samples, size_mm, start, options, first, every);
    levels_.resize(pixels_.blocks().size());
  };
  // The way to the result takes a part of the pixels, the last iterations all of them.
  bool is_rough = options.max_pixels > kRoughPixels;
  take_more(0, is_rough ? kRoughStride : 1);
  const auto take_all = [&] {
    for (int first = 1; is_rough && first < kRoughStride; ++first) take_more(first, kRoughStride);
    is_rough = false;
  };
  if (pixels_.count() < kMinPixels) take_all();
  if (pixels_.count() < kMinPixels) return result;

  const double px_per_mm = camera.central_focal_px() / start.pose.camera_from_marker.translation_mm.z();
  const double cell_px = px_per_mm * size_mm / code.cells;
  const Eigen::Vector3d lever_px(px_per_mm, px_per_mm, 0.5 * size_mm * px_per_mm);
  Vector prior = Vector::Zero();
  prior.segment<3>(kVelocity) = (lever_px / start.velocity_sigma_px).array().square();
  prior.segment<3>(kChange) = (lever_px / start.change_sigma_px).array().square();
  prior[kSmear] = std::pow(start.sigma_px / kSmearSigmaPx, 2);
  prior[kGamma] = 1 / (kGammaSigma * kGammaSigma);

  State state{.exposed = ExposedCode(code, size_mm), .pose = start.pose, .gamma = start.gamma};
  const auto way_px = [&](const State& there) {
    return motion_px(geometry::log(start.pose.camera_from_marker.inverse() * there.pose.camera_from_marker),
                     size_mm, px_per_mm);
  };
  Linearised at;
  const int coarse_iterations = options.coarse_cells > 0 ? kCoarseIterations : 0;
  double moved_px = 0, certainty = 0, last_scale = 1e9;
  for (int iteration = 0;; ++iteration) {
    state.coarse = iteration < coarse_iterations ? static_cast<float>(options.coarse_cells) : 0;
    const double moment_px =
        kMomentsPerSigma * (start.sigma_px * std::exp(state.smear) + state.coarse * cell_px);
    state.exposed.move(
        state.pose,
        static_cast<int>(std::ceil(motion_px(state.pose.velocity, size_mm, px_per_mm) / moment_px)));
    state.find_levels(pixels_.blocks(), levels_);
    if (iteration == 0) guess_light(state);
    linearise(state, iteration == 0, at);
    at.prior = prior;
    // While the code is smeared on purpose, what else smears it stays as it is.
    if (state.coarse > 0) {
      at.prior.segment<2>(kSmear) *= 1e6;
      at.prior.segment<6>(kVelocity) *= 1e6;
    }
    certainty = (is_rough ? kRoughStride : 1) / (kCorrelatedPixels * state.noise * state.noise);
    at.normal = certainty * at.products;
    at.normal.diagonal() += at.prior;
    at.normal.diagonal().array() += 1e-9;
    const double falls = std::min(1.0, at.scale / last_scale);
    last_scale = at.scale;
    const bool is_settled = !is_rough && iteration >= coarse_iterations + kMinIterations &&
                            moved_px < kSettledPx && falls > kSettledShare;
    if (is_settled || iteration == options.max_iterations) break;
    if (iteration >= coarse_iterations + kHopefulIterations &&
        at.scale * std::pow(falls, options.max_iterations - iteration) > options.hopeless_noise_grey) {
      result.outcome = DirectPose::Outcome::Unlike;
      return result;
    }

    // A high scale in the beginning lets a start that is off come in; a low one later keeps out what covers.
    state.noise = std::clamp(at.scale, kMinNoiseGrey, state.coarse > 0 ? 3 * kMaxNoiseGrey : kMaxNoiseGrey);
    const Vector step = at.normal.ldlt().solve(certainty * at.pull + at.prior.cwiseProduct(state.lag(start)));
    result.outcome = DirectPose::Outcome::NotSettled;
    if (!state.apply(step)) return result;
    moved_px = motion_px(step.head<6>(), size_mm, px_per_mm);
    if (iteration >= coarse_iterations + kHopefulIterations &&
        way_px(state) - options.max_way_cells * cell_px >
            kWayBack * (options.max_iterations - iteration) * moved_px)
      return result;
    if (iteration >= coarse_iterations &&
        (moved_px < kRoughlySettledPx || iteration >= coarse_iterations + kHopefulIterations))
      take_all();
  }
  if (!scattered_covariance(at, certainty, result.covariance)) return result;
  result.covariance *= options.shared_errors;
  if ((coarse_iterations == 0 && moved_px > kSettledEnoughPx) ||
      way_px(state) > options.max_way_cells * cell_px)
    return result;
  result.pose = state.pose;
  result.sigma_px = start.sigma_px * std::exp(state.smear);
  result.gamma = state.gamma;
  result.noise_grey = state.noise;
  result.inlier_share = static_cast<double>(at.used) / pixels_.count();
  result.likeness = at.code_share.likeness();
  result.outcome =
      result.likeness > options.min_likeness ? DirectPose::Outcome::Converged : DirectPose::Outcome::Unlike;
  result.is_good = result.inlier_share >= options.good_inlier_share &&
                   result.likeness >= options.good_likeness && result.noise_grey <= options.good_noise_grey;
  return result;
}

}  // namespace arthronaut::markers
