// The expected footprint: where the ligament inserted on this bone, as an area on its surface with its
// spread.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "planning/geometry/surface.h"
#include "planning/geometry/triangle_mesh.h"
#include "planning/landmarks/insertion_grids.h"
#include "planning/landmarks/landmarks.h"
#include "planning/norms/insertion_norms.h"

namespace arthronaut::norms {

struct ExpectedFootprint {
  InsertionNorm norm;
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();  // on the surface, bone frame
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();    // unit, out of the bone, about the centre
  // Closed polylines on the surface; the last point joins the first. `outline` is the insertion itself at the
  // published size; `spread` is where its centre lies in two knees of three (one sigma along and across).
  std::vector<Eigen::Vector3d> outline_mm, spread_mm;
};

// The point of the bone at these percentages of the grid. Femur: on the wall of the notch that the lateral
// condyle has. Tibia: on the plateau, seen from above. nullopt where no bone is there.
[[nodiscard]] std::optional<geometry::SurfacePoint> femoral_point(
    const geometry::Surface& femur, const landmarks::FemoralQuadrant& quadrant,
    const landmarks::FemoralQuadrant::Percent& percent);
[[nodiscard]] std::optional<geometry::SurfacePoint> tibial_point(
    const geometry::Surface& tibia, const landmarks::TibialGrid& grid,
    const landmarks::TibialGrid::Percent& percent);

// nullopt when the landmarks give no grid or no bone lies there. `mesh` is the surface's.
[[nodiscard]] std::optional<ExpectedFootprint> expected_footprint(const geometry::TriangleMesh& mesh,
                                                                  const geometry::Surface& surface,
                                                                  bones::BoneKind bone, bones::Side side,
                                                                  const landmarks::Landmarks& landmarks,
                                                                  const InsertionNorm& norm);

}  // namespace arthronaut::norms
