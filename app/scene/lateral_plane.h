// The picture plane of the true lateral view of a femur: the condyles superposed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/scene/reslice.h"
#include "planning/bones/bone.h"
#include "planning/landmarks/anatomical_axes.h"
#include "planning/landmarks/insertion_grids.h"

namespace arthronaut::scene {

// The vertices within so far of the joint, which is at the femur's lower end and at the tibia's upper one:
// what a surgeon looks at of a bone that may be whole.
[[nodiscard]] std::vector<Eigen::Vector3d> joint_end(const geometry::TriangleMesh& mesh, bones::BoneKind kind,
                                                     const landmarks::AnatomicalAxes& axes, double shown_mm);
// Of those within 80 mm.
[[nodiscard]] geometry::Bounds joint_bounds(const geometry::TriangleMesh& mesh, bones::BoneKind kind,
                                            const landmarks::AnatomicalAxes& axes);

// With the grid's corners, which reach beyond the bone.
[[nodiscard]] geometry::Bounds with_grid(geometry::Bounds shown, const landmarks::FemoralQuadrant& quadrant);

// The plane of the picture, looked at from the lateral side: across the grid's own plane where there is a
// grid, else across the bone's lateral axis. All of `shown`, the joint's end of the femur, and of the grid
// fits in.
[[nodiscard]] SlicePlane lateral_plane(const landmarks::AnatomicalAxes& axes,
                                       const std::optional<landmarks::FemoralQuadrant>& quadrant,
                                       const geometry::Bounds& shown, const Eigen::Vector2i& size_px);

// What the picture in that plane is, or why it is no true lateral view: the condyles are not marked.
[[nodiscard]] std::string lateral_plane_in_words(const landmarks::AnatomicalAxes& axes,
                                                 const std::optional<landmarks::FemoralQuadrant>& quadrant,
                                                 const landmarks::Landmarks& femur);

}  // namespace arthronaut::scene
