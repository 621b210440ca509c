// What the checks say of the plan that guides, or would: judged when it is another one, or what it is judged
// by has changed, and never in between. A dozen milliseconds.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "app/case/plan_model.h"
#include "navigation/operation/command.h"
#include "planning/cases/bone_doubts.h"
#include "planning/plan_review/tunnel_verdict.h"

namespace arthronaut::navigate {

class JudgedPlan {
 public:
  // Another case, with what spoke against its bones; empty: of none. Doubts that nobody can read are one: a
  // plan on these bones must not look as if nothing spoke against them.
  void open(const std::filesystem::path& case_folder);
  // plan: in force, or the case's while nothing is; it may differ from the model's. Fine without one, which
  // says nothing.
  void judge(const open_case::PlanModel& model, const std::optional<operation::PlannedTunnel>& plan);
  [[nodiscard]] const plan_review::TunnelVerdict& verdict() const { return verdict_; }

 private:
  cases::BoneDoubts doubts_;
  std::optional<operation::PlannedTunnel> of_;
  std::uint64_t revision_ = 0;
  bool by_shape_ = false;  // what the bone's shape gives was there
  plan_review::TunnelVerdict verdict_;
};

}  // namespace arthronaut::navigate
