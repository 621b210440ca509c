#include "navigation/markers/edge_profiles.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "navigation/markers/blurred_step.h"

namespace arthronaut::markers {
namespace {

using geometry::RigidTransform;

constexpr int kMaxReach = 26;  // samples to either side, search included
constexpr int kMaxProfile = 2 * kMaxReach + 1;
constexpr float kMinContrast = 3;  // in light of 255: what noise and compression leave
constexpr float kMinLikeness = 0.85F;
// Below this the model is wrong in ways that noise does not show: compression, debris, the lens.
constexpr double kOffsetFloorPx = 0.05;
// A smear by motion is no exact box: the hand does not move evenly.
constexpr double kOffsetPerBox = 0.04;
constexpr float kSharpBox = 1.5F;
constexpr float kPixelBox = 1.0F;

struct Profile {
  std::array<float, kMaxProfile> light;
  int reach = 0;  // light[reach] is at the predicted edge
  int saturated = 0;
};

// Everything about one sample that the image is not asked for.
struct Crossing {
  Eigen::Vector2d point, normal;
  float cell_px = 0;  // distance of neighbouring edges along the normal
  float box_px = kPixelBox;
  bool moves_backwards = false;                     // against the normal
  Eigen::Vector2d moves = Eigen::Vector2d::Zero();  // in the time between frames
};

bool locate(const camera::CameraModel& camera, const RigidTransform& pose, const Eigen::Matrix3d& rotation,
            double size_mm, int cells, const EdgeSample& sample, const Smear& smear, Crossing& crossing) {
  const Eigen::Vector3d place(sample.x * size_mm, sample.y * size_mm, 0);
  Eigen::Matrix<double, 2, 3> d_pixel;
  const auto point = camera.project(rotation * place + pose.translation_mm, d_pixel);
  if (!point || !camera.is_inside_view(*point)) return false;
  const Eigen::Matrix<double, 2, 3> d_marker = d_pixel * rotation;
  const Eigen::Vector2d across = d_marker.col(sample.axis), along = d_marker.col(1 - sample.axis);
  crossing.point = *point;
  crossing.normal = Eigen::Vector2d(-along.y(), along.x()).normalized();
  double px_per_mm = crossing.normal.dot(across);
  if (px_per_mm < 0) {
    crossing.normal = -crossing.normal;
    px_per_mm = -px_per_mm;
  }
  crossing.cell_px = static_cast<float>(px_per_mm * size_mm / cells);
  const Eigen::Vector3d moved = smear.motion.head<3>() + smear.motion.tail<3>().cross(place);
  const double motion_px = crossing.normal.dot(d_marker * moved);
  crossing.moves_backwards = motion_px < 0;
  crossing.box_px = std::max(kPixelBox, static_cast<float>(std::abs(motion_px)));
  crossing.moves =
      d_marker * (smear.interval_motion.head<3>() + smear.interval_motion.tail<3>().cross(place));
  return crossing.cell_px > 1.5F;
}

// As far as the neighbouring cells are known, and no farther than the step needs.
int reach_of(const Crossing& crossing, double sigma_px) {
  const float wanted = 0.5F * crossing.box_px + 3 * static_cast<float>(sigma_px) + 1;
  return static_cast<int>(
      std::clamp(std::min(wanted, 0.75F * crossing.cell_px + 0.25F * crossing.box_px), 2.0F, 16.0F));
}

bool read_profile(const LinearImage& image, const Crossing& crossing, double between_fields, int reach,
                  Profile& profile) {
  const Eigen::Vector2d first = crossing.point - reach * crossing.normal,
                        last = crossing.point + reach * crossing.normal;
  if (!image.contains(first.x(), first.y()) || !image.contains(last.x(), last.y())) return false;
  profile.reach = reach;
  profile.saturated = 0;
  auto x = static_cast<float>(first.x()), y = static_cast<float>(first.y());
  const auto step_x = static_cast<float>(crossing.normal.x()),
             step_y = static_cast<float>(crossing.normal.y());
  // The odd field is later by this much of the way; the mean of both is of the moment between them.
  const Eigen::Vector2d apart = between_fields * crossing.moves;
  const auto half_x = static_cast<float>(0.5 * apart.x()), half_y = static_cast<float>(0.5 * apart.y());
  if (between_fields != 0) {
    const Eigen::Vector2d room = 0.5 * apart.cwiseAbs() + Eigen::Vector2d(0, 2);
    for (const Eigen::Vector2d& end : {first, last})
      if (!image.contains(end.x() - room.x(), end.y() - room.y()) ||
          !image.contains(end.x() + room.x(), end.y() + room.y()))
        return false;
  }
  for (int i = 0; i <= 2 * reach; ++i, x += step_x, y += step_y) {
    if (between_fields == 0) {
      profile.light[i] = image.sample(x, y);
    } else {
      const float even = image.sample_field(x - half_x, y - half_y, 0);
      const float odd = image.sample_field(x + half_x, y + half_y, 1);
      profile.light[i] = even < 0 || odd < 0 ? -1 : 0.5F * (even + odd);
    }
    profile.saturated += profile.light[i] < 0;
  }
  return true;
}

struct Model {
  std::array<float, kMaxProfile> level, slope;
};
// How it changes with what smears it.
struct ModelTrend {
  std::array<float, kMaxProfile> d_sigma, d_box;
};

// The light of the four cells along the normal, dark 0 and bright 1, with the middle edge at `offset`.
void model_profile(const EdgeSample& sample, const Crossing& crossing, const BlurredStep& step, float offset,
                   int reach, Model& model) {
  const int count = 2 * reach + 1;
  std::fill_n(model.level.begin(), count, sample.cells[0]);
  std::fill_n(model.slope.begin(), count, 0.0F);
  for (int edge = 0; edge < 3; ++edge) {
    const float rise = sample.cells[edge + 1] - sample.cells[edge];
    if (rise == 0) continue;
    const float first = static_cast<float>(-reach) - offset - static_cast<float>(edge - 1) * crossing.cell_px;
    for (int i = 0; i < count; ++i) {
      const auto value = step.at(first + static_cast<float>(i));
      model.level[i] += rise * value.level;
      model.slope[i] += rise * value.slope;
    }
  }
}

void model_trend(const EdgeSample& sample, const Crossing& crossing, const BlurredStep& step, float offset,
                 int reach, ModelTrend& trend) {
  const int count = 2 * reach + 1;
  std::fill_n(trend.d_sigma.begin(), count, 0.0F);
  std::fill_n(trend.d_box.begin(), count, 0.0F);
  for (int edge = 0; edge < 3; ++edge) {
    const float rise = sample.cells[edge + 1] - sample.cells[edge];
    if (rise == 0) continue;
    const float first = static_cast<float>(-reach) - offset - static_cast<float>(edge - 1) * crossing.cell_px;
    for (int i = 0; i < count; ++i) {
      const auto value = step.trend_at(first + static_cast<float>(i));
      trend.d_sigma[i] += rise * value.d_sigma;
      trend.d_box[i] += rise * value.d_box;
    }
  }
}

// Correlation of the model with the profile shifted by whole pixels; saturated samples are left out.
float likeness_at(const Profile& profile, const Model& model, int reach, int shift) {
  float n = 0, sum_i = 0, sum_m = 0, sum_ii = 0, sum_mm = 0, sum_im = 0;
  const float* light = profile.light.data() + profile.reach - reach + shift;
  for (int i = 0; i <= 2 * reach; ++i) {
    const float value = light[i];
    if (value < 0) continue;
    const float m = model.level[i];
    n += 1;
    sum_i += value;
    sum_m += m;
    sum_ii += value * value;
    sum_mm += m * m;
    sum_im += value * m;
  }
  if (n < 4) return -1;
  const float spread = (sum_ii - sum_i * sum_i / n) * (sum_mm - sum_m * sum_m / n);
  return spread > 1e-6F ? (sum_im - sum_i * sum_m / n) / std::sqrt(spread) : -1;
}

struct Match {
  float gain = 0, bias = 0, offset = 0, sigma = 0, likeness = -1;
  float modelled_offset = 0;  // that of the model
  bool is_good = false;
};

// Gain, bias and offset by Gauss-Newton. The model must hold the offset that it starts from.
Match match_finely(const Profile& profile, const EdgeSample& sample, const Crossing& crossing,
                   const BlurredStep& step, float start, int reach, Model& model) {
  Match match;
  match.offset = start;
  const float* light = profile.light.data() + profile.reach - reach;
  float residual_square = 0, slope_square = 0;
  int used = 0;
  for (int iteration = 0; iteration < 3; ++iteration) {
    model_profile(sample, crossing, step, match.offset, reach, model);
    match.modelled_offset = match.offset;
    Eigen::Matrix3f normal = Eigen::Matrix3f::Zero();
    Eigen::Vector3f right = Eigen::Vector3f::Zero();
    used = 0;
    for (int i = 0; i <= 2 * reach; ++i) {
      if (light[i] < 0) continue;
      ++used;
      const float m = model.level[i], s = -model.slope[i];
      normal(0, 0) += m * m;
      normal(0, 1) += m;
      normal(0, 2) += m * s;
      normal(1, 2) += s;
      normal(2, 2) += s * s;
      right[0] += m * light[i];
      right[1] += light[i];
      right[2] += s * light[i];
    }
    normal(1, 1) = static_cast<float>(used);
    normal(1, 0) = normal(0, 1);
    normal(2, 0) = normal(0, 2);
    normal(2, 1) = normal(1, 2);
    if (used < 5) return match;
    const Eigen::Matrix3f inverse = normal.inverse();
    const Eigen::Vector3f solution = inverse * right;
    if (!solution.allFinite()) return match;
    match.gain = solution[0];
    match.bias = solution[1];
    if (!(match.gain > kMinContrast)) return match;
    const float shift = std::clamp(solution[2] / match.gain, -1.5F, 1.5F);
    match.offset += shift;
    if (std::abs(match.offset - start) > 2.5F) return match;
    slope_square = 1 / std::max(inverse(2, 2), 1e-9F);
    if (std::abs(shift) < 0.01F || iteration == 2) break;
  }
  for (int i = 0; i <= 2 * reach; ++i) {
    if (light[i] < 0) continue;
    const float residual = light[i] - match.gain * model.level[i] - match.bias;
    residual_square += residual * residual;
  }
  const float variance = residual_square / static_cast<float>(used - 3 > 0 ? used - 3 : 1);
  match.sigma = std::sqrt(variance / slope_square) / match.gain;
  match.likeness = likeness_at(profile, model, reach, 0);
  match.is_good = true;
  return match;
}

void add_trend(const Profile& profile, const EdgeSample& sample, const Crossing& crossing,
               const BlurredStep& step, const Match& match, const Model& model, int reach,
               SmearTrend& trend) {
  ModelTrend changes;
  model_trend(sample, crossing, step, match.modelled_offset, reach, changes);
  const float* light = profile.light.data() + profile.reach - reach;
  double box_gain = 0, box_weight = 0;
  for (int i = 0; i <= 2 * reach; ++i) {
    if (light[i] < 0) continue;
    const float residual = (light[i] - match.bias) / match.gain - model.level[i];
    if (crossing.box_px < kSharpBox) {
      trend.sigma_gain += residual * changes.d_sigma[i];
      trend.sigma_weight += changes.d_sigma[i] * changes.d_sigma[i];
    }
    box_gain += residual * changes.d_box[i];
    box_weight += changes.d_box[i] * changes.d_box[i];
  }
  if (crossing.box_px <= kPixelBox) return;
  const Eigen::Vector2d direction =
      crossing.moves_backwards ? Eigen::Vector2d(-crossing.normal) : crossing.normal;
  trend.motion_gain += box_gain * direction;
  trend.motion_weight += box_weight * direction * direction.transpose();
}

}  // namespace

void measure_edges(const LinearImage& image, const camera::CameraModel& camera,
                   const RigidTransform& camera_from_marker, double size_mm, int cells,
                   std::span<const EdgeSample> samples, const Smear& smear, const ProfileOptions& options,
                   std::vector<EdgeMeasurement>& measurements, SmearTrend& trend) {
  measurements.clear();
  trend = SmearTrend();
  const Eigen::Matrix3d rotation = camera_from_marker.matrix();
  Profile profile;
  Model model;
  for (std::size_t k = 0; k < samples.size(); k += options.stride) {
    EdgeMeasurement& measurement = measurements.emplace_back();
    measurement.sample = static_cast<int>(k);
    Crossing crossing;
    if (!locate(camera, camera_from_marker, rotation, size_mm, cells, samples[k], smear, crossing)) continue;
    const int reach = reach_of(crossing, smear.sigma_px);
    const int search = std::min(options.search_px, kMaxReach - reach);
    if (!read_profile(image, crossing, smear.between_fields, reach + search, profile)) continue;
    measurement.point_px = crossing.point;
    measurement.normal = crossing.normal;
    measurement.box_px = crossing.box_px;
    measurement.moves_px = crossing.normal.dot(crossing.moves);
    if (profile.saturated > profile.reach) {
      measurement.state = EdgeState::Saturated;
      continue;
    }

    const BlurredStep step(crossing.box_px, smear.sigma_px);
    int best_shift = 0;
    if (search > 0) {
      model_profile(samples[k], crossing, step, 0, reach, model);
      float best = -2;
      for (int shift = -search; shift <= search; ++shift) {
        const float likeness = likeness_at(profile, model, reach, shift);
        // Of two alike, the nearer.
        if (likeness > best + 0.02F || (likeness > best && std::abs(shift) <= std::abs(best_shift))) {
          best = likeness;
          best_shift = shift;
        }
      }
      if (std::abs(best_shift) == search) {
        measurement.state = EdgeState::Different;
        continue;
      }
    }
    // The fine match looks at the window around the best shift.
    if (search > 0) {
      const auto first = profile.light.begin() + search + best_shift;
      std::copy(first, first + 2 * reach + 1, profile.light.begin());
      profile.reach = reach;
    }
    const Match match = match_finely(profile, samples[k], crossing, step, 0, reach, model);
    measurement.contrast = match.gain;
    measurement.likeness = match.likeness;
    if (!match.is_good) {
      measurement.state = std::abs(match.gain) <= kMinContrast ? EdgeState::Flat : EdgeState::Different;
      continue;
    }
    measurement.offset_px = match.offset + best_shift;
    measurement.sigma_px = std::hypot(static_cast<double>(match.sigma), kOffsetFloorPx,
                                      kOffsetPerBox * (crossing.box_px - kPixelBox));
    measurement.state = match.likeness >= kMinLikeness ? EdgeState::Found : EdgeState::Different;
    if (measurement.state == EdgeState::Found)
      add_trend(profile, samples[k], crossing, step, match, model, reach, trend);
  }
}

}  // namespace arthronaut::markers
