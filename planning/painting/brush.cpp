#include "planning/painting/brush.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace arthronaut::painting {

namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

// Ties between two layers go to one of them.
constexpr double kTie_mm = 1e-9;

}  // namespace

void paint(Labels& labels, const images::Volume& grid, const BrushMove& move, std::uint8_t label,
           LabelChange& change) {
  const Eigen::Affine3d index_from_lps = grid.lps_from_index.inverse();
  const double radius = move.brush.radius_mm;
  // How far a voxel reaches along the normal: those nearer than this are met by the slice.
  const double half_mm = 0.5 * (grid.lps_from_index.linear().transpose() * move.normal).cwiseAbs().sum();
  // How far the brush reaches along each axis of the grid: a disc's slice is one layer of it.
  const Eigen::Matrix3d index_from_mm = index_from_lps.linear();
  const Vector3d across = index_from_mm * move.normal;
  const Vector3d margin =
      move.brush.is_ball
          ? Vector3d(radius * index_from_mm.rowwise().norm())
          : Vector3d(radius * (index_from_mm - across * move.normal.transpose()).rowwise().norm() +
                     (half_mm + kTie_mm) * across.cwiseAbs());
  const Vector3d a = index_from_lps * move.from_mm, b = index_from_lps * move.to_mm;
  const Vector3i last = grid.size.array() - 1;
  const Vector3i low = (a.cwiseMin(b) - margin).array().ceil().cast<int>().max(0);
  const Vector3i high = (a.cwiseMax(b) + margin).array().floor().cast<int>().min(last.array());
  const Vector3d along = move.to_mm - move.from_mm;
  const double length2 = along.squaredNorm();
  const auto put = [&](std::size_t voxel) {
    if (labels[voxel] == label) return;
    change.note(voxel, labels[voxel], label);
    labels[voxel] = label;
  };
  for (int k = low.z(); k <= high.z(); ++k) {
    for (int j = low.y(); j <= high.y(); ++j) {
      for (int i = low.x(); i <= high.x(); ++i) {
        Vector3d from = grid.lps_from_index * Vector3d(i, j, k) - move.from_mm;
        if (!move.brush.is_ball) {
          const double off = move.normal.dot(from);
          if (off <= -half_mm + kTie_mm || off > half_mm + kTie_mm) continue;
          from -= off * move.normal;
        }
        const double share = length2 > 0 ? std::clamp(from.dot(along) / length2, 0.0, 1.0) : 0;
        if ((from - share * along).norm() <= radius) put(grid.index(i, j, k));
      }
    }
  }
  const Vector3i nearest = b.array().round().cast<int>();
  if ((nearest.array() >= 0).all() && (nearest.array() <= last.array()).all())
    put(grid.index(nearest.x(), nearest.y(), nearest.z()));
}

}  // namespace arthronaut::painting
