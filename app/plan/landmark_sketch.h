// What is meant by a landmark, as a small picture: the built-in knee's bone in the view in which the landmark
// is defined, with the place and the line, edge or circle that tells it. It is nobody's knee: it shows where
// on any bone the landmark lies, never where it lies on this patient's. Computed by the processor, without a
// window, on any thread.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "app/scene/plan_picture.h"
#include "planning/landmarks/anatomical_axes.h"

namespace arthronaut::plan {

struct SchematicBone {
  geometry::TriangleMesh mesh;
  std::vector<Eigen::Vector3d> normals;  // of its vertices
  landmarks::AnatomicalAxes axes;
  landmarks::Landmarks landmarks;  // every one of known_landmarks()
};
struct SchematicKnee {
  bones::Side side = bones::Side::Right;
  std::map<bones::BoneKind, SchematicBone> bones;
};
// The built-in knee of that side, its landmarks as its shape proposes them. Takes a second: beside the
// screen.
[[nodiscard]] SchematicKnee make_schematic_knee(bones::Side side);

struct LandmarkSketch {
  scene::ViewDirection view = scene::ViewDirection::Anterior;
  std::string left, right;                          // what lies beyond these edges: "anterior"
  int size_px = 0;                                  // square
  std::vector<std::uint32_t> rgba;                  // as bytes, rows from the top
  Eigen::Vector2d at_px = Eigen::Vector2d::Zero();  // where the landmark is drawn, from the top left
};
// Precondition: the bone has the landmark (known_landmarks()). Throws InvalidInput for another name, or a
// size that is not in 16..2048. A few milliseconds.
[[nodiscard]] LandmarkSketch sketch_landmark(const SchematicKnee& knee, bones::BoneKind bone,
                                             std::string_view name, int size_px);

}  // namespace arthronaut::plan
