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

// What the two lines at the ends of a cell make of the three cells along one axis: each line lets the next
// cell in by the share of the smear that reaches over it. `place` counts cells from the first line.
struct Shares {
  float level[2], by_place[2], by_smear[2];
};

inline Shares shares_of(float place, float scale) {
  Shares shares;
  for (int line = 0; line < 2; ++line) {
    const float z = (place - static_cast<float>(line)) * scale;
    const Normal at = normal_at(z);
    shares.level[line] = at.cumulative;
    shares.by_place[line] = at.density * scale;
    shares.by_smear[line] = -z * at.density;
  }
  return shares;
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
  const bool is_near_column = std::min(beside, 1 - beside) * scale_x < kReach;
  const bool is_near_row = std::min(below, 1 - below) * scale_y < kReach;
  Blurred result;
  if (is_near_column && is_near_row) {
    const Shares across = shares_of(beside, scale_x), down = shares_of(below, scale_y);
    float level_above = 0, by_column_above = 0, by_smear_above = 0;
    for (int k = 0; k < 3; ++k) {
      const float* cell = &bright_[(r + 1 + k) * width_ + c + 1];
      const float rises[2] = {cell[1] - cell[0], cell[2] - cell[1]};
      const auto mixed = [&rises](const float* shares) {
        return shares[0] * rises[0] + shares[1] * rises[1];
      };
      const float level = cell[0] + mixed(across.level);
      const float by_column = mixed(across.by_place), by_smear = mixed(across.by_smear);
      if (k == 0) {
        result.level = level;
        result.by_column = by_column;
        result.by_smear = by_smear;
      } else {
        const float rise = level - level_above;
        result.level += down.level[k - 1] * rise;
        result.by_row += down.by_place[k - 1] * rise;
        result.by_column += down.level[k - 1] * (by_column - by_column_above);
        result.by_smear += down.level[k - 1] * (by_smear - by_smear_above) + down.by_smear[k - 1] * rise;
      }
      level_above = level;
      by_column_above = by_column;
      by_smear_above = by_smear;
    }
    return result;
  }
  // Near the lines of one axis alone, as most pixels are, or far from every line: three cells in a row, and
  // of their two lines those that part dark from bright.
  const float* cell = &bright_[(r + 2) * width_ + c + 2];
  result.level = *cell;
  if (!is_near_column && !is_near_row) return result;
  const int next = is_near_column ? 1 : width_;
  const float place = is_near_column ? beside : below, scale = is_near_column ? scale_x : scale_y;
  float slope = 0;
  result.level = cell[-next];
  for (int line = 0; line < 2; ++line) {
    const float rise = cell[line * next] - cell[(line - 1) * next];
    if (rise == 0) continue;
    const float z = (place - static_cast<float>(line)) * scale;
    const Normal at = normal_at(z);
    result.level += rise * at.cumulative;
    slope += rise * at.density * scale;
    result.by_smear -= rise * z * at.density;
  }
  (is_near_column ? result.by_column : result.by_row) = slope;
  return result;
}

ExposedCode::Level ExposedCode::at(const Eigen::Vector3f& ray, float sigma_x, float sigma_y) const {
  Level mean;
  const float middle = 0.5F * static_cast<float>(cells_);
  // In the plane: along x, along y, about the normal; out of it: along the normal, about x, about y.
  Eigen::Vector4f in_plane = Eigen::Vector4f::Zero(), out_of_plane = Eigen::Vector4f::Zero();
  Eigen::Vector4f by_velocity = Eigen::Vector4f::Zero(), by_change = Eigen::Vector4f::Zero();
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
    const Eigen::Vector4f moved(gx, gy, gy * x - gx * y, 0);
    in_plane += moved;
    by_velocity += moment.time * moved;
    by_change += 0.5F * moment.time * moment.time * moved;
    out_of_plane += gz * Eigen::Vector4f(1, y, -x, 0);
  }
  const float share = 1 / static_cast<float>(moment_count_);
  mean.level *= share;
  mean.by_smear *= share;
  mean.by_pose.head<2>() = share * in_plane.head<2>();
  mean.by_pose.segment<3>(2) = share * out_of_plane.head<3>();
  mean.by_pose[5] = share * in_plane[2];
  mean.by_velocity = share * by_velocity.head<3>();
  mean.by_change = share * by_change.head<3>();
  return mean;
}

}  // namespace arthronaut::markers
