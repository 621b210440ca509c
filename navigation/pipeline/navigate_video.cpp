#include "navigation/pipeline/navigate_video.h"

#include "navigation/pipeline/prefetched_source.h"

namespace arthronaut::pipeline {

namespace {

using registration::RegistrationSummary;

// One operation on its way through the video.
class Operation {
 public:
  Operation(const NavigateOptions& options, const NavigationObserver& observer)
      : options_(options), observer_(observer), pipeline_(options.pipeline) {
    summary_.statistics = ViewStatistics(options.pipeline.tools);
    summary_.registration = options.registration;
    pipeline_.set_plan(options.plan, options.planned_length_mm);
    pipeline_.set_registration(options.registration);
    const tools::ToolSet& tools = options.pipeline.tools;
    const tools::Tool* probe = tools.find_tool(options.pipeline.probe_name);
    can_digitise_ = probe && probe->tip_mm;
    guide_ = tools.find_tool(options.pipeline.guide_name);
  }

  void take(const camera::FramePtr& frame) {
    if (wants_registration()) register_strokes();
    pipeline_.process(*frame, result_);
    summary_.statistics.add(result_, result_.processing_ms);
    append_pose_rows(result_, summary_.rows);
    summary_.frames_with_tip += result_.tip_is_valid ? 1 : 0;
    summary_.last_state = result_.guidance.state;
    if (result_.guidance.is_valid()) {
      ++summary_.frames_with_guidance;
      summary_.last_guidance = result_.guidance;
    }
    if (observer_.on_frame) observer_.on_frame(frame, result_);
  }

  NavigationSummary finish() {
    if (can_register()) register_strokes();
    if (can_digitise_ && !can_register()) digitise();
    say_reasons();
    return std::move(summary_);
  }

 private:
  [[nodiscard]] bool can_register() const { return can_digitise_ && options_.bone != nullptr; }

  // While the guide is held into the view without a registration to guide by. Looking once in half a second
  // is enough.
  [[nodiscard]] bool wants_registration() {
    if (!can_register() || !options_.plan || !guide_ ||
        (summary_.registration && summary_.registration->reliable)) {
      return false;
    }
    bool guide_is_seen = false;
    for (const ToolPose& tool : result_.tools) {
      guide_is_seen = guide_is_seen || (tool.marker_id == guide_->marker_id && tool.world_from_tool.is_valid);
    }
    if (!guide_is_seen || ++frames_since_look_ < 30) return false;
    frames_since_look_ = 0;
    digitise();
    return summary_.stroke_length_mm >= tried_length_mm_ + options_.retry_after_mm;
  }

  void digitise() {
    summary_.curves = strokes::digitise(summary_.rows, options_.pipeline.tools, options_.pipeline.bone,
                                        options_.pipeline.probe_name, options_.strokes);
    summary_.stroke_length_mm = stroke_length_mm(summary_.curves);
  }

  void register_strokes() {
    digitise();
    if (summary_.curves.empty() || summary_.curves.size() == tried_points_) return;
    tried_length_mm_ = summary_.stroke_length_mm;
    tried_points_ = summary_.curves.size();
    registration::RegistrationOptions options;
    options.seed = options_.seed;
    options.covered = options_.covered;
    if (options_.plan) options.target_in_bone_mm = options_.plan->entry_mm;
    const RegistrationSummary found = registration::register_curves(*options_.bone, summary_.curves, options);
    if (!found.reliable && options_.registration && options_.registration->reliable) {
      // A few strokes to check a known registration are no reason to lose it; many that fit nowhere are one
      // to say so.
      if (tried_length_mm_ >= options_.retry_after_mm) summary_.reasons = found.reasons;
      return;
    }
    summary_.reasons.clear();
    summary_.registration = found;
    summary_.registration_was_found = true;
    pipeline_.set_registration(summary_.registration);
    if (observer_.on_registration) observer_.on_registration(*summary_.registration);
  }

  void say_reasons() {
    std::vector<std::string>& reasons = summary_.reasons;
    if (summary_.statistics.frame_count == 0) {
      reasons.emplace_back("the video has no frame");
    } else if (summary_.statistics.frames_with_unknown_lens == summary_.statistics.frame_count) {
      reasons.emplace_back("the lens mark was not seen, so the camera is not known in any frame");
    } else if (!summary_.registration) {
      reasons.emplace_back(summary_.curves.empty()
                               ? "there is no registration and the probe drew nothing to find one by"
                               : "there is no bone to register the strokes to");
    } else if (!summary_.registration->reliable) {
      reasons = summary_.registration->reasons;
    }
  }

  const NavigateOptions& options_;
  const NavigationObserver& observer_;
  NavigationPipeline pipeline_;
  FrameResult result_;
  NavigationSummary summary_;
  const tools::Tool* guide_ = nullptr;
  bool can_digitise_ = false;
  int frames_since_look_ = 0;
  double tried_length_mm_ = 0;
  std::size_t tried_points_ = 0;
};

}  // namespace

NavigationSummary navigate_video(sources::FrameSource& source, const NavigateOptions& options,
                                 const NavigationObserver& observer) {
  Operation operation(options, observer);
  PrefetchedSource prefetched(source);
  while (const camera::FramePtr frame = prefetched.next()) operation.take(frame);
  return operation.finish();
}

double stroke_length_mm(const strokes::Curves& curves) {
  double length_mm = 0;
  for (std::size_t i = 1; i < curves.size(); ++i) {
    if (curves[i].curve == curves[i - 1].curve) {
      length_mm += (curves[i].position_mm - curves[i - 1].position_mm).norm();
    }
  }
  return length_mm;
}

}  // namespace arthronaut::pipeline
