#include "planning/plan_review/plan_review.h"

#include <algorithm>
#include <utility>

#include "planning/norms/insertion_norms.h"
#include "planning/plan_review/landmark_check.h"
#include "planning/plan_review/tunnel_verdict.h"

namespace arthronaut::plan_review {

using bones::BoneKind;

ReviewedBone review_bone(const geometry::TriangleMesh& mesh, BoneKind kind, bones::Side side,
                         const landmarks::Landmarks& landmarks,
                         std::shared_ptr<const geometry::Surface> surface) {
  ReviewedBone reviewed;
  reviewed.surroundings = tunnels::surroundings_of(mesh, kind, landmarks, side, surface);
  for (const auto bundle :
       {norms::Bundle::Whole, norms::Bundle::Anteromedial, norms::Bundle::Posterolateral}) {
    auto footprint =
        norms::expected_footprint(mesh, *surface, kind, side, landmarks, norms::default_norm(kind, bundle));
    if (!footprint) continue;
    reviewed.surroundings.footprints[bundle] = geometry::patch_within(*surface, footprint->outline_mm);
    reviewed.footprints.emplace(bundle, std::move(*footprint));
  }
  reviewed.surface = std::move(surface);
  return reviewed;
}

void put_bone(tunnels::KneeSurroundings& knee, BoneKind kind, const ReviewedBone& bone) {
  if (kind == BoneKind::Femur) {
    tunnels::put_femur(knee, bone.surface->mesh(), bone.surroundings);
  } else {
    tunnels::put_tibia(knee, bone.surroundings);
  }
  std::erase_if(knee.insertions_mm, [&](const auto& one) { return one.first.bone == kind; });
  for (const auto& [bundle, footprint] : bone.footprints)
    knee.insertions_mm[{kind, bundle}] = footprint.center_mm;
  if (const auto& native = bone.surroundings.native_footprint_mm) knee.insertions_mm[kind] = *native;
}

const MeasuredTunnel* other_end(const tunnels::TunnelKey& key, const MeasuredPlan& plan) {
  const BoneKind other = key.bone == BoneKind::Femur ? BoneKind::Tibia : BoneKind::Femur;
  auto found = plan.find({other, key.bundle});
  if (found == plan.end()) found = plan.find(other);
  return found == plan.end() ? nullptr : &found->second;
}

std::vector<tunnels::PlanCheck> further_checks(const tunnels::TunnelKey& key, const MeasuredPlan& plan,
                                               const tunnels::KneeSurroundings& knee) {
  const MeasuredTunnel& own = plan.at(key);
  std::vector<tunnels::PlanCheck> checks;
  for (const auto& [other_key, other] : plan) {
    if (other_key.bone == key.bone && other_key != key && other.geometry.enters_bone)
      checks.push_back(tunnels::check_pair(own.tunnel, own.geometry, other.tunnel, other.geometry));
  }
  const MeasuredTunnel* end = other_end(key, plan);
  const bool is_femur = key.bone == BoneKind::Femur;
  const MeasuredTunnel *femoral = is_femur ? &own : end, *tibial = is_femur ? end : &own;
  tunnels::KneePlan graft{.graft = key.bundle};
  graft.has_other_tunnels = end == nullptr && std::ranges::any_of(plan, [&](const auto& one) {
                              return one.first.bone != key.bone;
                            });
  if (femoral != nullptr) {
    graft.femoral = &femoral->tunnel;
    graft.femoral_measured = &femoral->geometry;
  }
  if (tibial != nullptr) {
    graft.tibial = &tibial->tunnel;
    graft.tibial_measured = &tibial->geometry;
  }
  for (tunnels::PlanCheck& check : tunnels::check_knee(key.bone, graft, knee))
    checks.push_back(std::move(check));
  return checks;
}

std::vector<tunnels::PlanCheck> checks_of(const tunnels::TunnelKey& key, const MeasuredPlan& plan,
                                          const tunnels::PlanSurroundings& surroundings,
                                          const tunnels::KneeSurroundings& knee,
                                          const tunnels::PlanCheck& of_landmarks) {
  const auto own = plan.find(key);
  if (own == plan.end()) return {};
  auto checks = tunnels::check_plan(own->second.tunnel, own->second.geometry, surroundings);
  if (!own->second.geometry.enters_bone) return checks;
  checks.push_back(of_landmarks);
  for (tunnels::PlanCheck& check : further_checks(key, plan, knee)) checks.push_back(std::move(check));
  return checks;
}

std::vector<tunnels::PlanCheck> as_side_is_doubted(std::vector<tunnels::PlanCheck> checks,
                                                   const std::string& side_doubt) {
  if (side_doubt.empty()) return checks;
  for (tunnels::PlanCheck& check : checks)
    if (check.verdict == tunnels::PlanCheck::Verdict::Fine && check.rests_on_side)
      check = {.verdict = tunnels::PlanCheck::Verdict::NotChecked,
               .name = check.name,
               .text = "not checked: the side is in doubt"};
  return checks;
}

CaseReview::CaseReview(const cases::Case& knee, const std::map<bones::BoneKind, ProposedBone>& by_shape,
                       const cases::BoneDoubts& doubts)
    : side_doubt_(side_doubt(doubts)) {
  knee_.is_of_two_frames = knee.is_of_two_frames;
  for (const auto& [kind, bone] : knee.bones) {
    if (bone.mesh.empty()) continue;
    const auto known = knee.landmarks.find(kind);
    const auto marks = known == knee.landmarks.end() ? landmarks::Landmarks{} : known->second;
    const auto proposed = by_shape.find(kind);
    auto surface = proposed == by_shape.end() ? nullptr : proposed->second.surface;
    if (!surface) surface = std::make_shared<const geometry::Surface>(bone.mesh);
    ReviewedBone& reviewed =
        bones_.emplace(kind, review_bone(bone.mesh, kind, knee.side, marks, std::move(surface)))
            .first->second;
    reviewed.surroundings.unseen = cases::unseen_parts_of(doubts, bone);
    const auto states = knee.landmark_states.find(kind);
    landmark_checks_[kind] = check_landmarks(
        kind, marks, states == knee.landmark_states.end() ? landmarks::LandmarkStates{} : states->second,
        proposed == by_shape.end() ? nullptr : &proposed->second.proposal);
    put_bone(knee_, kind, reviewed);
    for (const tunnels::TunnelKey& key : knee.plan.of(kind)) {
      const tunnels::Tunnel& tunnel = knee.plan.tunnels.at(key);
      planned_.emplace(key, MeasuredTunnel{tunnel, tunnels::measure(tunnel, *reviewed.surface)});
    }
  }
}

std::vector<tunnels::PlanCheck> CaseReview::checks(const tunnels::TunnelKey& key) const {
  if (!has_bone(key.bone)) return {};
  return as_side_is_doubted(
      checks_of(key, planned_, bone(key.bone).surroundings, knee_, landmark_check(key.bone)), side_doubt_);
}

}  // namespace arthronaut::plan_review
