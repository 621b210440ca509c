// Signed distance to a closed mesh on a regular grid: negative inside, exact at the grid's nodes within a band about the
// surface, saturated beyond it. Made for millions of look-ups; the exact surface is geometry::Surface.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::registration {

struct DistanceFieldOptions {
  double spacing_mm = 0.5;          // between nodes; widened where the grid would hold more than max_node_count
  double band_mm = 5.0;             // |distance| is known up to here
  std::int64_t max_node_count = 24'000'000;
};

class DistanceField {
 public:
  // The sign at each node is that of the angle-weighted pseudo-normal of the nearest face, edge or vertex, which is right
  // for closed, outward oriented meshes. Throws InvalidInput when the mesh is empty or holds a number that is not finite.
  explicit DistanceField(const geometry::TriangleMesh& mesh, const DistanceFieldOptions& options = {});

  [[nodiscard]] double spacing_mm() const { return spacing_mm_; }
  [[nodiscard]] double band_mm() const { return band_mm_; }

  // Distance at the nearest node; +band outside the grid. Off by at most 0.87 spacing.
  [[nodiscard]] float nearest_mm(const Eigen::Vector3f& point_mm) const {
    const Eigen::Vector3f cell = (point_mm - origin_mm_f_) * inverse_spacing_f_;
    const int x = static_cast<int>(cell.x() + 0.5f), y = static_cast<int>(cell.y() + 0.5f),
              z = static_cast<int>(cell.z() + 0.5f);
    // A negative coordinate becomes a large unsigned number; (-0.5, 0] rounds to node 0, which lies outside the band.
    if (static_cast<unsigned>(x) >= static_cast<unsigned>(size_[0]) ||
        static_cast<unsigned>(y) >= static_cast<unsigned>(size_[1]) ||
        static_cast<unsigned>(z) >= static_cast<unsigned>(size_[2])) {
      return static_cast<float>(band_mm_);
    }
    return kStep_mm * static_cast<float>(nodes_[index(x, y, z)]);
  }

  struct Sample {
    double distance_mm = 0;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  // of the interpolant; zero where the field is saturated
  };
  // Trilinear. Error of the distance about spacing^2 * curvature / 8.
  [[nodiscard]] Sample sample(const Eigen::Vector3d& point_mm) const;

 private:
  static constexpr float kStep_mm = 0.001f;

  [[nodiscard]] std::size_t index(int x, int y, int z) const {
    return static_cast<std::size_t>(x) +
           static_cast<std::size_t>(size_[0]) * (static_cast<std::size_t>(y) +
                                                 static_cast<std::size_t>(size_[1]) * static_cast<std::size_t>(z));
  }

  Eigen::Vector3d origin_mm_;
  Eigen::Vector3f origin_mm_f_;
  Eigen::Vector3i size_;
  double spacing_mm_, band_mm_;
  float inverse_spacing_f_;
  std::vector<std::int16_t> nodes_;  // in steps of kStep_mm, x runs fastest
};

}  // namespace arthronaut::registration
