// The wet bone as the simulated lens sees it: which triangle stands in which pixel, and its light.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "navigation/simulator/ray_table.h"
#include "planning/geometry/rigid_transform.h"
#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::simulator {

// What of the bone stands in a pixel; triangle < 0: none.
struct BonePixel {
  std::int32_t triangle = -1;
  float depth_mm = 1e9f, share_b = 0, share_c = 0;  // shares of the triangle's second and third corner
};

// The part of the picture that is drawn, in pixels.
struct PixelArea {
  int left = 0, top = 0, width = 0, height = 0;
};

class BoneView {
 public:
  // The seed varies where the tissue is red.
  BoneView(const geometry::TriangleMesh& mesh, std::uint64_t seed);

  // Sets the pose and the part of the picture for the calls that follow. Vertices are projected by the camera
  // model, edges are straight in the picture between them: with edges of 1 mm the error stays below a tenth
  // of a pixel.
  void look(const geometry::RigidTransform& camera_from_bone, const RayTable& rays, const PixelArea& area);

  // Draws into rows [first_row, end_row) of the area's pixels (row-major, counted from the area's top). Rows
  // can be drawn by several threads.
  void draw(int first_row, int end_row, std::vector<BonePixel>& pixels) const;
  [[nodiscard]] Eigen::Vector3f shade(const BonePixel& pixel, float exposure) const;

 private:
  // A triangle that faces the lens, and the area's rows that it may cover.
  struct Facing {
    std::int32_t triangle = 0;
    int first_row = 0, last_row = 0;
  };
  void draw_triangle(const Facing& facing, int first_row, int end_row, std::vector<BonePixel>& pixels) const;

  // Smooth random values in four channels, periodic.
  class Noise {
   public:
    explicit Noise(std::uint64_t seed);
    [[nodiscard]] Eigen::Array4f at(const Eigen::Array3f& position) const;

   private:
    std::vector<Eigen::Array4f> lattice_;
  };

  Noise noise_;
  std::vector<std::array<std::int32_t, 3>> triangles_;
  std::vector<Eigen::Vector3f> vertices_, normals_;  // in the bone's frame
  std::vector<float> redness_;                       // by vertex
  std::vector<Eigen::Vector3f> camera_vertices_, camera_normals_;
  std::vector<Eigen::Vector2f> pixels_;  // NaN where the lens does not see
  PixelArea area_;
  std::vector<std::vector<Facing>> bands_;  // what begins in each band of kBandRows rows, or goes on there
};

}  // namespace arthronaut::simulator
