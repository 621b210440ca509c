// What everything that is asked of a tunnel comes to: one sign and its reasons, for whoever has room for no
// more. A plan that cannot be drilled must look like one wherever it is taken along.
#pragma once

#include <string>
#include <vector>

#include "planning/cases/bone_doubts.h"
#include "planning/cases/case.h"
#include "planning/landmarks/grid_landmarks.h"
#include "planning/plan_review/plan_review.h"
#include "planning/tunnels/plan_checks.h"

namespace arthronaut::plan_review {

struct TunnelVerdict {
  // "Wall: -3.5 mm ...": of checks. What cannot be drilled like this; what is to be looked at, where also the
  // doubts about bone and grid stand.
  std::vector<std::string> wrong = {}, look = {};
  std::string side_note = {};  // see below; of one tunnel's verdict

  [[nodiscard]] bool is_wrong() const { return !wrong.empty(); }
  // Nothing speaks against it. What was not checked has not failed.
  [[nodiscard]] bool is_fine() const { return wrong.empty() && look.empty(); }
  [[nodiscard]] tunnels::PlanCheck::Verdict worst() const;  // Wrong, Look or Fine
  // The first of the worst, how many more of them there are, and beside what is wrong how much is to be
  // looked at: "Wall: ... (and 1 more wrong, 2 to look at)". Empty where it is fine.
  [[nodiscard]] std::string in_short() const;
};

// A side in doubt, whichever bone witnesses it, is wrong for both; what else is doubted of the bone is to be
// looked at. grid_doubt: see below.
[[nodiscard]] TunnelVerdict verdict_of(const tunnels::Tunnel& tunnel,
                                       const std::vector<tunnels::PlanCheck>& checks,
                                       const cases::BoneDoubts& doubts, const std::string& grid_doubt);

// Of every planned tunnel on a bone that is there, the checks.
using CheckedPlan = std::map<tunnels::TunnelKey, std::vector<tunnels::PlanCheck>>;
[[nodiscard]] CheckedPlan checks_of_plan(const CaseReview& review);
// Of a whole plan, also as to the surface and the side that it was planned on: "femur: Wall: ...", and the
// side, which is the knee's, once and first. A missing grid is to be looked at here. Fine without a plan,
// which says nothing.
[[nodiscard]] TunnelVerdict verdict_of_plan(const cases::Case& knee, const CheckedPlan& checks,
                                            const cases::BoneDoubts& doubts);

// Of bones without a plan: the side is wrong, what else is doubted of them is to be looked at.
[[nodiscard]] TunnelVerdict verdict_of_bones(const cases::BoneDoubts& doubts);

// Of the grid of a case's bone: how well it is looked after, and what speaks against it, in words that follow
// "Grid: "; empty where all that it follows from is confirmed.
[[nodiscard]] landmarks::GridState grid_state(const cases::Case& knee, bones::BoneKind kind);
[[nodiscard]] std::string grid_doubt(const cases::Case& knee, bones::BoneKind kind);
// The first of the doubts by which the bones are of the other knee than their case; empty where none is.
[[nodiscard]] std::string side_doubt(const cases::BoneDoubts& doubts);
// That the side rests on a person's word alone, which speaks against nothing; empty where it does not.
[[nodiscard]] std::string side_note(const cases::BoneDoubts& doubts);
// What is doubted of that bone but for the side, a sentence each.
[[nodiscard]] std::vector<std::string> doubts_but_side(const cases::BoneDoubts& doubts, bones::BoneKind bone);

}  // namespace arthronaut::plan_review
