// Landmarks of a case whose own say nothing of where on the bone a point lies: the same proposed ones
// wherever the case is looked at.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <stop_token>

#include "planning/cases/case.h"
#include "planning/landmarks/propose.h"

namespace arthronaut::plan_review {

// Which bones proposals are made for: half a second each, side by side.
enum class Proposing {
  WithoutGrid,       // whose landmarks give no grid
  WithoutConfirmed,  // these, and those of whose grid somebody has still to look at a landmark
  Planned,           // those without a grid, and those with a tunnel: what is confirmed can lie wrong, too
};
struct ProposedBone {
  landmarks::Proposal proposal;
  std::shared_ptr<const geometry::Surface> surface;  // of the bone's mesh; null where nothing was proposed
  bool was_taken = false;
};

// Bones without a grid take what is proposed, as proposed; landmarks that somebody confirmed stay. What was
// proposed, by bone. Afterwards every bone has landmarks and states, if empty ones. Nothing is saved.
// Once it is to stop nothing more is taken. bone_done: for every bone with a mesh, from any thread, when what
// is to be proposed of it is made.
std::map<bones::BoneKind, ProposedBone> propose_landmarks(cases::Case& knee, Proposing proposing,
                                                          const std::stop_token& stop = {},
                                                          const std::function<void()>& bone_done = nullptr);

// Of the landmarks that the bone's grid follows from, and mostly its axes, the one least looked at.
[[nodiscard]] landmarks::LandmarkState state_of_grid(const cases::Case& knee, bones::BoneKind kind);

}  // namespace arthronaut::plan_review
