#include "planning/import/filled_check.h"

#include <algorithm>

#include "planning/files/format.h"

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

std::vector<std::string> filled_doubts(const std::vector<bones::FilledHole>& filled,
                                       const geometry::TriangleMesh& mesh, bones::BoneKind kind) {
  const bones::FilledHole* widest = nullptr;
  std::size_t count = 0;
  for (const bones::FilledHole& hole : filled) {
    if (hole.across_mm <= kMostAcross_mm || is_end_of_shaft(hole, mesh, kind)) continue;
    ++count;
    if (widest == nullptr || hole.across_mm > widest->across_mm) widest = &hole;
  }
  if (widest == nullptr) return {};
  std::string doubt = files::format(
      "a hole of its surface about %.0f mm across, at %.0f, %.0f, %.0f mm, was filled in: the surface there "
      "is made up, and no entry on it can be relied on",
      widest->across_mm, widest->at_mm.x(), widest->at_mm.y(), widest->at_mm.z());
  if (count > 1) doubt += files::format("; %zu such holes in all", count);
  return {std::move(doubt)};
}

}  // namespace arthronaut::importing
