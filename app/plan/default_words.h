// What a default plan says of itself, on the screen where it was made.
#pragma once

#include <string>
#include <vector>

#include "planning/default_plan/default_plan.h"
#include "planning/tunnels/plan_checks.h"

namespace arthronaut::plan {

struct MadeTunnel {
  tunnels::TunnelKey key = bones::BoneKind::Femur;
  default_plan::DefaultTunnel made = {};
  std::vector<tunnels::PlanCheck> checks = {};  // of the plan with it
};

// A line for each tunnel: where its entry was put and why there, and what its checks call wrong. Then what it
// rests on that nobody has confirmed, and how to have back what it took the place of.
[[nodiscard]] std::string default_in_words(const std::vector<MadeTunnel>& made, bool took_the_place);

// With a full stop at its end, where no other mark ends it: what follows is a sentence of its own.
[[nodiscard]] std::string ended(std::string sentence);

}  // namespace arthronaut::plan
