// What follows from a medium that the pictures contradict.
#include "navigation/operation/operation_parts.h"

namespace arthronaut::operation {

void Operation::Parts::check_medium() {
  const pipeline::MediumFit before = medium.verdict().fit;
  medium.look(frame, source->pipeline);
  follow_medium(before);
  hold_for_medium();
}

// What is wrong by centimetres in the wrong medium waits for the pictures' word, which in the right one is
// there with the first of them that could guide.
void Operation::Parts::hold_for_medium() {
  const bool guides = frame.guidance.is_valid() || frame.guidance.drill;
  if (guides && medium.holds() && !source->pipeline.tools.tracker && time_out() != TimeOut::Due)
    hide_guidance(guidance::GuidanceState::MediumUnsure);
}

void Operation::Parts::take_look(const MediumLookPtr& look) {
  if (look == nullptr || !medium.awaits(*look)) return;
  const std::string frame_index = std::to_string(look->view.frame_index);
  if (look->failure.empty())
    note(JournalKind::LookTaken, frame_index);
  else
    note(JournalKind::LookFailed, frame_index + ": " + look->failure);
  const pipeline::MediumFit before = medium.verdict().fit;
  medium.take(*look);
  follow_medium(before);
}

// In the wrong medium nothing that is reckoned from the pictures stands; the reason is the medium, not the
// markers.
void Operation::Parts::follow_medium(pipeline::MediumFit before) {
  const pipeline::MediumVerdict verdict = medium.verdict();
  if (verdict.fit != before) {
    changed = true;
    if (verdict.fit == pipeline::MediumFit::Contradicts) {
      note(JournalKind::Note, pipeline::reason_text(verdict));
      if (!setup.hears_of_drifts) seen_medium = SeenMedium{verdict.last_sure_ns};
    }
  }
  if (verdict.fit != pipeline::MediumFit::Contradicts) return;
  end_frame();
  hide_guidance(guidance::GuidanceState::WrongMedium);
}

// Nothing that was reckoned from the picture stands.
void Operation::Parts::end_frame() {
  frame.camera_from_world.is_valid = frame.tip_is_valid = frame.intrinsics_are_known = false;
  frame.tracker_from_world.is_valid = false;
  for (pipeline::ToolPose& tool : frame.tools) tool.world_from_tool.is_valid = false;
  hide_guidance(guidance::GuidanceState::Stale);
}

// It is known seconds after it began. What was measured meanwhile, through a camera whose angles were wrong
// by a third, is not there any more, also when the medium fits again.
void Operation::Parts::take_medium() {
  const auto seen = std::exchange(seen_medium, std::nullopt);
  if (!seen) return;
  note(JournalKind::MediumWrong, to_text(*seen));
  why_none = "it was found through the wrong medium";
  tip.clear();
  if (const int gone = strokes.take_back_since(static_cast<double>(seen->last_sure_ns) * 1e-9); gone > 0) {
    ask(StrokesTakenBack{gone});
    fit.on_strokes_gone();
    online.reset();
  }
  guide_check.forget_since(seen->last_sure_ns);
  const Touches::Gone gone = ledger.forget_since(seen->last_sure_ns);
  look_for_end_of_loss();
  // Whatever the control point was touched for, that is not answered.
  if (gone.control_point && ledger.touches().has_control_point()) marker_may_have_moved();
  if (!ledger.touches().has_control_point()) guide_check.forget_point();
  bone_watch.on_touches(ledger.touches());
  follow_ledger();
}

}  // namespace arthronaut::operation
