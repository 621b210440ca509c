// What to do next, named: the shortest way from an open case to a plan that can be taken to theatre.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/case/plan_model.h"

namespace arthronaut::plan {

struct NextStep {
  std::string text;    // "Place the entry of the femoral tunnel: press P, then click on the bone"
  std::string action;  // the id of the action that does it or begins it; empty: none
};

// Of a tunnel of one bundle that of the other one of its bone; nullopt of a single one.
[[nodiscard]] std::optional<tunnels::TunnelKey> other_bundle(const tunnels::TunnelKey& key);
// "femoral", "tibial AM": before "tunnel".
[[nodiscard]] std::string adjective(const tunnels::TunnelKey& key);

struct StepState {
  tunnels::TunnelKey key = bones::BoneKind::Femur;  // that is worked on
  bool places_entry = false;
  bool shows_landmarks = false;  // whose keys P, Enter and the arrows are then
  bool is_read_only = false, is_in_conflict = false;
  bool makes_default = false;        // the default plan is on its way
  bool is_unsaved = false;           // it could not be saved
  bool can_enter_elsewhere = false;  // within the norm's spread, where it does better
  std::string side_doubt = {};       // what of the bones contradicts the case's side; empty: nothing does
  std::size_t bone_doubts = 0;       // all that spoke against the bones
};

// The first of what is missing: an answer to a conflict, the right side, an entry, a look at the landmarks
// that it was put by, a tunnel that can be drilled, the other bundle's, the other bone's; else to theatre.
[[nodiscard]] NextStep next_step(const open_case::PlanModel& model, const StepState& state);

// The same checks, for as long as they are there, with what speaks against the tunnel first: wrong, to be
// looked at, then the rest, each as they were.
[[nodiscard]] std::vector<const tunnels::PlanCheck*> worst_first(
    const std::vector<tunnels::PlanCheck>& checks);

// How much is to be looked at in the plan of both bones: of their tunnels, what is said of several once, and
// of their grids.
[[nodiscard]] std::size_t warning_count(const open_case::PlanModel& model);

// The landmarks without which the bone has no default plan, by their titles; empty where one can be made.
// Precondition: has_bone(bone).
[[nodiscard]] std::vector<std::string> missing_for_default(const open_case::PlanModel& model,
                                                           bones::BoneKind bone);

// Whether the bone's grid follows from points that nobody has looked at; whether a check of one of its
// tunnels says that it is wrong. Precondition: has_bone(bone).
[[nodiscard]] bool has_unconfirmed_grid(const open_case::PlanModel& model, bones::BoneKind bone);
[[nodiscard]] bool has_wrong_check(const open_case::PlanModel& model, bones::BoneKind bone);

}  // namespace arthronaut::plan
