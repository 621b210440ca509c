#include "navigation/markers/edge_profiles.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "navigation/markers/edge_kernel.h"
#include "navigation/markers/exposed_kernel.h"

namespace arthronaut::markers {
namespace {

using geometry::RigidTransform;

constexpr float kMinLikeness = 0.85F;
// Below this the model is wrong in ways that noise does not show: compression, debris, the lens.
constexpr double kOffsetFloorPx = 0.05;
// A smear by motion is no exact box: the hand does not move evenly.
constexpr double kOffsetPerBox = 0.04;
constexpr float kSharpBox = 1.5F;
constexpr float kPixelBox = 1.0F;

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
  return static_cast<int>(std::clamp(std::min(wanted, 0.75F * crossing.cell_px + 0.25F * crossing.box_px),
                                     2.0F, static_cast<float>(EdgeProfile::kMostWindow)));
}

// Its light, to `reach` samples on either side; gives how many are saturated, or kOutside.
constexpr int kOutside = -1;
int read_light(const LinearImage& image, const Crossing& crossing, double between_fields, int reach,
               float* light) {
  const Eigen::Vector2d first = crossing.point - reach * crossing.normal,
                        last = crossing.point + reach * crossing.normal;
  if (!image.contains(first.x(), first.y()) || !image.contains(last.x(), last.y())) return kOutside;
  int saturated = 0;
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
        return kOutside;
  }
  for (int i = 0; i <= 2 * reach; ++i, x += step_x, y += step_y) {
    if (between_fields == 0) {
      light[i] = image.sample(x, y);
    } else {
      const float even = image.sample_field(x - half_x, y - half_y, 0);
      const float odd = image.sample_field(x + half_x, y + half_y, 1);
      light[i] = even < 0 || odd < 0 ? -1 : 0.5F * (even + odd);
    }
    saturated += light[i] < 0;
  }
  return saturated;
}

void add_trend(const Crossing& crossing, const EdgeMatch& match, SmearTrend& trend) {
  if (crossing.box_px < kSharpBox) {
    trend.sigma_gain += match.sigma_gain;
    trend.sigma_weight += match.sigma_weight;
  }
  if (crossing.box_px <= kPixelBox) return;
  const Eigen::Vector2d direction =
      crossing.moves_backwards ? Eigen::Vector2d(-crossing.normal) : crossing.normal;
  trend.motion_gain += match.box_gain * direction;
  trend.motion_weight += match.box_weight * direction * direction.transpose();
}

}  // namespace

void measure_edges(const LinearImage& image, const camera::CameraModel& camera,
                   const RigidTransform& camera_from_marker, double size_mm, int cells,
                   std::span<const EdgeSample> samples, const Smear& smear, const ProfileOptions& options,
                   std::vector<EdgeMeasurement>& measurements, SmearTrend& trend) {
  measurements.clear();
  trend = SmearTrend();
  const Eigen::Matrix3d rotation = camera_from_marker.matrix();
  const auto match_profile = processor_has_avx2() ? match_edge_avx2 : match_edge;
  EdgeProfile profile;
  profile.sigma_px = static_cast<float>(smear.sigma_px);
  for (std::size_t k = 0; k < samples.size(); k += options.stride) {
    EdgeMeasurement& measurement = measurements.emplace_back();
    measurement.sample = static_cast<int>(k);
    Crossing crossing;
    if (!locate(camera, camera_from_marker, rotation, size_mm, cells, samples[k], smear, crossing)) continue;
    profile.reach = reach_of(crossing, smear.sigma_px);
    profile.search = std::min(options.search_px, EdgeProfile::kMostReach - profile.reach);
    const int reach = profile.reach + profile.search;
    const int saturated = read_light(image, crossing, smear.between_fields, reach, profile.light);
    if (saturated == kOutside) continue;
    measurement.point_px = crossing.point;
    measurement.normal = crossing.normal;
    measurement.box_px = crossing.box_px;
    measurement.moves_px = crossing.normal.dot(crossing.moves);
    if (saturated > reach) {
      measurement.state = EdgeState::Saturated;
      continue;
    }
    std::copy(samples[k].cells.begin(), samples[k].cells.end(), profile.cells);
    profile.cell_px = crossing.cell_px;
    profile.box_px = crossing.box_px;
    EdgeMatch match;
    match_profile(profile, match);
    measurement.contrast = match.gain;
    if (match.outcome != EdgeMatch::Outcome::Matched) {
      measurement.state = match.outcome == EdgeMatch::Outcome::Flat ? EdgeState::Flat : EdgeState::Different;
      continue;
    }
    measurement.likeness = match.likeness;
    measurement.offset_px = match.offset;
    measurement.sigma_px = std::hypot(static_cast<double>(match.sigma), kOffsetFloorPx,
                                      kOffsetPerBox * (crossing.box_px - kPixelBox));
    measurement.state = match.likeness >= kMinLikeness ? EdgeState::Found : EdgeState::Different;
    if (measurement.state == EdgeState::Found) add_trend(crossing, match, trend);
  }
}

}  // namespace arthronaut::markers
