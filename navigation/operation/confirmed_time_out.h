// What the time-out of a live operation was confirmed of: patient, side, camera, probe, world marker and
// medium, as the provenance says them, guide and drills, and the plan. It holds for these alone: with another
// one of them it is due again.
#pragma once

#include <optional>

#include "navigation/operation/operation_state.h"

namespace arthronaut::operation {

class ConfirmedTimeOut {
 public:
  // What is drilled with in the pictures of that source, from now on.
  void on_source(const pipeline::PipelineOptions& options) {
    guides_now_ = registration::guides_identity(options.tools, options.guide_name);
  }
  void confirm(const registration::Provenance& now, const std::optional<PlannedTunnel>& plan) {
    of_ = now;
    guides_ = guides_now_;
    plan_ = plan;
  }
  // In records of before taking a plan over asked anew: that was a confirmation of its own.
  void on_plan_taken_over(const std::optional<PlannedTunnel>& plan) { plan_ = plan; }

  // source: that runs, or ran last; null: none yet. Only a live one asks. A marker that is placed anew
  // changes nothing of what was confirmed. Allocates nothing.
  [[nodiscard]] TimeOut standing(const SourceSetup* source, const registration::Provenance& now,
                                 const std::optional<PlannedTunnel>& plan) const {
    if (source == nullptr || source->kind != sources::SourceKind::Live) return TimeOut::NotAsked;
    if (!of_ || plan_ != plan || guides_ != guides_now_) return TimeOut::Due;
    return registration::mismatch_but_placement(*of_, now) ? TimeOut::Due : TimeOut::Confirmed;
  }

  // As registration::guides_identity() has it.
  [[nodiscard]] const std::string& guides_now() const { return guides_now_; }

 private:
  std::optional<registration::Provenance> of_;  // empty: not yet
  std::optional<PlannedTunnel> plan_;
  std::string guides_, guides_now_;
};

}  // namespace arthronaut::operation
