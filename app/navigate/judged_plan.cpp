#include "app/navigate/judged_plan.h"

#include <stdexcept>

#include "planning/landmarks/grid_landmarks.h"

namespace arthronaut::navigate {

void JudgedPlan::open(const std::filesystem::path& case_folder) {
  *this = {};
  if (case_folder.empty()) return;
  try {
    doubts_ = cases::load_bone_doubts(case_folder);
  } catch (const std::runtime_error&) {
    const std::vector<cases::BoneDoubt> unread = {"what spoke against it cannot be read"};
    doubts_ = {{bones::BoneKind::Femur, unread}, {bones::BoneKind::Tibia, unread}};
  }
}

void JudgedPlan::judge(const open_case::PlanModel& model,
                       const std::optional<operation::PlannedTunnel>& plan) {
  const bool by_shape =
      plan && model.has_bone(plan->tunnel.bone) && model.proposal(plan->tunnel.bone).has_value();
  if (revision_ == model.revision() && of_ == plan && by_shape_ == by_shape) return;
  revision_ = model.revision();
  of_ = plan;
  by_shape_ = by_shape;
  verdict_ = {};
  if (!plan || !model.has_bone(plan->tunnel.bone)) return;
  const tunnels::TunnelKey key = plan->tunnel.key();
  const bones::BoneKind bone = key.bone;
  // As it guides, which may not be what Plan shows by now.
  plan_review::MeasuredPlan measured = model.tunnels();
  measured.insert_or_assign(
      key, plan_review::MeasuredTunnel{plan->tunnel, tunnels::measure(plan->tunnel, model.surface(bone))});
  const auto checks = plan_review::checks_of(key, measured, model.surroundings(bone),
                                             model.knee_surroundings(), model.landmark_check(bone));
  verdict_ = plan_review::verdict_of(
      plan->tunnel, checks, doubts_,
      model.surroundings(bone).has_grid()
          ? landmarks::grid_doubt(bone, model.landmarks(bone), model.landmark_states(bone))
          : "");
}

}  // namespace arthronaut::navigate
