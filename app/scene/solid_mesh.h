// Rods, lines and balls as coloured triangles: one mesh for all, so that a guide that moves costs one upload
// a frame.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "app/scene/scene_content.h"

namespace arthronaut::scene {

struct SolidMesh {
  std::vector<Eigen::Vector3f> points_mm, normals;
  std::vector<std::array<std::uint8_t, 3>> colors;  // of each point
  std::vector<std::array<std::int32_t, 3>> triangles;

  void add(const RodItem& rod);
  void add(const LineItem& line);
  void add(const BallItem& ball);
};

}  // namespace arthronaut::scene
