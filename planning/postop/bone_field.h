// How far it is, everywhere in a CT, to the nearest surface of anything as bright as bone; and the poses from
// nothing that a plan's bone may have there. Inner header of postop.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "planning/geometry/rigid_transform.h"
#include "planning/images/volume.h"
#include "planning/postop/goes_on.h"
#include "planning/postop/surface_samples.h"

namespace arthronaut::postop {

// In cells of about 2 mm, with room around the volume.
struct BoneField {
  Eigen::Affine3d cell_from_lps = Eigen::Affine3d::Identity();
  Eigen::Vector3i size = Eigen::Vector3i::Zero();
  Eigen::Vector3d first_in_view, last_in_view;  // cells between which the volume lies
  bool is_cut = false;                          // whether bone goes on where the volume ends
  double bone_mm3 = 0;                          // of all large pieces, what they enclose counted in
  std::vector<float> distance_mm;               // i runs fastest
  // Where the middle of a joint's end may lie, LPS: places along large pieces.
  std::vector<Eigen::Vector3d> anchors_mm;

  // Those that lie so near to where the volume ends.
  [[nodiscard]] std::vector<Eigen::Vector3d> anchors_near_an_end(double within_mm) const;
};

// nullopt: nothing large is above the threshold.
[[nodiscard]] std::optional<BoneField> bone_field(const images::Volume& volume, double threshold_hu);

struct CoarsePose {
  geometry::RigidTransform postop_from_plan;
  double cost_mm = 0;  // mean over the samples of the distance, no sample counting more than 6 mm
};

// Which turns are tried: those near to the patient's lying as he did, or all others.
enum class Turns { Small, Large };

// The best poses of the samples from these anchors, best first, each somewhere else than those before it;
// none where it was ended.
[[nodiscard]] std::vector<CoarsePose> coarse_poses(const BoneField& field,
                                                   std::span<const Eigen::Vector3d> anchors_mm,
                                                   std::span<const SurfaceSample> samples, Turns turns,
                                                   const GoesOn& goes_on);

}  // namespace arthronaut::postop
