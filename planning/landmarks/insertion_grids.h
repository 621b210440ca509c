// Where on a bone a point lies in the percentages that surgeons publish: Bernard and Hertel's quadrant on the
// lateral femoral condyle, and the anterior-posterior (Amis and Jakob) and medial-lateral shares of the
// tibial plateau.
//
// Grids follow from landmarks that somebody placed: on the femur they depend on how Blumensaat's line was
// laid through a roof that is often curved (Yahagi 2018), so that a percentage is no better than a few
// points.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "planning/bones/bone.h"
#include "planning/geometry/triangle_mesh.h"
#include "planning/landmarks/landmarks.h"

namespace arthronaut::landmarks {

// Bernard and Hertel's rectangle as on a true lateral view: one side on Blumensaat's line, the others
// touching the outline of the lateral condyle below that line.
struct FemoralQuadrant {
  Eigen::Vector3d corner_mm;     // deep and high, in the plane of the footprint-side condyle; bone frame
  Eigen::Vector3d shallow, low;  // unit, at right angles: along Blumensaat's line; away from it
  // Unit, at right angles to both: the way out of the notch through the lateral condyle; the view is along
  // it.
  Eigen::Vector3d lateral = Eigen::Vector3d::UnitX();
  double depth_mm = 0, height_mm = 0;

  struct Percent {
    double deep_shallow = 0, high_low = 0;  // 0 deep and high, 100 shallow and low
  };
  [[nodiscard]] Percent percent_of(const Eigen::Vector3d& point_mm) const;
  // The point of the rectangle's plane; medial-lateral it lies where corner_mm does.
  [[nodiscard]] Eigen::Vector3d point_at(const Percent& percent) const;
};

// Needs blumensaat_anterior and blumensaat_posterior. The view is exactly along the condylar line: through
// the condyles' centres, else their posterior points, where either pair is known, else along the patient's x
// laid across the line; Blumensaat's line is taken as that view shows it. Extents: lateral_condyle_deep,
// _shallow and _low where all three are known, else the outline of the mesh, needles left out.
// nullopt when a landmark is missing or the line is shorter than 5 mm in the view.
[[nodiscard]] std::optional<FemoralQuadrant> femoral_quadrant(const geometry::TriangleMesh& femur,
                                                              const Landmarks& landmarks, bones::Side side);

// Percentages on the tibial plateau, as seen from above along the long axis, which stands 8 degrees in front
// of what is at right angles to the plateau's edges (kPlateauSlope_deg).
struct TibialGrid {
  Eigen::Vector3d anterior_mm, medial_mm;  // where each share is 0; bone frame
  Eigen::Vector3d posterior, lateral;      // unit, at right angles
  Eigen::Vector3d up =
      Eigen::Vector3d::UnitZ();  // unit, at right angles to both: the view from above is against it
  double depth_mm = 0, width_mm = 0;

  struct Percent {
    double anterior_posterior = 0, medial_lateral = 0;
  };
  [[nodiscard]] Percent percent_of(const Eigen::Vector3d& point_mm) const;
  // In the plane through plateau_anterior.
  [[nodiscard]] Eigen::Vector3d point_at(const Percent& percent) const;
};

// Needs the four plateau_* landmarks; which side is up is told by an eminence or the tuberosity, without
// either by the patient's z. nullopt when one is missing or two opposite ones lie closer than 5 mm.
[[nodiscard]] std::optional<TibialGrid> tibial_grid(const Landmarks& landmarks);

// Whether the landmarks give the bone's grid: then nothing that is proposed is mixed in with them, since axes
// and grids are never of two proposals (take_proposal).
[[nodiscard]] bool has_grid(const geometry::TriangleMesh& mesh, bones::BoneKind bone, bones::Side side,
                            const Landmarks& landmarks);

}  // namespace arthronaut::landmarks
