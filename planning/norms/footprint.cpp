#include "planning/norms/footprint.h"

#include <Eigen/Geometry>
#include <cmath>

#include "planning/geometry/rigid_transform.h"

namespace arthronaut::norms {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using landmarks::FemoralQuadrant;
using landmarks::TibialGrid;

constexpr int kOutlinePoints = 48;
constexpr double kGreatestNotch_mm = 30;  // from the roof's middle to the wall
constexpr double kAbovePlateau_mm = 40;
// Hensler 2011 (JBJS 93:2063); Ferretti 2012 (PubMed 21710110).
const Vector2d kFemoralSize_mm(16.3, 8.9), kTibialSize_mm(18.1, 10.7);

// A place of either grid, in percent of its two directions.
struct Spot {
  double along, across;
};

struct Grid {
  const geometry::Surface& surface;
  std::optional<FemoralQuadrant> quadrant;
  std::optional<TibialGrid> plateau;

  [[nodiscard]] std::optional<geometry::SurfacePoint> on_bone(const Spot& spot) const {
    if (quadrant) return femoral_point(surface, *quadrant, {spot.along, spot.across});
    return tibial_point(surface, *plateau, {spot.along, spot.across});
  }
  // Millimetres of one percent, along and across.
  [[nodiscard]] Vector2d mm_per_percent() const {
    return 0.01 * (quadrant ? Vector2d(quadrant->depth_mm, quadrant->height_mm)
                            : Vector2d(plateau->depth_mm, plateau->width_mm));
  }
};

// An ellipse about the centre laid onto the bone; where no bone lies behind a point of it, the nearest.
std::vector<Vector3d> laid_on_bone(const Grid& grid, const Spot& center, const Vector3d& center_mm,
                                   const Vector2d& first_mm, const Vector2d& second_mm) {
  const Vector2d scale = grid.mm_per_percent();
  std::vector<Vector3d> outline;
  for (int i = 0; i < kOutlinePoints; ++i) {
    const double angle = 2 * geometry::kPi * i / kOutlinePoints;
    const Vector2d off = std::cos(angle) * first_mm + std::sin(angle) * second_mm;
    const auto on = grid.on_bone({center.along + off.x() / scale.x(), center.across + off.y() / scale.y()});
    // A ray may pass a rim and hit what is far behind it.
    const bool is_near = on && (on->point_mm - center_mm).norm() < 2.5 * std::max(off.norm(), 4.0);
    if (is_near) {
      outline.push_back(on->point_mm);
      continue;
    }
    const Vector3d in_plane =
        grid.quadrant ? Vector3d(off.x() * grid.quadrant->shallow + off.y() * grid.quadrant->low)
                      : Vector3d(off.x() * grid.plateau->posterior + off.y() * grid.plateau->lateral);
    outline.push_back(grid.surface.closest_point(center_mm + in_plane).point_mm);
  }
  return outline;
}

// In mm of the grid: unit, from the anteromedial to the posterolateral bundle, the way in which the footprint
// is long.
Vector2d long_way(const Grid& grid, bones::BoneKind bone) {
  const InsertionNorm &am = default_norm(bone, Bundle::Anteromedial),
                      &pl = default_norm(bone, Bundle::Posterolateral);
  const Vector2d percent(pl.along.mean - am.along.mean, pl.across.mean - am.across.mean);
  return percent.cwiseProduct(grid.mm_per_percent()).normalized();
}

}  // namespace

std::optional<geometry::SurfacePoint> femoral_point(const geometry::Surface& femur,
                                                    const FemoralQuadrant& quadrant,
                                                    const FemoralQuadrant::Percent& percent) {
  // The grid stands in the middle of the notch; a hill of the roof may lie in between.
  for (const auto& hit : femur.all_hits(quadrant.point_at(percent), quadrant.lateral)) {
    if (hit.distance_mm > kGreatestNotch_mm) break;
    if (hit.normal.dot(quadrant.lateral) < 0) return hit;
  }
  return std::nullopt;
}

std::optional<geometry::SurfacePoint> tibial_point(const geometry::Surface& tibia, const TibialGrid& grid,
                                                   const TibialGrid::Percent& percent) {
  const auto hit = tibia.first_hit(grid.point_at(percent) + kAbovePlateau_mm * grid.up, -grid.up);
  if (!hit || hit->normal.dot(grid.up) < 0) return std::nullopt;
  return *hit;
}

std::optional<ExpectedFootprint> expected_footprint(const geometry::TriangleMesh& mesh,
                                                    const geometry::Surface& surface, bones::BoneKind bone,
                                                    bones::Side side, const landmarks::Landmarks& landmarks,
                                                    const InsertionNorm& norm) {
  Grid grid{surface, std::nullopt, std::nullopt};
  if (bone == bones::BoneKind::Femur) {
    grid.quadrant = landmarks::femoral_quadrant(mesh, landmarks, side);
  } else {
    grid.plateau = landmarks::tibial_grid(landmarks);
  }
  if (!grid.quadrant && !grid.plateau) return std::nullopt;
  const Spot center{norm.along.mean, norm.across.mean};
  const auto on = grid.on_bone(center);
  if (!on) return std::nullopt;
  ExpectedFootprint footprint{norm, on->point_mm, on->normal, {}, {}};
  const double share = norm.bundle == Bundle::Whole ? 0.5 : 0.25;  // of a bundle half the length
  const Vector2d size = bone == bones::BoneKind::Femur ? kFemoralSize_mm : kTibialSize_mm;
  const Vector2d way = long_way(grid, bone);
  footprint.outline_mm = laid_on_bone(grid, center, on->point_mm, share * size.x() * way,
                                      0.5 * size.y() * Vector2d(-way.y(), way.x()));
  const Vector2d scale = grid.mm_per_percent();
  footprint.spread_mm = laid_on_bone(grid, center, on->point_mm, Vector2d(norm.along.sd * scale.x(), 0),
                                     Vector2d(0, norm.across.sd * scale.y()));
  return footprint;
}

}  // namespace arthronaut::norms
