#include "planning/segmentation/joint_space.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "planning/images/voxel_mask.h"

namespace arthronaut::segmentation {

namespace {

constexpr double kStep_mm = 2, kHeightStep_mm = 1;
// A plate of bone lies so near to the space on both sides.
constexpr int kPlateWithin = 9;
// Of a valley; more is the noise of very bright plates.
constexpr float kDeepest_hu = 500;
// Below this it is trabecular bone, not a joint.
constexpr float kSeen_hu = 80;
// Of both compartments a knee shows well over 10 cm^2.
constexpr double kLeastArea_mm2 = 500;
// How far from level the sheet may run, and what a step of it costs.
constexpr int kReach = 14;
constexpr float kCostPerStep_hu = 30;
// Lines of columns hold each other from the first sweep to this one more and more: held at once, a valley a
// step beside the level is left out, since no line leaves the level alone.
constexpr int kSweeps = 8, kHeldFromSweep = 4;

struct Columns {
  Eigen::Vector3d low_mm;
  int nx = 0, ny = 0, nz = 0;
  std::vector<float> grey;  // z fastest

  [[nodiscard]] std::size_t column(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(x)) *
           static_cast<std::size_t>(nz);
  }
};

Columns resampled(const images::Volume& volume, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  Columns columns;
  columns.low_mm = low;
  const Eigen::Vector3d size = high - low;
  columns.nx = 1 + static_cast<int>(size.x() / kStep_mm);
  columns.ny = 1 + static_cast<int>(size.y() / kStep_mm);
  columns.nz = 1 + static_cast<int>(size.z() / kHeightStep_mm);
  const Eigen::Affine3d index_from_lps = volume.lps_from_index.inverse();
  const Eigen::Vector3d last = (volume.size.array() - 1).cast<double>();
  columns.grey.reserve(static_cast<std::size_t>(columns.nx) * static_cast<std::size_t>(columns.ny) *
                       static_cast<std::size_t>(columns.nz));
  for (int y = 0; y < columns.ny; ++y) {
    for (int x = 0; x < columns.nx; ++x) {
      for (int z = 0; z < columns.nz; ++z) {
        const Eigen::Vector3d p =
            (index_from_lps * (low + Eigen::Vector3d(x * kStep_mm, y * kStep_mm, z * kHeightStep_mm)))
                .cwiseMax(0)
                .cwiseMin(last);
        const Eigen::Vector3i a = p.array().floor().cast<int>(),
                              b = (a.array() + 1).min(volume.size.array() - 1);
        const Eigen::Vector3d f = p - a.cast<double>();
        const auto line = [&](int j, int k) {
          return (1 - f.x()) * volume.at(a.x(), j, k) + f.x() * volume.at(b.x(), j, k);
        };
        const auto plane = [&](int k) { return (1 - f.y()) * line(a.y(), k) + f.y() * line(b.y(), k); };
        columns.grey.push_back(static_cast<float>((1 - f.z()) * plane(a.z()) + f.z() * plane(b.z())));
      }
    }
  }
  return columns;
}

// How much darker each point is than the less bright of the plates above and below it.
std::vector<float> valley_depths(const Columns& columns, float threshold) {
  std::vector<float> depths(columns.grey.size(), 0.0F);
  const int n = columns.nz;
  for (std::size_t start = 0; start < columns.grey.size(); start += static_cast<std::size_t>(n)) {
    const float* grey = columns.grey.data() + start;
    for (int z = 1; z + 1 < n; ++z) {
      const float above = *std::max_element(grey + z + 1, grey + std::min(n, z + 1 + kPlateWithin)),
                  below = *std::max_element(grey + std::max(0, z - kPlateWithin), grey + z),
                  plate = std::min(above, below);
      if (plate < threshold) continue;
      depths[start + static_cast<std::size_t>(z)] = std::clamp(plate - grey[z], 0.0F, kDeepest_hu);
    }
  }
  return depths;
}

// The height at which most of the joint is seen.
int level_of(const Columns& columns, const std::vector<float>& depths) {
  std::vector<double> seen(static_cast<std::size_t>(columns.nz), 0);
  for (std::size_t v = 0; v < depths.size(); ++v)
    seen[v % seen.size()] += depths[v] > kSeen_hu ? depths[v] : 0;
  int best = 0;
  double most = -1;
  constexpr int kWindow = 4;
  for (int z = kWindow; z + kWindow < columns.nz; ++z) {
    double sum = 0;
    for (int d = -kWindow; d <= kWindow; ++d) sum += seen[static_cast<std::size_t>(z + d)];
    if (sum > most) {
      most = sum;
      best = z;
    }
  }
  return best;
}

// One line of columns: the best heights, given the lines beside it (dynamic programming over the heights).
void improve_line(std::vector<int>& heights, const std::vector<float>& gains, int lowest, int highest) {
  const int n = static_cast<int>(heights.size()), m = highest - lowest + 1;
  std::vector<float> best(static_cast<std::size_t>(n) * static_cast<std::size_t>(m));
  std::vector<int> from(best.size(), 0);
  const auto at = [m](int i, int h) {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(m) + static_cast<std::size_t>(h);
  };
  for (int h = 0; h < m; ++h) best[at(0, h)] = gains[at(0, h)];
  for (int i = 1; i < n; ++i) {
    for (int h = 0; h < m; ++h) {
      float most = -std::numeric_limits<float>::infinity();
      for (int g = std::max(0, h - 4); g <= std::min(m - 1, h + 4); ++g) {
        const float value = best[at(i - 1, g)] - kCostPerStep_hu * static_cast<float>(std::abs(h - g));
        if (value > most) {
          most = value;
          from[at(i, h)] = g;
        }
      }
      best[at(i, h)] = most + gains[at(i, h)];
    }
  }
  int h = 0;
  for (int g = 1; g < m; ++g) {
    if (best[at(n - 1, g)] > best[at(n - 1, h)]) h = g;
  }
  for (int i = n - 1; i >= 0; --i) {
    heights[static_cast<std::size_t>(i)] = lowest + h;
    h = from[at(i, h)];
  }
}

}  // namespace

