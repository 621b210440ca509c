// What a mode asks the plan's history to do, and what the history says of itself.
#pragma once

#include <optional>
#include <string>

#include "planning/tunnels/tunnel.h"

namespace arthronaut::open_case {

// A change that the surgeon made; the history carries it out, keeps it for undo and saves it.
struct PlanEdit {
  tunnels::TunnelKey key = bones::BoneKind::Femur;
  std::optional<tunnels::Tunnel> tunnel;  // empty: remove it
  std::string what;                       // "Aim the femoral tunnel"
  bool continues = false;                 // belongs to the edit before it: one drag is one step back
};

// What the plan mode shows beside the model.
struct PlanStatus {
  enum class Save {
    Saved,
    NotYet,    // the hand has not come to rest
    Failed,    // the model keeps what is not on disk
    ReadOnly,  // another program has the case: edits are refused
    Conflict,  // another program has saved a plan since: nothing is written until somebody chooses
  } save = Save::Saved;
  std::string text = "saved";        // "saved at 11:04:22", or what went wrong
  std::string undo_what, redo_what;  // empty: nothing to undo, to redo
};

}  // namespace arthronaut::open_case
