#include "planning/bones/bone.h"

#include "planning/geometry/error.h"

namespace arthronaut::bones {

std::string_view to_text(BoneKind kind) { return kind == BoneKind::Femur ? "femur" : "tibia"; }
std::string_view to_text(Side side) { return side == Side::Left ? "left" : "right"; }

BoneKind bone_kind_from_text(std::string_view text) {
  for (const BoneKind kind : {BoneKind::Femur, BoneKind::Tibia}) {
    if (text == to_text(kind)) return kind;
  }
  throw InvalidInput("\"" + std::string(text) + "\" is not a bone: femur or tibia");
}

Side side_from_text(std::string_view text) {
  for (const Side side : {Side::Left, Side::Right}) {
    if (text == to_text(side)) return side;
  }
  throw InvalidInput("\"" + std::string(text) + "\" is not a side: left or right");
}

}  // namespace arthronaut::bones