JointSpace::Sheet JointSpace::at(double x_mm, double y_mm) const {
  const double x = std::clamp((x_mm - first_mm.x()) / step_mm, 0.0, columns - 1.0),
               y = std::clamp((y_mm - first_mm.y()) / step_mm, 0.0, rows - 1.0);
  const int column = std::min(static_cast<int>(x), columns - 2),
            row = std::min(static_cast<int>(y), rows - 2);
  const auto first = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                     static_cast<std::size_t>(column),
             next = first + static_cast<std::size_t>(columns);
  const auto between = [&](std::size_t at) {
    return std::lerp(height_mm[at], height_mm[at + 1], x - column);
  };
  return {
      std::lerp(between(first), between(next), y - row),
      std::max({from_seen_mm[first], from_seen_mm[first + 1], from_seen_mm[next], from_seen_mm[next + 1]})};
}

std::optional<JointSpace> find_joint_space(const images::Volume& volume, const Eigen::Vector3d& low_mm,
                                           const Eigen::Vector3d& high_mm, double threshold) {
  const Columns columns = resampled(volume, low_mm, high_mm);
  if (columns.nx < 5 || columns.ny < 5 || columns.nz < 2 * kPlateWithin) return std::nullopt;
  const std::vector<float> depths = valley_depths(columns, static_cast<float>(threshold));
  const int level = level_of(columns, depths);
  const int lowest = std::max(1, level - kReach), highest = std::min(columns.nz - 2, level + kReach);
  std::vector<int> heights(static_cast<std::size_t>(columns.nx) * static_cast<std::size_t>(columns.ny),
                           level);
  const auto index = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns.nx) + static_cast<std::size_t>(x);
  };
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    const bool along_x = sweep % 2 == 0;
    const float cost_hu = kCostPerStep_hu * std::min(1.0F, static_cast<float>(sweep) / kHeldFromSweep);
    const int lines = along_x ? columns.ny : columns.nx, length = along_x ? columns.nx : columns.ny;
    for (int line = 0; line < lines; ++line) {
      const auto cell = [&](int i, int l) { return along_x ? index(i, l) : index(l, i); };
      std::vector<int> here(static_cast<std::size_t>(length));
      std::vector<float> gains;
      for (int i = 0; i < length; ++i) {
        const std::size_t start = along_x ? columns.column(i, line) : columns.column(line, i);
        for (int h = lowest; h <= highest; ++h) {
          float gain = depths[start + static_cast<std::size_t>(h)];
          for (const int beside : {line - 1, line + 1}) {
            if (beside < 0 || beside >= lines) continue;
            gain -= cost_hu * static_cast<float>(std::abs(h - heights[cell(i, beside)]));
          }
          gains.push_back(gain);
        }
      }
      improve_line(here, gains, lowest, highest);
      for (int i = 0; i < length; ++i) heights[cell(i, line)] = here[static_cast<std::size_t>(i)];
    }
  }
  JointSpace space;
  space.first_mm = low_mm.head<2>();
  space.step_mm = kStep_mm;
  space.columns = columns.nx;
  space.rows = columns.ny;
  std::vector<std::size_t> seen;
  for (int y = 0; y < columns.ny; ++y) {
    for (int x = 0; x < columns.nx; ++x) {
      const int h = heights[index(x, y)];
      const bool is_seen = depths[columns.column(x, y) + static_cast<std::size_t>(h)] > kSeen_hu;
      if (is_seen) seen.push_back(index(x, y));
      space.height_mm.push_back(low_mm.z() + h * kHeightStep_mm);
    }
  }
  space.area_mm2 = kStep_mm * kStep_mm * static_cast<double>(seen.size());
  if (space.area_mm2 < kLeastArea_mm2) return std::nullopt;
  space.from_seen_mm =
      images::distances_mm({columns.nx, columns.ny, 1}, seen, Eigen::Vector3d::Constant(kStep_mm));
  return space;
}

}  // namespace arthronaut::segmentation
