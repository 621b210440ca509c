#include "navigation/theatre/navigate_source.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "navigation/sources/capture_time.h"
#include "navigation/theatre/operation_run.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"

namespace arthronaut::theatre {

namespace {

using operation::Standing;

// A source that somebody else has opened, up to a time.
class SharedSource : public sources::FrameSource {
 public:
  SharedSource(std::shared_ptr<sources::FrameSource> source, double end_s)
      : source_(std::move(source)), end_s_(end_s) {}
  [[nodiscard]] const sources::SourceInfo& info() const override { return source_->info(); }
  [[nodiscard]] camera::FramePtr next() override {
    camera::FramePtr frame = source_->next();
    const bool is_later = frame != nullptr && static_cast<double>(frame->timestamp_ns) * 1e-9 >= end_s_;
    return is_later ? nullptr : frame;
  }

 private:
  const std::shared_ptr<sources::FrameSource> source_;
  const double end_s_;
};

// Where there is no bone nothing is ever found.
class NoRegistration : public RegistrationService {
  void post(std::vector<operation::RegistrationRequest>) override {}
  [[nodiscard]] operation::OutcomePtr latest() const override { return nullptr; }
};

operation::OperationSetup setup_of(const NavigateOptions& options) {
  operation::OperationSetup setup = options.operation;
  if (options.bone != nullptr) setup.registers_after_mm = options.retry_after_mm;
  return setup;
}

std::unique_ptr<RegistrationService> registration_of(const NavigateOptions& options) {
  if (options.bone == nullptr) return std::make_unique<NoRegistration>();
  return registration_at_once([bone = options.bone] { return bone; },
                              operation::work_options(setup_of(options)));
}

// Where more of the frames are in another medium, that is the reason of all else; a scope that is drawn out
// at the end is none.
constexpr double kMostInOtherMedium = 0.1;

// One operation on its way through the source.
class Navigation {
 public:
  Navigation(const std::shared_ptr<sources::FrameSource>& source, const NavigateOptions& options,
             const RecordOptions& record, const NavigationObserver& observer)
      : observer_(observer),
        is_outside_(options.source.pipeline.tools.tracker.has_value()),
        run_(
            setup_of(options), registration_of(options),
            record.folder.empty() ? OperationRun::MakeSessionFolder()
                                  : [folder = record.folder] { return folder; }) {
    summary_.statistics = pipeline::ViewStatistics(options.source.pipeline.tools);
    const double end_s = options.duration_s.value_or(std::numeric_limits<double>::infinity());
    run_.keep_pictures_as(record.pictures);
    run_.start({.setup = options.source,
                .open = [source, end_s] { return std::make_unique<SharedSource>(source, end_s); },
                .truth = {},
                .tracker = options.tracker});
    if (!record.folder.empty()) {
      if (!run_.record_trouble().empty()) throw IoError(run_.record_trouble());
      run_.keep_video(record.keep, record.video);
    }
    if (options.registration) apply(*options.registration);
    if (options.is_confirmed) confirm();
    // Somebody who stands by may draw whatever is known: it verifies what was given.
    apply(operation::Draw{true});
  }

  // What is asked of this source, and no more: a record that tells of a time-out that was not due would say
  // that somebody confirmed something.
  void confirm() {
    if (run_.state()->time_out == operation::TimeOut::Due) apply(operation::ConfirmTimeOut{});
    if (!run_.state()->guide_check.may_guide()) apply(operation::TrustGuide{});
  }

