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

// The part of the picture that is drawn, in pixels.
struct PixelArea {
  int left = 0, top = 0, width = 0, height = 0;
};

// What of the bone stands in some rows of an area, counted from the area's top. Rows are padded, and repeat
// their last pixel once.
class BoneRows {
 public:
  static constexpr float kNothing_mm = 1e9f;  // the depth where there is no bone

  // Empty rows: no bone anywhere.
  void clear(int first_row, int count, int width);
  void repeat_last_pixels(int width);
  [[nodiscard]] int first_row() const { return first_row_; }
  [[nodiscard]] int end_row() const { return first_row_ + count_; }
  [[nodiscard]] float* depth_mm(int row) { return depth_mm_.data() + offset(row); }
  [[nodiscard]] const float* depth_mm(int row) const { return depth_mm_.data() + offset(row); }
  // Below 0: none.
  [[nodiscard]] std::int32_t* triangles(int row) { return triangles_.data() + offset(row); }
  [[nodiscard]] const std::int32_t* triangles(int row) const { return triangles_.data() + offset(row); }

 private:
  [[nodiscard]] std::size_t offset(int row) const {
    return static_cast<std::size_t>(row - first_row_) * static_cast<std::size_t>(stride_);
  }
  int first_row_ = 0, count_ = 0, stride_ = 0;
  std::vector<float> depth_mm_;
  std::vector<std::int32_t> triangles_;
};

class BoneView {
 public:
  // The seed varies where the tissue is red.
  BoneView(const geometry::TriangleMesh& mesh, std::uint64_t seed);

  // Sets the pose and the part of the picture for the calls that follow. Vertices are projected by the camera
  // model, edges are straight in the picture between them: with edges of 1 mm the error stays below a tenth
  // of a pixel.
  void look(const geometry::RigidTransform& camera_from_bone, const RayTable& rays, const PixelArea& area);

  // Draws into cleared rows. Different rows can be drawn by several threads.
  void draw(BoneRows& rows) const;

  // Memory that shade() uses, of one thread.
  class Shading {
   private:
    friend class BoneView;
    std::vector<float> values_;
    std::vector<float> columns_;
  };
  // The light of `count` pixels of a row, blue green red, at these columns of the area, where these triangles
  // stand. bgr has room for padded(count) pixels.
  void shade(int row, const int* columns, const std::int32_t* triangles, int count, float exposure,
             Shading& memory, float* bgr) const;

 private:
  // A triangle that faces the lens, and the area's rows that it may cover.
  struct Facing {
    std::int32_t triangle = 0;
    int first_row = 0, last_row = 0;
  };
  // Camera frame, normal there, bone frame, redness, and two more to fill up.
  using Attributes = std::array<float, 12>;
  void draw_triangle(const Facing& facing, BoneRows& rows) const;

  std::vector<float> lattice_;  // see picture_kernel.h
  std::vector<std::array<std::int32_t, 3>> triangles_;
  std::vector<Eigen::Vector3f> vertices_, normals_;  // in the bone's frame
  std::vector<Attributes> attributes_;               // by vertex
  std::vector<Eigen::Vector2f> pixels_;              // NaN where the lens does not see
  PixelArea area_;
  std::vector<std::vector<Facing>> bands_;  // what begins in each band of kBandRows rows, or goes on there
};

}  // namespace arthronaut::simulator
