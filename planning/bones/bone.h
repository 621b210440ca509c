// What a bone is to the rest of the program: which one, of which side, and its surface.
#pragma once

#include <string>
#include <string_view>

#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::bones {

enum class BoneKind { Femur, Tibia };
enum class Side { Left, Right };

[[nodiscard]] std::string_view to_text(BoneKind kind);  // "femur", "tibia"
[[nodiscard]] std::string_view to_text(Side side);      // "left", "right"
// Throw InvalidInput for any other word.
[[nodiscard]] BoneKind bone_kind_from_text(std::string_view text);
[[nodiscard]] Side side_from_text(std::string_view text);

struct Bone {
  BoneKind kind = BoneKind::Femur;
  geometry::TriangleMesh mesh;  // LPS, mm, closed, outward
  std::string source;           // where it came from, for the report: "bone.stl", "label 5 of knee.nrrd"
};

}  // namespace arthronaut::bones
