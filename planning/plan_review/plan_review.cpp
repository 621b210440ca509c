#include "planning/plan_review/plan_review.h"

#include <utility>

#include "planning/norms/insertion_norms.h"

namespace arthronaut::plan_review {

using bones::BoneKind;

ReviewedBone review_bone(const geometry::TriangleMesh& mesh, BoneKind kind, bones::Side side,
                         const landmarks::Landmarks& landmarks,
                         std::shared_ptr<const geometry::Surface> surface) {
  ReviewedBone reviewed;
  reviewed.surroundings = tunnels::surroundings_of(mesh, kind, landmarks, side, surface);
  reviewed.footprint = norms::expected_footprint(mesh, *surface, kind, side, landmarks,
                                                 norms::default_norm(kind, norms::Bundle::Whole));
  if (reviewed.footprint) reviewed.surroundings.footprint_outline_mm = reviewed.footprint->outline_mm;
  reviewed.surface = std::move(surface);
  return reviewed;
}

std::vector<tunnels::PlanCheck> checks_of(BoneKind kind, const MeasuredTunnel& femoral,
                                          const MeasuredTunnel& tibial,
                                          const tunnels::PlanSurroundings& surroundings,
                                          const tunnels::KneeSurroundings& knee) {
  const MeasuredTunnel& own = kind == BoneKind::Femur ? femoral : tibial;
  if (own.tunnel == nullptr || own.geometry == nullptr) return {};
  auto checks = tunnels::check_plan(*own.tunnel, *own.geometry, surroundings);
  if (!own.geometry->enters_bone) return checks;
  const tunnels::KneePlan plan{femoral.tunnel, femoral.geometry, tibial.tunnel, tibial.geometry};
  for (tunnels::PlanCheck& check : tunnels::check_knee(kind, plan, knee)) checks.push_back(std::move(check));
  return checks;
}

CaseReview::CaseReview(const cases::Case& knee) {
  for (const auto& [kind, bone] : knee.bones) {
    if (bone.mesh.empty()) continue;
    const auto marks = knee.landmarks.find(kind);
    const ReviewedBone& reviewed =
        bones_
            .emplace(kind, review_bone(bone.mesh, kind, knee.side,
                                       marks == knee.landmarks.end() ? landmarks::Landmarks{} : marks->second,
                                       std::make_shared<const geometry::Surface>(bone.mesh)))
            .first->second;
    if (kind == BoneKind::Femur) knee_ = tunnels::knee_surroundings_of(bone.mesh, reviewed.surroundings);
    if (const auto planned = knee.plan.tunnels.find(kind); planned != knee.plan.tunnels.end())
      planned_.emplace(kind, Planned{planned->second, tunnels::measure(planned->second, *reviewed.surface)});
  }
}

MeasuredTunnel CaseReview::tunnel(BoneKind kind) const {
  const auto found = planned_.find(kind);
  if (found == planned_.end()) return {};
  return {&found->second.tunnel, &found->second.geometry};
}

std::vector<tunnels::PlanCheck> CaseReview::checks(BoneKind kind) const {
  if (!has_bone(kind)) return {};
  return checks_of(kind, tunnel(BoneKind::Femur), tunnel(BoneKind::Tibia), bone(kind).surroundings, knee_);
}

}  // namespace arthronaut::plan_review
