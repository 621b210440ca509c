// What a plan of both bones is asked: the graft between the two tunnels. Femur and tibia lie in the same
// frame of the case (LPS), as they were imaged, which is taken for the knee in extension; planning/graft says
// by what models. Where they do not, nothing is asked (knee_pose.h).
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "planning/graft/flexion_axis.h"
#include "planning/tunnels/plan_checks.h"

namespace arthronaut::tunnels {

// What is known of the knee beside its tunnels. Made once a case.
struct KneeSurroundings {
  std::optional<graft::FlexionAxis> axis = {};
  std::optional<landmarks::AnatomicalAxes> femur_axes = {};
  landmarks::Landmarks femur_landmarks = {};
  // By landmarks, else by shape; and which way is lateral, where landmarks tell it.
  std::optional<Eigen::Vector3d> plateau_middle_mm = {};
  std::optional<landmarks::AnatomicalAxes> tibia_axes = {};
  std::map<bones::BoneKind, std::vector<bones::ImageCut>> image_cuts = {};
  bool is_of_two_frames = false;  // of reference, as the bones' images say themselves (cases::Case)
  // Where the ligament and its bundles were attached, middles, as imaged: what a graft is compared with over
  // flexion. A missing one is unknown.
  std::map<TunnelKey, Eigen::Vector3d> insertions_mm = {};
};
// What a bone says of it, in place of what was said of the bone before; the insertions are left as they are.
void put_femur(KneeSurroundings& knee, const geometry::TriangleMesh& femur, const PlanSurroundings& of_femur);
void put_tibia(KneeSurroundings& knee, const PlanSurroundings& of_tibia);

// One graft and its two tunnels, as measured; null where there is none.
struct KneePlan {
  const Tunnel* femoral = nullptr;
  const TunnelGeometry* femoral_measured = nullptr;
  const Tunnel* tibial = nullptr;
  const TunnelGeometry* tibial_measured = nullptr;
  norms::Bundle graft = norms::Bundle::Whole;
  // Of a null one: the bone has tunnels, of other grafts.
  bool has_other_tunnels = false;
};

// Femur: length of the graft in the joint, held against studies of the whole ligament, and in all, its change
// over flexion, how that differs from a graft between the insertions' middles, its bend at the femur. The
// change is judged by its customary limit only where those insertions keep it themselves in the same model;
// else it is a note. Tibia: the roof in extension, which asks for the tibial tunnel alone and is not judged
// in a knee that was imaged flexed (by the axes of both bones, where both are known) unless it presses
// already, the bend at the tibia. Both: the diameters of the graft's two tunnels, where they differ. What
// lacks a tunnel, an axis or Blumensaat's line is said to be not checked; of bones that do not lie in one
// frame all of it is.
[[nodiscard]] std::vector<PlanCheck> check_knee(bones::BoneKind bone, const KneePlan& plan,
                                                const KneeSurroundings& surroundings,
                                                const PlanNorms& norms = {});

// The bone between two tunnels of one bone. Precondition: both enter it.
[[nodiscard]] PlanCheck check_pair(const Tunnel& first, const TunnelGeometry& first_measured,
                                   const Tunnel& second, const TunnelGeometry& second_measured,
                                   const PlanNorms& norms = {});

}  // namespace arthronaut::tunnels
