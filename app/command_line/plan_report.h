// A planned tunnel in words and as JSON, as `arthronaut plan` prints it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/command_line/command.h"
#include "planning/cases/bone_doubts.h"
#include "planning/cases/case.h"
#include "planning/default_plan/default_plan.h"
#include "planning/plan_review/plan_review.h"

namespace arthronaut::command_line {

// What is said of a tunnel beside its numbers, and of a default plan besides.
struct PlanVerdict {
  bool is_reliable = true;
  std::vector<std::string> reasons;
  std::string source, place;  // as default_plan::DefaultTunnel has them; empty where no default was made
  double off_norm_mm = 0;
  std::optional<default_plan::OtherEntry> other_entry;  // see DefaultTunnel
  double entry_moved_mm = 0;                            // of one that was placed now, onto the bone
  int kept_version = 0;  // of the plan that the default took the place of; 0: it took none's
};

// The same with what speaks against the tunnel whether it was made now or years ago: checks that are wrong,
// doubts about its bone, another bone than it was planned on, landmarks far from where the bone's shape puts
// them, and, unless a default says it already, landmarks that nobody confirmed.
[[nodiscard]] PlanVerdict judged(const cases::Case& knee, const plan_review::CaseReview& review,
                                 const tunnels::TunnelKey& key, const cases::BoneDoubts& doubts,
                                 PlanVerdict verdict);

// Lines for the user: entry, direction, what was measured, every check.
// Precondition of both: the review, which is of this case, has the tunnel.
void describe_tunnel(const Context& context, const cases::Case& knee, const plan_review::CaseReview& review,
                     const tunnels::TunnelKey& key, const PlanVerdict& verdict);
[[nodiscard]] nlohmann::ordered_json tunnel_to_json(const cases::Case& knee,
                                                    const plan_review::CaseReview& review,
                                                    const tunnels::TunnelKey& key,
                                                    const PlanVerdict& verdict);

}  // namespace arthronaut::command_line
