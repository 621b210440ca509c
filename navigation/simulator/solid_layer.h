// The solids of a scene in the picture, over the ground: area-sampled where parts meet in a pixel, so that
// edges lie where the camera model puts them.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "navigation/simulator/bone_view.h"
#include "navigation/simulator/ray_table.h"
#include "navigation/simulator/solids.h"

namespace arthronaut::simulator {

class SolidLayer {
 public:
  // All must outlive it.
  SolidLayer(const std::vector<std::unique_ptr<Solid>>& solids, const PixelArea& area, const RayTable& rays,
             float exposure);

  // What rays meet, of one row of pixel corners or kept of samples.
  struct Corners {
    std::vector<float> x, y, depth_mm, normal[3];
    std::vector<std::int32_t> part;
    [[nodiscard]] MetRow met(int first);
    void resize(std::size_t size);
    void push_back(float at_x, float at_y, float at_depth_mm, std::int32_t met_part,
                   const std::array<float, 3>& met_normal);
  };
  struct Sampled {
    int column = 0, sample_count = 0, part_count = 0;
  };
  // Memory of one thread.
  class Memory {
   private:
    friend class SolidLayer;
    Corners above_, below_;
    // Of a row: its sampled pixels, what is kept of their parts, one pixel's after the other's, how many
    // samples met each, and its light.
    std::vector<Sampled> sampled_;
    Corners kept_;
    std::vector<int> counts_;
    std::vector<float> lit_;
  };

  // Draws over rows [first, end) of the area's light, row after row, three values a pixel. bone_rows: the
  // same rows and, unless the area ends there, the next one.
  void draw_rows(int first, int end, const BoneRows& bone_rows, Memory& memory, float* light) const;

 private:
  // A solid, where its parts begin, and the pixels of each row of the area that it may cover, from first to
  // last; none: last < first.
  struct Candidate {
    const Solid* solid = nullptr;
    int first_part = 0;
    std::vector<std::array<int, 2>> spans;
  };
  void find_spans(Candidate& candidate) const;
  void widen(const Eigen::Vector3d& direction, double half_angle, Candidate& candidate) const;
  [[nodiscard]] std::array<int, 2> span_of_block(int block) const;
  void trace_corners(int row, const std::array<int, 2>& span, const BoneRows& bone_rows,
                     Corners& corners) const;
  void draw_row(int row, const std::array<int, 2>& span, const BoneRows& bone_rows, Memory& memory,
                float* out) const;
  void sample(int row, int column, float ground_mm, Memory& memory) const;
  void mix_samples(Memory& memory, float* out) const;

  const PixelArea& area_;
  const RayTable& rays_;
  float exposure_;
  std::vector<Candidate> candidates_;
  std::vector<PartLook> looks_;  // by part; that of part 0 is of nothing
  std::vector<bool> is_print_;   // by part
};

}  // namespace arthronaut::simulator
