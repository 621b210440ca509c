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

// "\"A\", \"B\" and \"C\"": a landmark's title may hold a comma.
std::string listed(const std::vector<std::string>& names) {
  std::string words;
  for (std::size_t i = 0; i < names.size(); ++i)
    words += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + ("\"" + names[i] + "\"");
  return words;
}

NextStep to_theatre(const open_case::PlanModel& model, const StepState& state) {
  const std::size_t count = warning_count(model) + state.bone_doubts;
  return {
      "The plan can be taken to theatre" +
          (count == 0 ? "" : ", with " + std::to_string(count) + (count == 1 ? " warning" : " warnings")) +
          ": set up the arthroscope. Ctrl+E exports it; F3, then R, writes its report",
      "mode.setup"};
}

// Whether the bone's own landmarks give what a default is aimed by.
bool has_joint(const open_case::PlanModel& model, BoneKind bone) {
  return model.footprint(bone) != nullptr &&
         model.axes(bone).origin == landmarks::AnatomicalAxes::Origin::FromLandmarks &&
         (bone == BoneKind::Tibia || model.knee_surroundings().axis);
}

}  // namespace

std::vector<const tunnels::PlanCheck*> worst_first(const std::vector<tunnels::PlanCheck>& checks) {
  std::vector<const tunnels::PlanCheck*> in_order;
  const auto add = [&](const auto& belongs) {
    for (const tunnels::PlanCheck& check : checks)
      if (belongs(check.verdict)) in_order.push_back(&check);
  };
  add([](Verdict verdict) { return verdict == Verdict::Wrong; });
  add([](Verdict verdict) { return verdict == Verdict::Look; });
  add([](Verdict verdict) { return verdict != Verdict::Wrong && verdict != Verdict::Look; });
  return in_order;
}

std::size_t warning_count(const open_case::PlanModel& model) {
  std::vector<const tunnels::PlanCheck*> said;
  std::size_t grids = 0;
  for (const BoneKind bone : {BoneKind::Femur, BoneKind::Tibia}) {
    bool is_planned = false;
    for (const auto& [key, tunnel] : model.tunnels()) {
      if (key.bone != bone) continue;
      is_planned = true;
      for (const tunnels::PlanCheck& check : model.checks(key)) {
        // What is said of both tunnels of a pair is one.
        const auto is_same = [&](const tunnels::PlanCheck* other) {
          return other->name == check.name && other->text == check.text;
        };
        if (check.verdict == Verdict::Look && std::ranges::none_of(said, is_same)) said.push_back(&check);
      }
    }
    if (is_planned && model.surroundings(bone).has_grid() &&
        !landmarks::is_grid_confirmed(bone, model.landmarks(bone), model.landmark_states(bone)))
      ++grids;
  }
  return said.size() + grids;
}

std::vector<std::string> missing_for_default(const open_case::PlanModel& model, BoneKind bone) {
  if (has_joint(model, bone)) return {};
  // What the shape gives takes the place of what is missing.
  if (const auto& proposal = model.proposal(bone); !proposal || proposal->is_usable()) return {};
  std::vector<std::string> titles;
  for (const std::string& name : landmarks::grid_landmarks(bone, model.landmarks(bone))) {
    if (model.landmarks(bone).contains(name)) continue;
    const landmarks::LandmarkKind* const kind = landmarks::find_landmark(bone, name);
    titles.push_back(kind == nullptr ? name : std::string(kind->title));
  }
  return titles;
}

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
  if (!state.side_doubt.empty())
    return {"Check the side first: " + state.side_doubt + ". Press J and say which knee it is", "plan.side"};
  if (state.makes_default) return {"Wait for the default plan, then move it; Esc leaves it", ""};
  if (state.places_entry) return {"Click on the " + bone + " where the tunnel begins", ""};
  if (!model.has_bone(here)) return {"This case has no " + bone + ": plan the other bone", "plan.bone"};
  // The default would move what is planned of the other bundle.
  const auto beside = other_bundle(state.key);
  const bool wants_default = !model.tunnel(state.key) && !(beside && model.tunnel(*beside));
  if (const auto missing = wants_default ? missing_for_default(model, here) : std::vector<std::string>{};
      !missing.empty())
    return {"For a default plan " + listed(missing) + (missing.size() == 1 ? " is" : " are") + " missing: " +
                (state.shows_landmarks ? "choose each in the list, press P and click where it is"
                                       : "press L, then P for each. Or press P and place the entry by hand"),
            state.shows_landmarks ? "plan.landmark_place" : "plan.landmarks_page"};
  if (wants_default && model.footprint(here))
    return {"Make the default plan, then move it: press N", "plan.default"};
  if (!model.tunnel(state.key) && state.shows_landmarks)
    return {"Place the entry of the " + adjective(state.key) + " tunnel: press C, then P",
            "plan.checks_page"};
  if (!model.tunnel(state.key))
    return {"Place the entry of the " + adjective(state.key) + " tunnel: press P, then click on the bone",
            "plan.place"};
  // By them it was put, and everything is told where it lies.
  if (has_unconfirmed_grid(model, here) && state.shows_landmarks)
    return {"Look at each landmark of the " + bone + ": Enter confirms it, or drag it",
            "plan.landmark_confirm"};
  if (has_unconfirmed_grid(model, here))
    return {"Look at the " + bone + "'s landmarks, which nobody has confirmed: press L",
            "plan.landmarks_page"};
  const auto& checks = model.checks(state.key);
  const auto wrong = std::find_if(checks.begin(), checks.end(), [](const tunnels::PlanCheck& check) {
    return check.verdict == Verdict::Wrong;
  });
  if (wrong != checks.end())
    return {"Mend the " + adjective(state.key) + " tunnel: " + wrong->name +
                (state.can_enter_elsewhere
                     ? ". Shift+N enters beside it, where nothing is wrong; or drag it"
                     : ". Drag its entry (M shows where to) or its aim, or take another diameter"),
            state.can_enter_elsewhere ? "plan.within_spread" : ""};
  if (beside) {
    if (!model.tunnel(*beside))
      return {"Plan the " + adjective(*beside) + " tunnel too: press B", "plan.other_bundle"};
    if (is_wrong(model, *beside))
      return {"Mend the " + adjective(*beside) + " tunnel: press B", "plan.other_bundle"};
  }
  if (!model.has_bone(other)) return to_theatre(model, state);
  const auto others = model.knee().plan.of(other);
  if (others.empty()) return {"Plan the " + adjective(other) + " tunnel: press Tab", "plan.bone"};
  if (has_unconfirmed_grid(model, other))
    return {"Look at the " + std::string(bones::to_text(other)) +
                "'s landmarks, which nobody has confirmed: press Tab" +
                (state.shows_landmarks ? "" : ", then L"),
            "plan.bone"};
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
  return to_theatre(model, state);
}

}  // namespace arthronaut::plan
