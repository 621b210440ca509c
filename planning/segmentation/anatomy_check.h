// Whether a surface can be the bone that it is said to be: a femur has two condyles at its lower end and a
// shaft above them, a tibia a plateau at its upper end. An import that went wrong (both bones in one, a bone
// cut off at the joint, a fibula, axes that are not the patient's) gives none of these.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "planning/bones/bone.h"
#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::segmentation {

// For a person: why it may not be that bone; empty when nothing speaks against it. The mesh is closed and
// turned outwards, LPS, mm. The bone may lean by 40 degrees to the patient's axes. image_ends: unit and
// outward, where the images end within the bone: a flat face there is no shaft's cut end.
[[nodiscard]] std::vector<std::string> anatomy_doubts(const geometry::TriangleMesh& mesh,
                                                      bones::BoneKind kind,
                                                      std::span<const Eigen::Vector3d> image_ends = {});

// "its shaft points forwards, not up: the axes of the file are not the patient's (LPS); ...". shaft: from the
// joint along the bone, LPS, named by the nearest of the patient's axes.
[[nodiscard]] std::string wrong_axes_doubt(bones::BoneKind kind, const Eigen::Vector3d& shaft);

}  // namespace arthronaut::segmentation
