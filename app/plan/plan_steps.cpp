#include "app/plan/plan_steps.h"

#include <algorithm>

namespace arthronaut::plan {

namespace {

using bones::BoneKind;
using Verdict = tunnels::PlanCheck::Verdict;

std::string adjective(BoneKind bone) { return bone == BoneKind::Femur ? "femoral" : "tibial"; }

}  // namespace

bool has_unconfirmed_grid(const open_case::PlanModel& model, BoneKind bone) {
  const auto& states = model.landmark_states(bone);
  return std::any_of(states.begin(), states.end(), [](const auto& one) {
    return (one.first.starts_with("blumensaat_") || one.first.starts_with("plateau_")) &&
           one.second == landmarks::LandmarkState::Proposed;
  });
}

bool has_wrong_check(const open_case::PlanModel& model, BoneKind bone) {
  const auto& checks = model.checks(bone);
  return std::any_of(checks.begin(), checks.end(),
                     [](const tunnels::PlanCheck& check) { return check.verdict == Verdict::Wrong; });
}

NextStep next_step(const open_case::PlanModel& model, const StepState& state) {
  const std::string bone(bones::to_text(state.bone));
  const BoneKind other = state.bone == BoneKind::Femur ? BoneKind::Tibia : BoneKind::Femur;
  if (state.is_read_only) return {"Look only: another program has this case open", ""};
  if (state.is_in_conflict) return {"Take the other program's plan, or keep this one", "plan.take_theirs"};
  if (state.places_entry) return {"Click on the " + bone + " where the tunnel begins", ""};
  if (!model.has_bone(state.bone)) return {"This case has no " + bone + ": plan the other bone", "plan.bone"};
  if (!model.tunnel(state.bone) && model.footprint(state.bone))
    return {"Make the default plan, then move it: press N", "plan.default"};
  if (!model.tunnel(state.bone))
    return {"Place the entry of the " + adjective(state.bone) + " tunnel: press P, then click on the bone",
            "plan.place"};
  const auto& checks = model.checks(state.bone);
  const auto wrong = std::find_if(checks.begin(), checks.end(), [](const tunnels::PlanCheck& check) {
    return check.verdict == Verdict::Wrong;
  });
  if (wrong != checks.end()) return {"Mend the " + adjective(state.bone) + " tunnel: " + wrong->name, ""};
  if (has_unconfirmed_grid(model, state.bone))
    return {"Look at the " + bone + "'s landmarks, which nobody has confirmed: press L",
            "plan.landmarks_page"};
  if (model.has_bone(other) && !model.tunnel(other))
    return {"Plan the " + adjective(other) + " tunnel: press Tab", "plan.bone"};
  if (model.has_bone(other)) {
    if (has_wrong_check(model, other))
      return {"Mend the " + adjective(other) + " tunnel: press Tab", "plan.bone"};
  }
  return {"The plan can be taken to theatre: set up the arthroscope", "mode.setup"};
}

}  // namespace arthronaut::plan
