#include "planning/postop/drilled_mouth.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "planning/geometry/quantile.h"
#include "planning/postop/bone_grid.h"

namespace arthronaut::postop {

namespace {

using Eigen::Vector3d;

constexpr double kEntryReach_mm = 10;
// The cortex is looked for from here to there under the surface.
constexpr double kFrom_mm = 0.3, kTo_mm = 2.1, kStep_mm = 0.3;
constexpr double kLeastSoft_hu = -100;
constexpr double kShine_mm = 1.5;  // of metal through the blur
constexpr int kTurns = 16;

struct Column {
  double most_hu = 0, outside_hu = 0;
  bool is_by_metal = false;
};

// What metal shines over is as bright as cortex.
bool is_by_metal(const images::VolumeSampler& postop, const geometry::RigidTransform& postop_from_plan,
                 const Vector3d& place, const Vector3d& inward) {
  const Vector3d u = kShine_mm * inward.unitOrthogonal(), v = inward.cross(u);
  for (double t = 0; t <= kTo_mm + kShine_mm; t += kStep_mm)
    for (const Vector3d& off : {Vector3d(Vector3d::Zero()), u, v, Vector3d(-u), Vector3d(-v)})
      if (postop.at(postop_from_plan * (place + t * inward + off)) > kMetal_hu) return true;
  return false;
}

std::optional<Column> column_at(const images::VolumeSampler& postop,
                                const geometry::RigidTransform& postop_from_plan,
                                const geometry::Surface& bone, const Vector3d& place, const Vector3d& inward,
                                double reach_mm) {
  std::optional<geometry::RayHit> entry;
  for (const auto& hit : bone.all_hits(place - reach_mm * inward, inward)) {
    if (hit.normal.dot(inward) >= 0 || hit.distance_mm > 2 * reach_mm) continue;
    if (!entry || std::abs(hit.distance_mm - reach_mm) < std::abs(entry->distance_mm - reach_mm)) entry = hit;
  }
  if (!entry) return std::nullopt;
  Column column{-1e4, 0};
  for (double t = kFrom_mm; t <= kTo_mm; t += kStep_mm) {
    const double v = postop.at(postop_from_plan * (entry->point_mm + t * inward));
    if (std::isfinite(v)) column.most_hu = std::max(column.most_hu, v);
  }
  column.outside_hu = postop.at(postop_from_plan * (entry->point_mm - 2 * inward));
  column.is_by_metal = is_by_metal(postop, postop_from_plan, entry->point_mm, inward);
  if (column.most_hu < -9e3 || !std::isfinite(column.outside_hu)) return std::nullopt;
  return column;
}

}  // namespace

std::optional<Passage> passage_of(const geometry::Surface& bone, const Vector3d& near_mm,
                                  const Vector3d& direction) {
  const auto hits = bone.all_hits(near_mm - kEntryReach_mm * direction, direction);
  auto entry = hits.end();
  const auto off = [&](const geometry::RayHit& hit) { return std::abs(hit.distance_mm - kEntryReach_mm); };
  for (auto hit = hits.begin(); hit != hits.end(); ++hit) {
    if (hit->normal.dot(direction) >= 0 || off(*hit) > kEntryReach_mm) continue;
    if (entry == hits.end() || off(*hit) < off(*entry)) entry = hit;
  }
  if (entry == hits.end()) return std::nullopt;
  const auto exit = std::find_if(entry + 1, hits.end(),
                                 [&](const geometry::RayHit& hit) { return hit.normal.dot(direction) >= 0; });
  if (exit == hits.end()) return std::nullopt;
  return Passage{entry->point_mm, exit->point_mm, -entry->normal.dot(direction)};
}

double Passage::entry_per_across() const {
  constexpr double kLeastCos = 0.07;
  return std::sqrt(0.5 * (1 + std::pow(std::max(kLeastCos, square_cos), -2)));
}

SeenMouth mouth_at(const images::VolumeSampler& postop, const geometry::RigidTransform& postop_from_plan,
                   const geometry::Surface& bone, const Vector3d& place_mm, const Vector3d& inward,
                   double radius_mm) {
  const Vector3d u = inward.unitOrthogonal(), v = inward.cross(u);
  const double reach_mm = 2 * radius_mm + 4;
  const auto columns_at = [&](std::initializer_list<double> offs) {
    std::vector<Column> columns;
    for (const double off : offs) {
      for (int turn = 0; turn < kTurns; ++turn) {
        const double angle = 2 * M_PI * turn / kTurns;
        const auto column =
            column_at(postop, postop_from_plan, bone,
                      place_mm + off * (std::cos(angle) * u + std::sin(angle) * v), inward, reach_mm);
        if (column) columns.push_back(*column);
      }
    }
    return columns;
  };
  const auto disc = columns_at({0.2 * radius_mm, 0.45 * radius_mm, 0.7 * radius_mm}),
             ring = columns_at({radius_mm + 0.8, radius_mm + 1.6, radius_mm + 2.4});
  SeenMouth mouth;
  if (disc.size() < kTurns || ring.size() < kTurns) return mouth;
  std::vector<double> cortex, outside;
  for (const Column& column : ring) {
    cortex.push_back(std::min(column.most_hu, kMetal_hu));
    outside.push_back(std::max(column.outside_hu, kLeastSoft_hu));
  }
  const double soft = geometry::median(outside), hard = geometry::median(cortex), level = 0.5 * (soft + hard);
  mouth.step_hu = hard - soft;
  for (const Column& column : disc)
    mouth.open_share +=
        (column.most_hu < level || column.is_by_metal ? 1.0 : 0.0) / static_cast<double>(disc.size());
  for (const Column& column : ring)
    mouth.closed_share += (column.most_hu >= level ? 1.0 : 0.0) / static_cast<double>(ring.size());
  return mouth;
}

}  // namespace arthronaut::postop
