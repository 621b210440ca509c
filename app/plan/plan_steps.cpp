#include "app/plan/plan_steps.h"

#include <algorithm>

#include "planning/landmarks/grid_landmarks.h"

namespace arthronaut::plan {

namespace {

using bones::BoneKind;
using Verdict = tunnels::PlanCheck::Verdict;

bool is_wrong(const open_case::PlanModel& model, const tunnels::TunnelKey& key) {
  return std::ranges::any_of(model.checks(key),
                             [](const tunnels::PlanCheck& check) { return check.verdict == Verdict::Wrong; });
}

}  // namespace

bool has_unconfirmed_grid(const open_case::PlanModel& model, BoneKind bone) {
  const auto& states = model.landmark_states(bone);
  return std::ranges::any_of(landmarks::grid_landmarks(bone, model.landmarks(bone)), [&](const auto& name) {
    return landmarks::state_of(states, name) == landmarks::LandmarkState::Proposed;
  });
}

bool has_wrong_check(const open_case::PlanModel& model, BoneKind bone) {
  return std::ranges::any_of(model.knee().plan.of(bone),
                             [&](const tunnels::TunnelKey& key) { return is_wrong(model, key); });
}

std::optional<tunnels::TunnelKey> other_bundle(const tunnels::TunnelKey& key) {
  if (key.bundle == norms::Bundle::Whole) return std::nullopt;
  return tunnels::TunnelKey{key.bone, key.bundle == norms::Bundle::Anteromedial
                                          ? norms::Bundle::Posterolateral
                                          : norms::Bundle::Anteromedial};
}

std::string adjective(const tunnels::TunnelKey& key) {
  const std::string bone = key.bone == BoneKind::Femur ? "femoral" : "tibial";
  return key.bundle == norms::Bundle::Whole          ? bone
         : key.bundle == norms::Bundle::Anteromedial ? bone + " AM"
                                                     : bone + " PL";
}

NextStep next_step(const open_case::PlanModel& model, const StepState& state) {
  const BoneKind here = state.key.bone;
  const std::string bone(bones::to_text(here));
  const BoneKind other = here == BoneKind::Femur ? BoneKind::Tibia : BoneKind::Femur;
  if (state.is_read_only) return {"Look only: why the plan cannot be changed is said below", ""};
  if (state.is_in_conflict) return {"Take the other program's plan, or keep this one", "plan.take_theirs"};
  if (state.is_unsaved)
    return {"The plan is not saved: mend what is said below. It is tried again by itself", ""};
  if (state.makes_default) return {"Wait for the default plan, then move it; Esc leaves it", ""};
  if (state.places_entry) return {"Click on the " + bone + " where the tunnel begins", ""};
  if (!model.has_bone(here)) return {"This case has no " + bone + ": plan the other bone", "plan.bone"};
  // The default would move what is planned of the other bundle.
  const auto beside = other_bundle(state.key);
  if (!model.tunnel(state.key) && model.footprint(here) && !(beside && model.tunnel(*beside)))
    return {"Make the default plan, then move it: press N", "plan.default"};
  if (!model.tunnel(state.key) && state.shows_landmarks)
    return {"Place the entry of the " + adjective(state.key) + " tunnel: press C, then P",
            "plan.checks_page"};
  if (!model.tunnel(state.key))
    return {"Place the entry of the " + adjective(state.key) + " tunnel: press P, then click on the bone",
            "plan.place"};
  const auto& checks = model.checks(state.key);
  const auto wrong = std::find_if(checks.begin(), checks.end(), [](const tunnels::PlanCheck& check) {
    return check.verdict == Verdict::Wrong;
  });
  if (wrong != checks.end())
    return {"Mend the " + adjective(state.key) + " tunnel: " + wrong->name +
                ". Drag its entry or its aim, or take another diameter",
            ""};
  if (beside) {
    if (!model.tunnel(*beside))
      return {"Plan the " + adjective(*beside) + " tunnel too: press B", "plan.other_bundle"};
    if (is_wrong(model, *beside))
      return {"Mend the " + adjective(*beside) + " tunnel: press B", "plan.other_bundle"};
  }
  if (has_unconfirmed_grid(model, here) && state.shows_landmarks)
    return {"Look at each landmark of the " + bone + ": Enter confirms it, or drag it",
            "plan.landmark_confirm"};
  if (has_unconfirmed_grid(model, here))
    return {"Look at the " + bone + "'s landmarks, which nobody has confirmed: press L",
            "plan.landmarks_page"};
  if (!model.has_bone(other))
    return {"The plan can be taken to theatre: set up the arthroscope", "mode.setup"};
  const auto others = model.knee().plan.of(other);
  if (others.empty()) return {"Plan the " + adjective(other) + " tunnel: press Tab", "plan.bone"};
  for (const tunnels::TunnelKey& key : others) {
    if (const auto missing = other_bundle(key); missing && !model.tunnel(*missing))
      return {"Plan the " + adjective(*missing) + " tunnel too: press Tab", "plan.bone"};
    if (is_wrong(model, key)) return {"Mend the " + adjective(key) + " tunnel: press Tab", "plan.bone"};
  }
  const bool is_single = !beside, other_is_single = !other_bundle(others.front());
  if (is_single != other_is_single) {
    const std::string other_bone(bones::to_text(other));
    return {"The " + (is_single ? bone : other_bone) + " has one tunnel and the " +
                (is_single ? other_bone : bone) + " two, which is seldom meant: press " +
                (is_single ? "B" : "Tab, then B") + " for two in both",
            is_single ? "plan.bundles" : "plan.bone"};
  }
  return {"The plan can be taken to theatre: set up the arthroscope", "mode.setup"};
}

}  // namespace arthronaut::plan
