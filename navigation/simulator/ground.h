// What stands behind the instruments: the bone and the tissue behind it, as light.
#pragma once

#include <array>
#include <vector>

#include "navigation/camera/camera_model.h"
#include "navigation/simulator/bone_view.h"
#include "navigation/simulator/ray_table.h"

namespace arthronaut::simulator {

class Ground {
 public:
  // bone may be null: then there is tissue alone. All must outlive this.
  Ground(const BoneView* bone, const std::vector<BonePixel>& bone_pixels, const PixelArea& area,
         const camera::Boundary& boundary, const RayTable& rays, float exposure);

  // Writes the area's light, row after row, into rows [first, end): inside the field stop, 0 elsewhere. Only
  // every other pixel of every other row is shaded; between four that lie on one surface light is taken
  // between them: the bone's grain is ten pixels wide where the scope is close. Along outlines each pixel is
  // shaded.
  void draw_rows(int first, int end, Eigen::Vector3f* light) const;

 private:
  struct Node {
    Eigen::Vector3f light = Eigen::Vector3f::Zero();
    float depth_mm = 0;
  };
  [[nodiscard]] float depth_at(int column, int row) const;
  [[nodiscard]] Eigen::Vector3f shade(int column, int row) const;
  void shade_nodes(int row, std::vector<Node>& nodes) const;
  [[nodiscard]] std::array<int, 2> open_columns(int row) const;

  const BoneView* bone_;
  const std::vector<BonePixel>& bone_pixels_;
  const PixelArea& area_;
  const camera::Boundary& boundary_;
  const RayTable& rays_;
  float exposure_;
};

}  // namespace arthronaut::simulator
