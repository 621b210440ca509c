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
  Ground(const BoneView* bone, const PixelArea& area, const camera::Boundary& boundary, const RayTable& rays,
         float exposure);

  // Memory of one thread.
  class Memory {
   private:
    friend class Ground;
    // Every other pixel of an even row, and one beyond.
    struct Nodes {
      std::vector<float> bgr, depth_mm;
    };
    struct Pixels {
      std::vector<int> columns;
      std::vector<std::int32_t> triangles;
      std::vector<float> bgr, x, y;
    };
    Nodes above_, below_;
    std::vector<float> sum_, low_mm_, high_mm_;
    std::vector<int> breaks_;
    Pixels on_bone_, beside_;
    BoneView::Shading shading_;
  };

  // Writes the light of rows [first, end), row after row, to `light`, the area's: inside the field stop, 0
  // elsewhere. Only every other pixel of every other row is shaded; between four that lie on one surface
  // light is taken between them: the bone's grain is ten pixels wide where the scope is close. Along outlines
  // each pixel is shaded. bone_rows: the same rows and, unless the area ends there, the next one; first is
  // even.
  void draw_rows(int first, int end, const BoneRows& bone_rows, Memory& memory, float* light) const;

 private:
  template <typename Columns, typename Put>
  void shade(int row, const Columns& columns, const BoneRows& bone_rows, Memory& memory, Put put) const;
  void shade_nodes(int row, const BoneRows& bone_rows, Memory& memory, Memory::Nodes& nodes) const;
  void draw_row(int row, const BoneRows& bone_rows, const Memory::Nodes& under, Memory& memory,
                float* out) const;
  [[nodiscard]] std::array<int, 2> open_columns(int row) const;
  [[nodiscard]] int node_count() const { return (area_.width + 1) / 2; }

  const BoneView* bone_;
  const PixelArea& area_;
  const camera::Boundary& boundary_;
  const RayTable& rays_;
  float exposure_;
};

}  // namespace arthronaut::simulator
