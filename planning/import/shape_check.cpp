#include "planning/import/shape_check.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <optional>
#include <utility>
#include <vector>

#include "planning/import/import_side.h"
#include "planning/landmarks/propose.h"
#include "planning/segmentation/anatomy_check.h"

namespace arthronaut::importing {

namespace {

// Of a knee turned outwards by more than this in the scanner nobody has heard; half a turn is another file's
// axes.
constexpr double kMostTurned_deg = 120;

// No knee is imaged with its bones further from upright: the shaft tells by its axis, which a proposal finds
// to 25 degrees where all goes wrong.
constexpr double kMostLeaning_deg = 60;

// That the file's axes are not the patient's; empty where the bone stands, or where its shape does not tell:
// put upright by axes that are not its own it would not be that bone.
std::string lying_doubt(const geometry::TriangleMesh& mesh, bones::BoneKind kind,
                        const landmarks::Proposal& proposal) {
  const landmarks::AnatomicalAxes& axes = proposal.axes;
  if (!proposal.is_usable() || axes.proximal.z() > std::cos(kMostLeaning_deg * EIGEN_PI / 180)) return "";
  Eigen::Matrix3d upright_from_file;
  upright_from_file << axes.proximal.cross(axes.anterior).transpose(), -axes.anterior.transpose(),
      axes.proximal.transpose();
  geometry::TriangleMesh upright = mesh;
  for (Eigen::Vector3d& p : upright.vertices_mm) p = upright_from_file * p;
  if (!segmentation::anatomy_doubts(upright, kind).empty()) return "";
  return segmentation::wrong_axes_doubt(
      kind, kind == bones::BoneKind::Femur ? axes.proximal : Eigen::Vector3d(-axes.proximal));
}

// The front of the bone, seen from above, against the patient's.
bool looks_backwards(const landmarks::AnatomicalAxes& axes) {
  Eigen::Vector2d front = axes.anterior.head<2>();
  if (front.norm() < 0.5) return false;  // it lies on its face: nothing is seen from above
  front.normalize();
  return -front.y() < std::cos(kMostTurned_deg * EIGEN_PI / 180);
}

}  // namespace

std::vector<std::string> shape_doubts(const geometry::TriangleMesh& mesh, bones::BoneKind kind,
                                      std::span<const Eigen::Vector3d> image_ends) {
  auto doubts = segmentation::anatomy_doubts(mesh, kind, image_ends);
  if (doubts.empty()) return doubts;
  std::string lying = lying_doubt(mesh, kind, landmarks::propose(mesh, kind));
  return lying.empty() ? doubts : std::vector{std::move(lying)};
}

void check_shapes(BoneImport& import, bool fibula_was_seen) {
  // Seconds each, and they have nothing to do with each other.
  std::vector<std::pair<ImportedBone*, std::future<landmarks::Proposal>>> looked_at;
  for (ImportedBone& bone : import.bones) {
    if (bone.doubts.empty() && bone.filled_holes.empty())
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
    // Of one that lies nobody sees its front from above.
    if (std::string lying = lying_doubt(bone->bone.mesh, bone->bone.kind, proposal); !lying.empty())
      bone->doubts.push_back(std::move(lying));
    else if (looks_backwards(proposal.axes))
      backwards.push_back(bone);
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
