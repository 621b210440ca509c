#include "planning/import/hole_check.h"

#include <algorithm>
#include <cmath>

#include "planning/files/format.h"
#include "planning/geometry/handles.h"
#include "planning/geometry/rigid_transform.h"

namespace arthronaut::importing {

namespace {

// Of a tunnel of 5 mm 15.7 mm, and along a mesh's edges more.
constexpr double kLeastAround_mm = 16;

std::string hole_doubt(const std::vector<geometry::Handle>& holes) {
  const geometry::Handle& widest = *std::ranges::max_element(holes, {}, &geometry::Handle::around_mm);
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : widest.line_mm) at_mm += p / static_cast<double>(widest.line_mm.size());
  std::string doubt = files::format(
      "a hole about %.0f mm across goes right through it, at %.0f, %.0f, %.0f mm: a tunnel of an earlier "
      "operation, or bone that is missing? What is planned there counts it as bone",
      widest.around_mm / geometry::kPi, at_mm.x(), at_mm.y(), at_mm.z());
  if (holes.size() > 1) doubt += files::format("; %zu such holes in all", holes.size());
  return doubt;
}

}  // namespace

void check_holes(BoneImport& import) {
  for (ImportedBone& bone : import.bones) {
    const auto holes = geometry::handles_of(bone.bone.mesh, kLeastAround_mm);
    if (!holes.empty()) bone.doubts.push_back(hole_doubt(holes));
  }
}

}  // namespace arthronaut::importing
