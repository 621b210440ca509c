#include "planning/import/shape_check.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "planning/landmarks/propose.h"

namespace arthronaut::importing {

namespace {

// Of a knee turned outwards by more than this in the scanner nobody has heard; half a turn is another file's
// axes.
constexpr double kMostTurned_deg = 120;

std::string word_of(bones::Side side) { return std::string(bones::to_text(side)); }

// The front of the bone, seen from above, against the patient's.
bool looks_backwards(const landmarks::AnatomicalAxes& axes) {
  Eigen::Vector2d front = axes.anterior.head<2>();
  if (front.norm() < 0.5) return false;  // it lies on its face: nothing is seen from above
  front.normalize();
  return -front.y() < std::cos(kMostTurned_deg * EIGEN_PI / 180);
}

}  // namespace

std::string other_side_by_shape(bones::Side shape, bones::Side said, bool of_both) {
  return "by the shape of " + std::string(of_both ? "both bones" : "the bone") + " it is a " +
         word_of(shape) + " knee, but the side is " + word_of(said) + ": check the side";
}

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
  std::vector<std::optional<bones::Side>> told;
  std::vector<ImportedBone*> backwards;
  for (auto& [bone, result] : looked_at) {
    const landmarks::Proposal proposal = result.get();
    if (!proposal.is_usable()) continue;
    told.push_back(proposal.side_by_shape);
    if (looks_backwards(proposal.axes)) backwards.push_back(bone);
  }
  // A coarse shape alone may be taken for turned; bones of one file are turned together.
  if (backwards.size() == told.size()) {
    for (ImportedBone* bone : backwards) {
      bone->looks_backwards = true;
      bone->doubts.emplace_back("its front looks to the patient's back: LPS and RAS may be mixed up");
    }
  }
  const bool agree =
      !told.empty() && told.front() && std::ranges::count(told, told.front()) == std::ssize(told);
  if (fibula_was_seen || !agree) return;
  const std::string seen = word_of(*told.front());
  if (import.side && *import.side != *told.front()) {
    import.side_is_contradicted = true;
    import.bones.front().doubts.push_back(other_side_by_shape(*told.front(), *import.side, told.size() > 1));
  }
  if (!import.side && told.size() > 1) {
    import.side = told.front();
    import.side_was_seen = import.side_is_by_shape = true;
    import.bones.front().doubts.push_back("that it is a " + seen +
                                          " knee is told by the shape of its bones alone: check the side");
  }
}

}  // namespace arthronaut::importing
