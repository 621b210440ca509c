#include "planning/import/filled_check.h"

#include <algorithm>

namespace arthronaut::importing {

namespace {

// What a chord of 8 mm leaves out of a circle of 16 mm: 0.5 mm.
constexpr double kMostAcross_mm = 8;
// A shaft's end may be cut askew, and its edge may be ragged.
constexpr double kLeastAlongShaft = 0.7, kMostBeyond_mm = 3;

// The mesh goes on beyond the hole's plane nowhere: something was cut off flat there.
bool is_end_of_shaft(const bones::FilledHole& hole, const geometry::TriangleMesh& mesh,
                     bones::BoneKind kind) {
  const double along_shaft = kind == bones::BoneKind::Femur ? hole.out.z() : -hole.out.z();
  return along_shaft > kLeastAlongShaft &&
         std::ranges::all_of(mesh.vertices_mm, [&](const Eigen::Vector3d& p) {
           return hole.out.dot(p - hole.at_mm) < kMostBeyond_mm;
         });
}

}  // namespace

std::vector<bones::FilledHole> wide_holes(std::vector<bones::FilledHole> filled,
                                          const geometry::TriangleMesh& mesh, bones::BoneKind kind) {
  std::erase_if(filled, [&](const bones::FilledHole& hole) {
    return hole.across_mm <= kMostAcross_mm || is_end_of_shaft(hole, mesh, kind);
  });
  return filled;
}

}  // namespace arthronaut::importing
