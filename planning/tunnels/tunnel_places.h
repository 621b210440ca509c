// On which part of a bone a tunnel begins and ends, told from the bone's shape and its anatomical axes alone,
// so that an absurd plan is called absurd even where nobody has placed a landmark.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "planning/bones/bone.h"
#include "planning/landmarks/anatomical_axes.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::tunnels {

// A bone's extents along its anatomical axes, for its size; made once a bone.
struct BoneExtents {
  double lowest_mm = 0, highest_mm = 0;  // along proximal
  // At the joint's end, within 40 mm of it: the lowest of a femur, the highest of a tibia.
  double medial_mm = 0, lateral_mm = 0, posterior_mm = 0, anterior_mm = 0;  // along lateral, along anterior
  [[nodiscard]] double width_mm() const { return lateral_mm - medial_mm; }
};
[[nodiscard]] BoneExtents bone_extents(const geometry::TriangleMesh& mesh, bones::BoneKind bone,
                                       const landmarks::AnatomicalAxes& axes);

// How far a face of the femur's notch has to look away from straight up or down to be a wall.
constexpr double kNotchWall_deg = 25;

enum class FemoralEntry {
  LateralWall,   // of the notch: where the ligament was
  MedialWall,    // of the notch: the posterior cruciate's
  Roof,          // of the notch
  OutsideNotch,  // no bone on both sides of it, or it lies in the groove
};
// In the notch: from 0.5 mm above the surface there is bone both medially and laterally within half the
// bone's width and none behind the middle between these, as there is behind the groove in front of the notch;
// and the surface does not face straight forwards or backwards (within 35 deg), as that behind the notch
// does. Which wall: the one that the surface faces away from,
// by more than 25 deg; else the roof.
[[nodiscard]] FemoralEntry femoral_entry(const geometry::Surface& femur, const TunnelMouth& entry,
                                         const landmarks::AnatomicalAxes& axes, const BoneExtents& extents);

enum class FemoralExit {
  LateralCortex,
  MedialSide,    // of where it began, or out of a face that looks medially
  JointSurface,  // condyle or groove
  IntoNotch,     // more bone lies laterally of it
  Front,         // of the shaft, under the extensor muscles
  Back,          // of the shaft, towards the vessels
  Above,         // the shaft's cut end
};
// Joint surface: less than half the bone's width above its lowest point, out of a face that looks downwards
// (by more than 30 deg), or one that looks neither laterally nor medially (within 45 deg of straight on).
// Into the notch: from 0.5 mm above the surface straight laterally there is a tenth of the bone's width of
// bone or more. Above: a face that looks up by more than 60 deg in the upper half of the bone. In front and
// behind: one that looks that way more than it looks laterally.
[[nodiscard]] FemoralExit femoral_exit(const geometry::Surface& femur, const TunnelGeometry& tunnel,
                                       const landmarks::AnatomicalAxes& axes, const BoneExtents& extents);

enum class TibialEntry { BetweenCondyles, MedialPlateau, LateralPlateau, BesidePlateau };
// Beside: further than a fifth of the width below the top, or out of a face that looks up by less than 30
// deg. The area between the condyles is taken for the middle third of the width, and a tenth of it to either
// side.
[[nodiscard]] TibialEntry tibial_entry(const TunnelMouth& entry, const landmarks::AnatomicalAxes& axes,
                                       const BoneExtents& extents);

enum class TibialExit { AnteromedialFace, LateralFace, PosteriorFace, JointSurface, Below };
// Joint surface: less than 10 mm below the entry's height. Below: out of a cut end, which looks downwards (by
// more than 60 deg). Posterior and lateral: the face looks that way by more than 30 deg.
[[nodiscard]] TibialExit tibial_exit(const TunnelGeometry& tunnel, const landmarks::AnatomicalAxes& axes);

// From the exit straight back to the posterior cortex at its height: the hindmost point of the surface within
// 1.5 mm of its height, from 5 mm lateral to 15 mm medial of it (femur). nullopt where no surface lies there.
[[nodiscard]] std::optional<double> to_posterior_cortex_mm(const geometry::TriangleMesh& femur,
                                                           const Eigen::Vector3d& exit_mm,
                                                           const landmarks::AnatomicalAxes& axes);

}  // namespace arthronaut::tunnels
