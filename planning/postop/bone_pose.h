// Where a bone of the plan lies in a post-operative CT, from nothing: no initial guess, however the patient
// lay, whatever else the images show. Inner header of postop.
//
//   1. Poses from turns spread over all of them, each going downhill in the distance to whatever is as bright
//      as bone (bone_field.h); turns near to none are tried first.
//   2. The best few are brought onto the edges of the images (edge_pose.h); the one with the most of its
//      surface on an edge is taken.
//   3. Where the images cut the bones off and nothing of it lies well on edges, the same once more with what
//      is nearer to the entry alone.
//   4. A verdict: a bone of another patient, of the other side or half out of view has too little on edges.
#pragma once

#include <string>
#include <vector>

#include "planning/geometry/triangle_mesh.h"
#include "planning/postop/bone_field.h"
#include "planning/postop/edge_pose.h"

namespace arthronaut::postop {

struct FoundBone {
  EdgePose pose;
  bool is_found = false;  // false: nothing here is like it, and the pose is meaningless
  bool reliable = false;
  std::vector<std::string> reasons = {"the bone was not looked for"};  // why it is not reliable
};

// `near_mm`: the planned entry. The surface within 90 mm of it is what is looked for. `goes_on`: may be
// empty; where it ends the search the bone was not looked for.
[[nodiscard]] FoundBone find_bone(const images::VolumeSampler& postop, const BoneField& field,
                                  const geometry::TriangleMesh& bone, const Eigen::Vector3d& near_mm,
                                  const GoesOn& goes_on = {});

}  // namespace arthronaut::postop
