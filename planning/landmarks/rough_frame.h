// Roughly how a bone lies, told from its shape alone. Inner header of landmarks.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <stop_token>
#include <vector>

#include "planning/bones/bone.h"
#include "planning/geometry/surface.h"
#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::landmarks {

// Right-handed: x to the patient's right (lateral in a right knee), y anterior, z proximal.
struct RoughFrame {
  Eigen::Matrix3d bone_from_frame = Eigen::Matrix3d::Identity();  // columns are the axes
  Eigen::Vector3d origin_mm =
      Eigen::Vector3d::Zero();  // on the mirror plane, at the middle of the joint's end
  // A plane face that everything else lies behind: where the bone was cut off. Unit, outward; unset for a
  // whole bone.
  std::optional<Eigen::Vector3d> cut_normal;
  double cut_offset_mm = 0;  // of the face along its normal
};

// One for each end of the surface that may be the joint's, the likeliest first: the one that comes nearest to
// its own mirror image. Where the cut was found there is one. Empty: nothing here looks like the joint's end
// of a bone (no area, no mirror plane). The right one lies within 25 degrees of the anatomical axes for bones
// of which 55 mm or more are there.
// `surface` is the mesh's. Once `stop` asks for it the rest is not looked for.
[[nodiscard]] std::vector<RoughFrame> rough_frames(const geometry::TriangleMesh& mesh,
                                                   const geometry::Surface& surface, bones::BoneKind bone,
                                                   const std::stop_token& stop = {});

}  // namespace arthronaut::landmarks
