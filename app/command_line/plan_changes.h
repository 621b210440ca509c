// What the command `plan` makes of a case's plan: a tunnel that is placed by hand or by default or removed,
// or those of markups or of a version that was kept.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "app/command_line/kept_versions.h"
#include "app/command_line/plan_report.h"
#include "planning/cases/bone_doubts.h"
#include "planning/cases/case.h"
#include "planning/plan_review/proposed_landmarks.h"

namespace arthronaut::command_line {

struct PlanArguments {
  std::string case_folder, bone;
  Eigen::Vector3d entry_mm = Eigen::Vector3d::Zero(), direction = Eigen::Vector3d::Zero();
  double diameter_mm = 9.0;
  std::string type = "single", export_folder, markups;
  bool at_footprint = false, by_default = false, within_spread = false, as_json = false, removes = false;
  // Whether the user said so.
  bool names_direction = false, names_type = false, names_diameter = false;
  VersionArguments versions;

  [[nodiscard]] bool places() const { return names_direction || by_default; }
  [[nodiscard]] bool changes() const { return places() || removes || !markups.empty() || versions.taken > 0; }
};

// The tunnel that is placed or removed.
[[nodiscard]] tunnels::TunnelKey key_of(const PlanArguments& arguments);
[[nodiscard]] bool is_asked_for(const PlanArguments& arguments, bones::BoneKind bone);

struct ChangedPlan {
  cases::Case knee;
  PlanVerdict verdict = {};                 // on a default plan, and what was done with what was placed
  plan_review::ProposedBone proposed = {};  // of the bone that a default plan was made of
  std::vector<std::string> notes = {};      // to be said once it is so on the disk
};
// The case as it becomes; nothing is written. doubts: what spoke against its bones. Throws InvalidInput where
// what is asked for cannot be.
[[nodiscard]] ChangedPlan changed_plan(const PlanArguments& arguments, cases::Case knee,
                                       const cases::BoneDoubts& doubts);

}  // namespace arthronaut::command_line