  // False at the end.
  bool take_frame() {
    const OperationRun::Step step = run_.step();
    if (step.has_ended) return false;
    follow_watch();
    if (step.picture == nullptr) return waits_on();
    picture_at_ns_ = sources::steady_now_ns();
    const operation::OperationStatePtr state = run_.state_of_frame();
    const pipeline::FrameResult& frame = state->frame;
    summary_.statistics.add(frame, frame.processing_ms);
    world_was_seen_ = world_was_seen_ || frame.world_is_seen();
    summary_.frames_with_tip += frame.tip_is_valid ? 1 : 0;
    summary_.last_state = frame.guidance.state;
    summary_.guidance_counts.add(frame.guidance.state);
    summary_.frames_registered += state->registration->in_force.standing == operation::Standing::Stands;
    summary_.frames_bone_seen += state->contour.state == contour::ContourState::Holds;
    summary_.frames_bone_otherwise += state->contour.state == contour::ContourState::LooksOtherwise;
    if (state->medium.fit == pipeline::MediumFit::Contradicts) {
      ++summary_.frames_in_other_medium;
      summary_.other_medium = state->medium;
      // That nothing stands is the medium's doing, not the lens'.
      if (!frame.intrinsics_are_known) --summary_.statistics.frames_with_unknown_lens;
    }
    if (frame.guidance.is_valid()) summary_.last_guidance = frame.guidance;
    follow_registration();
    pass_on(step.picture, state);
    if (!observer_.pedal) return true;
    for (const operation::Command& command : observer_.pedal(*state)) apply(command);
    return true;
  }

  // Nothing comes of it: a copy of the video is not worth its time.
  void give_up() { run_.keep_video(recording::KeepVideo::No, {}); }

  NavigationSummary finish() {
    apply(operation::RegisterStrokes{});
    const operation::OperationStatePtr state = run_.state();
    run_.end_source();
    summary_.record_trouble = run_.record_trouble();
    summary_.video_trouble = run_.video_trouble();
    summary_.latency = run_.latency().report();
    summary_.curves = run_.operation().strokes_in_use();
    summary_.drawn_length_mm = strokes::length_mm(summary_.curves);
    summary_.drilled = state->drilled;
    const operation::RegistrationState& known = *state->registration;
    summary_.standing = known.in_force.standing;
    if (known.in_force.registration != nullptr) {
      summary_.registration = *known.in_force.registration;
      summary_.registration_was_found =
          (*known.history)[*known.entry_in_force].origin != operation::RegistrationOrigin::Given;
    }
    say_reasons();
    return std::move(summary_);
  }

 private:
  // As the screen would show it: what waited for too long is not of now, and neither is the oldest pose in
  // it.
  void pass_on(const camera::FramePtr& picture, const operation::OperationStatePtr& state) {
    const bool is_dated = state->source->kind == sources::SourceKind::Live && picture->captured_ns > 0;
    const double now_s = static_cast<double>(sources::steady_now_ns()) * 1e-9;
    double captured_s = is_dated ? static_cast<double>(picture->captured_ns) * 1e-9 : now_s;
    captured_s = std::min(run_.content_s(captured_s), run_.oldest_pose_s(captured_s));
    if (is_of_now(now_s - captured_s, run_.watch().trouble())) {
      if (observer_.on_frame) observer_.on_frame(picture, state);
    } else if (observer_.on_late) {
      const std::string& words = run_.watch().words();
      observer_.on_late(
          picture,
          words.empty() ? files::format("the picture is %.0f ms late", 1000 * (now_s - captured_s)) : words,
          state);
    }
  }
  // Nobody stands by who could tell a source that comes back from one that is gone. Throws DeviceError.
  bool waits_on() {
    constexpr std::int64_t kGivesUpAfter_ns = 15'000'000'000;
    if (observer_.on_silence) observer_.on_silence(run_.watch(), run_.state());
    if (sources::steady_now_ns() - picture_at_ns_ < kGivesUpAfter_ns) return true;
    throw DeviceError("no picture for 15 s. " + run_.watch().words());
  }
  void follow_watch() {
    const std::string& words = run_.watch().words();
    if (run_.watch().trouble() != trouble_ && !words.empty()) summary_.troubles.push_back(words);
    trouble_ = run_.watch().trouble();
    const std::string& of_tracker = run_.tracker_trouble();
    if (of_tracker != tracker_trouble_ && !of_tracker.empty())
      summary_.tracker_troubles.push_back(of_tracker);
    tracker_trouble_ = of_tracker;
  }
  void apply(const operation::Command& command) {
    run_.apply(command);
    follow_registration();
  }
  // What comes of it is taken in at once, so that the next frame and command find it.
  void follow_registration() {
    while (run_.follow_registration()) {
    }
  }

