#include "app/navigate/hindrance.h"

#include "app/navigate/live_words.h"

namespace arthronaut::navigate {

namespace {

using markers::MarkerState;
using operation::NextAction;

std::string words_of(MarkerState state, const std::string& name) {
  switch (state) {
    case MarkerState::Tracked:
      return "";
    case MarkerState::NotSeen:
      return name + " not seen";
    case MarkerState::OutOfView:
      return name + " is out of view";
    case MarkerState::TooSmall:
      return name + " is too far away";
    case MarkerState::TooOblique:
      return name + " is seen too obliquely";
    case MarkerState::Covered:
      return name + " is covered";
    case MarkerState::Glare:
      return "glare on the " + name;
    case MarkerState::Blur:
      return name + " is blurred: hold still";
    case MarkerState::Ambiguous:
      return name + ": tilt unclear, turn it";
    case MarkerState::Duplicate:
      return name + " is seen twice";
    case MarkerState::Doubtful:
      return name + " is not seen clearly";
    case MarkerState::Disagreeing:
      return name + ": its markers disagree";
  }
  return "";
}

// Of the picture as a whole. An outside tracker's poses hang on its moment alone.
std::string words_of_picture(const pipeline::FrameResult& result, bool is_outside) {
  if (result.is_frozen) return "the picture is frozen";
  if (result.is_repeating) return "the picture does not change";
  if (is_outside) return "";
  if (result.is_blank) return "the picture is plain";
  if (result.is_torn) return "the picture is torn";
  if (result.intrinsics_are_known) return "";
  std::string words = trouble_of(result.lens).headline;
  if (words.empty()) return "lens angle unknown";
  words[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(words[0])));
  return words;
}

enum class Needs { Nothing, Marker, Probe, Guide };

Needs needs_of(const operation::OperationState& state) {
  switch (state.next_action) {
    case NextAction::ShowWorldMarker:
      return Needs::Marker;
    case NextAction::CheckWorldMarker:
      return state.registration->must_be_found_anew() ? Needs::Nothing : Needs::Probe;
    case NextAction::Draw:
    case NextAction::GoOnDrawing:
    case NextAction::RegisterAnew:
    case NextAction::ConfirmByTouch:
    case NextAction::VerifyByTouch:
    case NextAction::SetControlPoint:
    case NextAction::CheckControlPoint:
      return Needs::Probe;
    case NextAction::CheckGuide:
    case NextAction::BringGuide:
    case NextAction::FollowBullseye:
      return Needs::Guide;
    default:
      return Needs::Nothing;
  }
}

// The tool that is needed; null: none is.
const tools::Tool* tool_of(const pipeline::PipelineOptions& options, Needs needs) {
  if (needs == Needs::Probe) return options.tools.find_tool(options.probe_name);
  return needs == Needs::Guide ? options.tools.find_tool(options.guide_name) : nullptr;
}
std::string name_of(Needs needs) { return needs == Needs::Probe ? "probe" : "guide"; }

// What no picture brings.
std::string words_of_setup(const operation::OperationState& state, Needs needs) {
  const std::string& bone = state.registration->bone_trouble;
  if (!bone.empty() && operation::step_of(state.next_action) == operation::Step::Digitise) return bone;
  if (needs == Needs::Marker) return "";
  const tools::Tool* const tool = tool_of(state.source->pipeline, needs);
  if (tool == nullptr) return "the tools of this case hold no " + name_of(needs);
  if (needs == Needs::Probe && !tool->tip_mm) return "probe's tip not calibrated: step 4";
  if (needs == Needs::Guide && !tool->axis) return "guide's axis not calibrated: step 4";
  return "";
}

}  // namespace

bool needs_guide(const operation::OperationState& state) { return needs_of(state) == Needs::Guide; }

std::string why_not_tracked(const pipeline::FrameResult& result, int marker_id, const std::string& name) {
  if (result.outside.bodies.empty()) return words_of(pipeline::body_in(result, marker_id).state, name);
  const tracker::BodyState outside = tracker::state_of(result.outside, marker_id);
  return outside == tracker::BodyState::Tracked ? "" : name + ": " + std::string(tracker::to_text(outside));
}

std::string hindrance_of(const operation::OperationState& state, theatre::SourceTrouble trouble) {
  const Needs needs = needs_of(state);
  if (needs == Needs::Nothing || !state.has_source || state.frame_count == 0) return "";
  const pipeline::PipelineOptions& options = state.source->pipeline;
  std::string words = words_of_setup(state, needs);
  if (words.empty()) words = words_of_picture(state.frame, options.tools.tracker.has_value());
  if (words.empty() && trouble == theatre::SourceTrouble::Late) words = "the pictures are late";
  const bool is_slow = trouble == theatre::SourceTrouble::Slow;
  if (words.empty() && is_slow && needs == Needs::Guide) words = "the pictures come too slowly";
  if (const auto* const marker = options.tools.find_world_marker(options.bone);
      marker != nullptr && words.empty())
    words = why_not_tracked(state.frame, marker->marker_id, "bone marker");
  if (const tools::Tool* const tool = tool_of(options, needs); tool != nullptr && words.empty())
    words = why_not_tracked(state.frame, tool->marker_id, name_of(needs));
  // It can be done all the same, and is all in vain unless somebody sees to the source before the guide is
  // taken.
  if (words.empty() && is_slow) words = "pictures come too slowly to guide by";
  return words;
}

std::string hindrance_of(const RailStep& step, bool is_looked_at) {
  if (is_looked_at) return navigate::words_of(step.missing);
  switch (step.missing) {
    case Missing::Camera:
    case Missing::CameraOfScope:
    case Missing::ProbeTip:
    case Missing::GuideAxis:
    case Missing::RealTools:
      return navigate::words_of(step.missing);
    default:
      return "";
  }
}

const std::string& SteadyWords::follow(const std::string& words, double now_s) {
  if (words != coming_) {
    coming_ = words;
    since_s_ = now_s;
  }
  if (coming_.empty() || now_s - since_s_ >= kLasted_s) shown_ = coming_;
  return shown_;
}

bool PassingWords::are_read(const std::string& words, double now_s) {
  if (words != words_) {
    words_ = words;
    since_s_ = now_s;
  }
  return !words.empty() && now_s - since_s_ >= kRead_s;
}

}  // namespace arthronaut::navigate
