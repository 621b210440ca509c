// What an import found: one bone, a ball of its own axes.
#pragma once

#include "planning/import/bone_import.h"
#include "tests/planning/geometry/shapes.h"

namespace arthronaut::test {

inline importing::BoneImport imported(bones::BoneKind kind,
                                      std::optional<bones::Side> side = bones::Side::Right) {
  importing::BoneImport import;
  import.side = side;
  importing::ImportedBone bone;
  bone.bone = {kind, ellipsoid({40, 30, 25}, 2), "bone.stl"};
  import.bones.push_back(bone);
  return import;
}

}  // namespace arthronaut::test
