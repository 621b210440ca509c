#include "planning/import/shape_check.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <optional>
#include <utility>
#include <vector>

#include "planning/import/import_side.h"
#include "planning/landmarks/propose.h"

namespace arthronaut::importing {

namespace {

// Of a knee turned outwards by more than this in the scanner nobody has heard; half a turn is another file's
// axes.
constexpr double kMostTurned_deg = 120;

// The front of the bone, seen from above, against the patient's.
bool looks_backwards(const landmarks::AnatomicalAxes& axes) {
  Eigen::Vector2d front = axes.anterior.head<2>();
  if (front.norm() < 0.5) return false;  // it lies on its face: nothing is seen from above
  front.normalize();
  return -front.y() < std::cos(kMostTurned_deg * EIGEN_PI / 180);
}

}  // namespace

void check_shapes(BoneImport& import, bool fibula_was_seen) {
  // Seconds each, and they have nothing to do with each other.
  std::vector<std::pair<ImportedBone*, std::future<landmarks::Proposal>>> looked_at;
  for (ImportedBone& bone : import.bones) {
    if (bone.doubts.empty())
      looked_at.emplace_back(&bone,
                             std::async(std::launch::async, [mesh = &bone.bone.mesh, kind = bone.bone.kind] {
                               return landmarks::propose(*mesh, kind);
                             }));
  }
  std::size_t judged = 0;
  std::vector<ImportedBone*> backwards;
  for (auto& [bone, result] : looked_at) {
    const landmarks::Proposal proposal = result.get();
    if (!proposal.is_usable()) continue;
    ++judged;
    bone->shape_was_judged = !fibula_was_seen;
    if (!fibula_was_seen) bone->side_by_shape = proposal.side_by_shape;
    if (looks_backwards(proposal.axes)) backwards.push_back(bone);
  }
  // A coarse shape alone may be taken for turned; bones of one file are turned together.
  if (backwards.size() == judged) {
    for (ImportedBone* bone : backwards) {
      bone->looks_backwards = true;
      bone->doubts.emplace_back("its front looks to the patient's back: LPS and RAS may be mixed up");
    }
  }
  const auto shape = side_by_shapes(import);
  if (!shape || import.side || judged < 2) return;
  import.side = shape;
  import.side_source = SideSource::Shapes;
}

}  // namespace arthronaut::importing
