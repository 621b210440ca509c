#include "navigation/contour/edge_search.h"

#include <algorithm>
#include <cmath>

namespace arthronaut::contour {

namespace {

constexpr int kSide = 4;  // steps on each side of an edge whose means are compared
constexpr int kSamples = kPlaces + 2 * kSide;
constexpr int kAcross = 3;  // samples to each side along the outline
constexpr double kAcrossStep_mm = 0.12;
constexpr float kDark = 10;  // luma: what noise and blacks of the sensor make of nothing
constexpr float kClearContrast =
    0.12f;  // of the means' difference to their sum: below it an edge counts less
constexpr float kBlownOut = 250;
constexpr double kRim_px = 8;

double distance_px(const Covered& covered, const Eigen::Vector2d& at) {
  const Eigen::Vector2d along = covered.b_px - covered.a_px;
  const double squared = along.squaredNorm();
  const double share = squared > 0 ? std::clamp((at - covered.a_px).dot(along) / squared, 0.0, 1.0) : 0.0;
  return (at - covered.a_px - share * along).norm();
}

}  // namespace

bool is_free(const camera::CameraModel& camera, std::span<const Covered> covered,
             const Eigen::Vector2d& at_px) {
  const Eigen::Vector2i& size_px = camera.image_size_px();
  if (at_px.x() < 2 || at_px.y() < 2 || at_px.x() > size_px.x() - 3 || at_px.y() > size_px.y() - 3)
    return false;
  const camera::Boundary& rim = camera.boundary();
  if (rim.radius_px > 0 && (at_px - rim.center_px).norm() > rim.radius_px - kRim_px) return false;
  return std::none_of(covered.begin(), covered.end(),
                      [&](const Covered& c) { return distance_px(c, at_px) < c.radius_px; });
}

std::optional<EdgeProfile> edge_profile(const camera::GrayView& luma, const camera::CameraModel& camera,
                                        const geometry::RigidTransform& camera_from_bone,
                                        const ContourPoint& point, std::span<const Covered> covered) {
  constexpr double kReach_mm = (kSteps + kSide) * kStep_mm;
  const Eigen::Vector3d at = camera_from_bone * point.in_bone_mm;
  const Eigen::Vector3d normal = camera_from_bone.rotate(point.normal_in_bone);
  const auto inner = camera.project(at - kReach_mm * normal), outer = camera.project(at + kReach_mm * normal),
             middle = camera.project(at);
  if (!inner || !outer || !middle) return std::nullopt;
  for (const Eigen::Vector2d& place : {*inner, *outer, *middle, Eigen::Vector2d(0.5 * (*inner + *middle)),
                                       Eigen::Vector2d(0.5 * (*outer + *middle))})
    if (!is_free(camera, covered, place)) return std::nullopt;
  const Eigen::Vector2d step = (*outer - *inner) / (kSamples - 1);
  const double px_per_mm = step.norm() / kStep_mm;
  if (!(px_per_mm > 3)) return std::nullopt;  // too far off for a tenth of a millimetre to be seen
  const Eigen::Vector2d across =
      Eigen::Vector2d(-step.y(), step.x()).normalized() * px_per_mm * kAcrossStep_mm;

  std::array<float, kSamples + 1> sum;  // of the means along the outline, up to a place
  sum[0] = 0;
  int blown_out = 0;
  for (int i = 0; i < kSamples; ++i) {
    const Eigen::Vector2d here = *inner + i * step;
    float total = 0;
    for (int k = -kAcross; k <= kAcross; ++k) {
      const Eigen::Vector2d sample = here + k * across;
      const int x = std::clamp(static_cast<int>(sample.x() + 0.5), 0, luma.width - 1),
                y = std::clamp(static_cast<int>(sample.y() + 0.5), 0, luma.height - 1);
      total += static_cast<float>(luma.row(y)[x]);
    }
    total /= 2 * kAcross + 1;
    blown_out += total > kBlownOut;
    sum[static_cast<std::size_t>(i) + 1] = sum[static_cast<std::size_t>(i)] + total;
  }
  if (blown_out > kSamples / 8) return std::nullopt;

  EdgeProfile profile;
  profile.normal_in_bone = point.normal_in_bone.cast<float>();
  float strongest = kClearContrast, mean = 0;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    const float inside = (sum[i + kSide] - sum[i]) / kSide;
    const float outside = (sum[i + 2 * kSide + 1] - sum[i + kSide + 1]) / kSide;
    profile.strength[i] = std::abs(outside - inside) / (outside + inside + 2 * kDark);
    strongest = std::max(strongest, profile.strength[i]);
  }
  for (float& strength : profile.strength) {
    strength /= strongest;
    mean += strength / kPlaces;
  }
  for (float& strength : profile.strength) strength -= mean;
  return profile;
}

}  // namespace arthronaut::contour