  // Why an outside tracker showed no tip at the end; empty where it did, and without one.
  [[nodiscard]] std::string reason_of_tracker() {
    if (!is_outside_ || summary_.frames_with_tip > 0) return "";
    if (!tracker_trouble_.empty()) return tracker_trouble_;
    const operation::OperationStatePtr state = run_.state_of_frame();
    const tools::ToolSet& tools = state->source->pipeline.tools;
    const auto* const world = tools.find_world_marker(state->bone);
    const auto* const probe = tools.find_tool(state->source->pipeline.probe_name);
    for (const auto& [name, id] : {std::pair{"bone", world != nullptr ? world->marker_id : -1},
                                   std::pair{"probe", probe != nullptr ? probe->marker_id : -1}})
      if (const auto seen = tracker::state_of(state->frame.outside, id); seen != tracker::BodyState::Tracked)
        return std::string("the ") + name + ": " + std::string(tracker::to_text(seen));
    return "";
  }

  void say_reasons() {
    std::vector<std::string>& reasons = summary_.reasons;
    if (summary_.statistics.frame_count == 0) {
      reasons.emplace_back("the video has no frame");
    } else if (static_cast<double>(summary_.frames_in_other_medium) >
               kMostInOtherMedium * static_cast<double>(summary_.statistics.frame_count)) {
      reasons.push_back(pipeline::reason_text(summary_.other_medium));
    } else if (const std::string why = reason_of_tracker(); !summary_.registration && !why.empty()) {
      reasons.emplace_back(why);
    } else if (std::string of_camera = summary_.statistics.reason_of_camera();
               !of_camera.empty() && !(summary_.registration && summary_.standing == Standing::Stands)) {
      reasons.push_back(std::move(of_camera));
    } else if (!is_outside_ &&
               summary_.statistics.frames_with_unknown_lens == summary_.statistics.frame_count) {
      reasons.emplace_back("the lens mark was not seen, so the camera is not known in any frame");
    } else if (!summary_.registration) {
      reasons.emplace_back(summary_.curves.empty()
                               ? "there is no registration and the probe drew nothing to find one by"
                               : "there is no bone to register the strokes to");
    } else if (summary_.standing != Standing::Stands) {
      reasons = summary_.registration->reasons;
    } else if (!world_was_seen_) {
      reasons.emplace_back("the world marker was seen in no frame: nothing was navigated");
    }
  }

  const NavigationObserver& observer_;
  const bool is_outside_;
  bool world_was_seen_ = false;
  OperationRun run_;
  NavigationSummary summary_;
  SourceTrouble trouble_ = SourceTrouble::None;
  std::string tracker_trouble_;
  std::int64_t picture_at_ns_ = sources::steady_now_ns();
};

}  // namespace

NavigationSummary navigate_source(const std::shared_ptr<sources::FrameSource>& source,
                                  const NavigateOptions& options, const RecordOptions& record,
                                  const NavigationObserver& observer) {
  Navigation navigation(source, options, record, observer);
  std::string ending;
  bool broke_off = false;
  try {
    while (navigation.take_frame()) {
    }
  } catch (const DeviceError& error) {
    // What was made until then stays: a camera that is pulled out is the end of many an operation.
    if (!source->info().is_live()) {
      navigation.give_up();
      throw;
    }
    ending = error.what();
    broke_off = dynamic_cast<const StoppedByHand*>(&error) == nullptr;
  } catch (...) {
    navigation.give_up();
    throw;
  }
  NavigationSummary summary = navigation.finish();
  if (broke_off) summary.reasons.push_back("the source broke off: " + ending);
  summary.ending = std::move(ending);
  return summary;
}

}  // namespace arthronaut::theatre
