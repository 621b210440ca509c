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

// Landmarks: the femur's lateral axis runs through the epicondyles, the tibia's through the plateau's medial
// and lateral ends. Proximal is across it, by the first that is there: the posterior condyles (femur: they
// lie straight behind the epicondyles) or the plateau's anterior and posterior ends (tibia), the shaft, the
// scanner. Shaft: proximal is the shaft, the longest principal axis of the surface, taken when its variance
// is more than 1.6 times the next one's; lateral is the scanner's, laid across it. Axes more than 60 degrees
// off the scanner's are those of mixed-up landmarks or of no shaft, and are not taken. Never throws; an empty
// mesh has no shape.
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
