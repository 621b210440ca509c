// Oriented samples of the bone's surface, and all their pairs sorted so that those which may match a given
// pair of curve points with tangents are found without a search.
//
// A pair of curve points (P, Q, tangents p, q) and a pair of surface points (P', Q', normals n, m) can match
// only where the distances agree and, with e the unit baseline, c_p = p.e and so on, the angles allow both
// tangents to lie across both normals: then the turn about the baseline is fixed, up to few choices.
//
// The constraint is that of C. Raposo, J. P. Barreto, "3D registration of curves and surfaces using local
// differential information", CVPR 2018, which the MICCAI paper registers with. The table that is looked up by
// distance and angles is in the manner of B. Drost, M. Ulrich, N. Navab, S. Ilic, "Model globally, match
// locally: efficient and robust 3D object recognition", CVPR 2010.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "navigation/registration/bone/byte_stream.h"
#include "planning/geometry/triangle_mesh.h"

namespace arthronaut::registration {

struct SurfaceSample {
  Eigen::Vector3f point_mm;
  Eigen::Vector3f normal;  // unit, outward
};

// Evenly spread over the surface, no two nearer than spacing_mm; deterministic.
[[nodiscard]] std::vector<SurfaceSample> sample_surface(const geometry::TriangleMesh& mesh,
                                                        double spacing_mm);

// What a pair of oriented points keeps under any motion.
struct PairShape {
  float distance_mm = 0;
  float cos_first = 0, cos_second = 0;  // direction of each point to the baseline first -> second
  float dihedral_rad = 0;  // from the first direction to the second about the baseline, [-pi, pi)
};
[[nodiscard]] PairShape shape_of(const Eigen::Vector3f& first, const Eigen::Vector3f& first_direction,
                                 const Eigen::Vector3f& second, const Eigen::Vector3f& second_direction);

struct PairTableOptions {
  double sample_spacing_mm = 2.4;
  double min_distance_mm = 9, max_distance_mm = 33;
  // Wider spacing where the bone is so large that the table would hold more pairs.
  std::int64_t max_pair_count = 4'000'000;
};

class PairTable {
 public:
  PairTable(const geometry::TriangleMesh& mesh, const PairTableOptions& options = {});

  // As written by write_to. Throws InvalidInput when the bytes are not such.
  explicit PairTable(ByteReader& bytes);
  void write_to(ByteWriter& bytes) const;

  [[nodiscard]] const std::vector<SurfaceSample>& samples() const { return samples_; }
  [[nodiscard]] double min_distance_mm() const { return options_.min_distance_mm; }
  [[nodiscard]] double max_distance_mm() const { return options_.max_distance_mm; }

  struct Tolerance {
    float distance_mm = 0.8f;
    float angle_rad = 0.12f;
  };
  struct Match {
    std::uint16_t first, second;  // samples that the curve pair's first and second point may lie on
    float turn_rad;  // about the baseline, from the first normal's plane to where the first tangent's plane
                     // comes to lie
  };
  // Appends the matches of a curve pair of this shape, in the order stored. Every pair of samples is tried
  // one way round: search again for the curve pair with its ends exchanged to try the other.
  void find_matches(const PairShape& curve_pair, const Tolerance& tolerance,
                    std::vector<Match>& matches) const;

 private:
  static constexpr int kCosineBins = 16;
  static constexpr float kDistanceBin_mm = 0.5f;
  [[nodiscard]] std::size_t count_pairs() const;
  void build_pairs();

  struct Pair {
    PairShape shape;
    std::uint16_t first, second;
  };

  PairTableOptions options_;
  std::vector<SurfaceSample> samples_;
  int distance_bin_count_ = 0;
  std::vector<Pair> pairs_;                // by cell, then by dihedral
  std::vector<std::uint32_t> cell_start_;  // cells: distance, then both cosines; one more than cells
};

}  // namespace arthronaut::registration
