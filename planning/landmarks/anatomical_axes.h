// Which way is anterior, proximal and lateral on a bone: the words in which an offset is said. From the
// bone's own landmarks or shape where they tell; a patient lies in a scanner as he likes.
#pragma once

#include <Eigen/Core>
#include <string_view>

#include "planning/bones/bone.h"
#include "planning/landmarks/landmarks.h"

namespace arthronaut::landmarks {

struct AnatomicalAxes {
  // Where the axes come from, the best first.
  enum class Origin { FromLandmarks, FromShaft, FromScanner } origin = Origin::FromScanner;
  // In the bone's frame (LPS): unit and at right angles. The default is a right knee's in the scanner.
  Eigen::Vector3d anterior = -Eigen::Vector3d::UnitY();
  Eigen::Vector3d proximal = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d lateral = -Eigen::Vector3d::UnitX();
};
// "the bone's landmarks", "the bone's shaft", "the scanner's axes": for the report and the screen's footnote.
[[nodiscard]] std::string_view to_text(AnatomicalAxes::Origin origin);

// Those of LPS.
[[nodiscard]] AnatomicalAxes scanner_axes(bones::Side side);

// How well the joint's end alone tells the long axis in the lateral view, one sigma. Femur: the roof of the
// notch stands at 37 degrees to it, 26 to 46 in Howell 1995. Tibia: the plateau falls backwards by 8 degrees.
inline constexpr double kRoofSlope_deg = 37, kRoofSigma_deg = 5.5;
inline constexpr double kPlateauSlope_deg = 8, kSlopeSigma_deg = 4;
// How well a stretch of the shaft tells it: 2.5 degrees, and 70 degrees over its length in mm, added in
// squares.
[[nodiscard]] double shaft_sigma_deg(double length_mm);

// Landmarks, proposed or confirmed: lateral runs through the centres of the condyles, else the epicondyles,
// else the condyles' posterior points (femur); through the plateau's medial and lateral edges (tibia).
// Proximal is across it: what the joint's end tells (femur: Blumensaat's line, else the epicondyles in front
// of the posterior condyles; tibia: the plateau's anterior and posterior edges) and the landmarks of the
// shaft, weighted by how well either tells it; the mesh's shaft or the scanner where neither is there. Not
// taken when they are mixed up: when most of the mesh then lies on the wrong side of the joint, when the
// joint's end and the landmarks of the shaft tell axes more than 60 degrees apart, or, without a mesh, when
// an axis is more than 60 degrees off the scanner's. Without landmarks: proximal is the shaft, the
// longest principal axis of the surface, when its variance is more than 1.6 times the next one's; lateral is
// the scanner's, laid across it, unless more than 60 degrees off the scanner's. Never throws; an empty mesh
// has no shape.
[[nodiscard]] AnatomicalAxes anatomical_axes(bones::BoneKind bone, bones::Side side,
                                             const Landmarks& landmarks, const geometry::TriangleMesh& mesh);

enum class AnatomicalDirection { Anterior, Proximal, Lateral };
// "anterior", or "posterior" for the other way.
[[nodiscard]] std::string_view to_text(AnatomicalDirection direction, bool is_positive = true);

// Two directions at right angles across a line, named by the anatomical axes that they lie nearest to: of the
// three the one along the line is left out, `up` is proximal, or anterior where proximal is left out, laid
// across the line; `side` stands across both and points to the positive sense of its name.
struct PlaneAxes {
  AnatomicalDirection up_is = AnatomicalDirection::Proximal, side_is = AnatomicalDirection::Anterior;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ(), side = -Eigen::Vector3d::UnitY();
};
// line: unit. Allocates nothing.
[[nodiscard]] PlaneAxes axes_across(const AnatomicalAxes& axes, const Eigen::Vector3d& line);

}  // namespace arthronaut::landmarks
