#include "navigation/markers/exposed_code.h"

#include <algorithm>
#include <cmath>

namespace arthronaut::markers {
namespace {

// The normal distribution by table: exact to 1e-3, at a fifth of the price.
struct Normal {
  float density, cumulative;
};
constexpr float kReach = 3.5F;
constexpr int kSteps = 32;  // to a sigma
constexpr int kEntries = static_cast<int>(2 * kReach * kSteps) + 2;
const std::array<Normal, kEntries> kNormal = [] {
  std::array<Normal, kEntries> entries{};
  for (int i = 0; i < kEntries; ++i) {
    const double at = -kReach + static_cast<double>(i) / kSteps;
    entries[i] = {static_cast<float>(std::exp(-0.5 * at * at) / std::sqrt(2 * geometry::kPi)),
                  static_cast<float>(0.5 * std::erfc(-at / std::sqrt(2.0)))};
  }
  return entries;
}();

inline Normal normal_at(float x) {
  if (x <= -kReach) return {0, 0};
  if (x >= kReach) return {0, 1};
  const float place = (x + kReach) * kSteps;
  const auto below = static_cast<int>(place);
  const float share = place - static_cast<float>(below);
  const Normal &a = kNormal[below], &b = kNormal[below + 1];
  return {a.density + share * (b.density - a.density), a.cumulative + share * (b.cumulative - a.cumulative)};
}

// Shares of the cells before, here and after in a place smeared along one axis, and their derivatives by the
// place and by the logarithm of sigma. `place` counts cells from the line before.
struct Shares {
  float share[3], by_place[3], by_smear[3];
};

inline Shares shares_of(float place, float scale) {
  const float z0 = place * scale, z1 = (place - 1) * scale;
  const Normal first = normal_at(z0), second = normal_at(z1);
  const float d0 = first.density * scale, d1 = second.density * scale;
  const float s0 = -z0 * first.density, s1 = -z1 * second.density;
  return {{1 - first.cumulative, first.cumulative - second.cumulative, second.cumulative},
          {-d0, d0 - d1, d1},
          {-s0, s0 - s1, s1}};
}

}  // namespace

ExposedCode::ExposedCode(const MarkerCode& code, double size_mm)
    : cells_(code.cells), width_(code.cells + 4), cells_per_mm_(static_cast<float>(code.cells / size_mm)) {
  for (int row = 0; row < width_; ++row) {
    for (int column = 0; column < width_; ++column) {
      const int r = row - 2, c = column - 2;
      const bool is_inside = r >= 0 && c >= 0 && r < cells_ && c < cells_;
      bright_[row * width_ + column] = !is_inside || code.is_bright(r, c) ? 1.0F : 0.0F;
    }
  }
}

void ExposedCode::move(const ExposedPose& pose, int moment_count) {
  moment_count_ = std::clamp(moment_count, 1, kMaxMoments);
  for (int k = 0; k < moment_count_; ++k) {
    Moment& moment = moments_[k];
    const double time = (k + 0.5) / moment_count_ - 0.5;
    const geometry::RigidTransform marker_from_camera =
        (pose.camera_from_marker * geometry::exp(time * pose.velocity + 0.5 * time * time * pose.change))
            .inverse();
    moment.time = static_cast<float>(time);
    moment.marker_from_camera = marker_from_camera.matrix().cast<float>();
    moment.eye = marker_from_camera.translation_mm.cast<float>();
  }
}

ExposedCode::Blurred ExposedCode::blurred(float column, float row, float sigma_x, float sigma_y) const {
  const auto last = static_cast<float>(cells_);
  const auto c = static_cast<int>(std::clamp(column, -1.0F, last + 0.99F) + 1) - 1;
  const auto r = static_cast<int>(std::clamp(row, -1.0F, last + 0.99F) + 1) - 1;
  const float beside = column - static_cast<float>(c), below = row - static_cast<float>(r);
  const float scale_x = 1 / sigma_x, scale_y = 1 / sigma_y;
  Blurred result;
  // Far from every line there is nothing but the cell.
  if (std::min(beside, 1 - beside) * scale_x >= kReach && std::min(below, 1 - below) * scale_y >= kReach) {
    result.level = bright_[(r + 2) * width_ + c + 2];
    return result;
  }
  const Shares across = shares_of(beside, scale_x), down = shares_of(below, scale_y);
  for (int k = 0; k < 3; ++k) {
    const float* cell = &bright_[(r + 1 + k) * width_ + c + 1];
    const auto mixed = [cell](const float* shares) {
      return shares[0] * cell[0] + shares[1] * cell[1] + shares[2] * cell[2];
    };
    const float level = mixed(across.share);
    result.level += down.share[k] * level;
    result.by_column += down.share[k] * mixed(across.by_place);
    result.by_row += down.by_place[k] * level;
    result.by_smear += down.share[k] * mixed(across.by_smear) + down.by_smear[k] * level;
  }
  return result;
}

ExposedCode::Level ExposedCode::at(const Eigen::Vector3f& ray, float sigma_x, float sigma_y) const {
  Level mean;
  const float middle = 0.5F * static_cast<float>(cells_);
  for (int k = 0; k < moment_count_; ++k) {
    const Moment& moment = moments_[k];
    const Eigen::Vector3f direction = moment.marker_from_camera * ray;
    const float along = -moment.eye.z() / direction.z();
    const float dx = along * direction.x(), dy = along * direction.y();
    const float x = moment.eye.x() + dx, y = moment.eye.y() + dy;
    const Blurred here = blurred(x * cells_per_mm_ + middle, middle - y * cells_per_mm_, sigma_x, sigma_y);
    mean.level += here.level;
    if (here.by_column == 0 && here.by_row == 0) continue;
    mean.by_smear += here.by_smear;
    // When the marker moves, the ray wanders over the code the other way; what moves along the normal or
    // tilts moves along the line of sight.
    const float gx = -here.by_column * cells_per_mm_, gy = here.by_row * cells_per_mm_;
    const float gz = (gx * dx + gy * dy) / moment.eye.z();
    const float turned = gy * x - gx * y;
    mean.by_pose[0] += gx;
    mean.by_pose[1] += gy;
    mean.by_pose[2] += gz;
    mean.by_pose[3] += gz * y;
    mean.by_pose[4] -= gz * x;
    mean.by_pose[5] += turned;
    const Eigen::Vector3f in_plane(gx, gy, turned);
    mean.by_velocity += moment.time * in_plane;
    mean.by_change += 0.5F * moment.time * moment.time * in_plane;
  }
  const float share = 1 / static_cast<float>(moment_count_);
  mean.level *= share;
  mean.by_smear *= share;
  mean.by_pose *= share;
  mean.by_velocity *= share;
  mean.by_change *= share;
  return mean;
}

}  // namespace arthronaut::markers
