#include "planning/landmarks/long_axis.h"

#include <algorithm>
#include <vector>

#include "planning/landmarks/shape_samples.h"

namespace arthronaut::landmarks {

namespace {

using Eigen::Vector3d;

constexpr double kStep_mm = 2, kLeastLength_mm = 8;
constexpr double kNearCut_mm = 2;  // its edge is round

}  // namespace

double whole_until(const geometry::TriangleMesh& mesh, const RoughFrame& rough, const Vector3d& joint_mm,
                   const Vector3d& away) {
  const double base = joint_mm.dot(away);
  double end = -1e9, cut_from = 1e9;
  for (const Vector3d& v : mesh.vertices_mm) {
    const double height = v.dot(away) - base;
    end = std::max(end, height);
    if (rough.cut_normal && v.dot(*rough.cut_normal) > rough.cut_offset_mm - kNearCut_mm)
      cut_from = std::min(cut_from, height);
  }
  return std::min(end - kNearCut_mm, cut_from);
}

std::optional<LongAxis> find_long_axis(const geometry::TriangleMesh& mesh, const RoughFrame& rough,
                                       const Vector3d& joint_mm, const Vector3d& away, double first_mm,
                                       double last_mm) {
  const double base = joint_mm.dot(away);
  const double last = std::min(last_mm, whole_until(mesh, rough, joint_mm, away));
  if (last - first_mm < kLeastLength_mm) return std::nullopt;
  const auto sections = sections_across(mesh, away, base + first_mm, kStep_mm,
                                        static_cast<std::size_t>((last - first_mm) / kStep_mm) + 1);
  std::vector<Vector3d> centers;
  for (const Section& section : sections) {
    if (section.area_mm2 > 50) centers.push_back(section.center_mm);
  }
  if (centers.size() < 4) return std::nullopt;
  FittedLine line = fit_line(centers);
  if (line.direction.dot(away) < 0) line.direction = -line.direction;
  const auto on_line = [&](const Vector3d& p) -> Vector3d {
    return line.point_mm + (p - line.point_mm).dot(line.direction) * line.direction;
  };
  LongAxis axis{on_line(centers.front()), on_line(centers.back())};
  if (axis.length_mm() < kLeastLength_mm) return std::nullopt;
  return axis;
}

}  // namespace arthronaut::landmarks
