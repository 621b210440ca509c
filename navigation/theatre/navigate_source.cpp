#include "navigation/theatre/navigate_source.h"

#include <limits>
#include <utility>

#include "navigation/operation/registration_work.h"
#include "navigation/pipeline/prefetched_source.h"
#include "navigation/theatre/operation_log.h"
#include "planning/geometry/error.h"

namespace arthronaut::theatre {

namespace {

using operation::Standing;

operation::OperationSetup setup_of(const NavigateOptions& options) {
  operation::OperationSetup setup = options.operation;
  if (options.bone != nullptr) setup.registers_after_mm = options.retry_after_mm;
  return setup;
}

// One operation on its way through the source.
class Navigation {
 public:
  Navigation(sources::FrameSource& source, const NavigateOptions& options, const RecordOptions& record,
             const NavigationObserver& observer)
      : options_(options),
        observer_(observer),
        operation_(setup_of(options)),
        is_live_(options.source.kind == sources::SourceKind::Live) {
    if (options.bone != nullptr)
      work_.emplace([&] { return options.bone; }, operation::work_options(operation_.setup()));
    operation_.start_source(options.source);
    if (!record.folder.empty()) {
      record_.emplace(record.folder, operation_.setup(), options.source, source.info(), record.continues);
      record_->keep_video(record.keep, record.video);
    }
    summary_.statistics = pipeline::ViewStatistics(options.source.pipeline.tools);
    if (options.registration) give(*options.registration);
    if (options.is_confirmed) apply(operation::ConfirmTimeOut{});
    // Somebody who stands by may draw whatever is known: it verifies what was given.
    apply(operation::Draw{true});
  }

  void take(const camera::FramePtr& picture) {
    operation_.process(*picture);
    const operation::OperationStatePtr state = operation_.state();
    const pipeline::FrameResult& frame = state->frame;
    summary_.statistics.add(frame, frame.processing_ms);
    summary_.frames_with_tip += frame.tip_is_valid ? 1 : 0;
    summary_.last_state = frame.guidance.state;
    if (frame.guidance.is_valid()) {
      ++summary_.frames_with_guidance;
      summary_.last_guidance = frame.guidance;
    }
    write([&](recording::OperationRecord& to) { to.add_frame(picture, *state, is_live_); });
    if (auto request = operation_.take_look_request())
      operation_.take_look(looks_.look(std::move(*request), *picture));
    pass_on();
    if (observer_.on_frame) observer_.on_frame(picture, state);
    if (!observer_.pedal) return;
    for (const operation::Command& command : observer_.pedal(*state)) apply(command);
  }

  NavigationSummary finish() {
    apply(operation::RegisterStrokes{});
    const operation::OperationStatePtr state = operation_.state();
    operation_.end_source();
    pass_on();
    summary_.curves = operation_.strokes_in_use();
    write([&](recording::OperationRecord& to) { to.finish(summary_.curves); });
    summary_.stroke_length_mm = strokes::length_mm(summary_.curves);
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
  void give(operation::GiveRegistration given) { apply(given); }

  void apply(const operation::Command& command) {
    operation_.apply(command);
    pass_on();
  }

  // A disk that fails ends the record, never the operation; what was written until then stays.
  template <typename What>
  void write(const What& what) {
    if (!record_) return;
    try {
      what(*record_);
    } catch (const IoError& error) {
      summary_.record_trouble = error.what();
      record_.reset();
    }
  }

  // The registration works each request in at once, so that the next frame has what comes of it.
  void pass_on() {
    for (;;) {
      const auto requests = operation_.take_requests();
      const auto journal = operation_.take_journal();
      log_entries(journal);
      write([&](recording::OperationRecord& to) { to.add(journal); });
      if (requests.empty() || !work_) return;
      bool has_news = false;
      for (const operation::RegistrationRequest& request : requests)
        has_news = work_->work_in(request) || has_news;
      if (has_news) operation_.take_outcome(work_->outcome());
    }
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
    } else if (summary_.standing != Standing::Stands) {
      reasons = summary_.registration->reasons;
    }
  }

  const NavigateOptions& options_;
  const NavigationObserver& observer_;
  operation::Operation operation_;
  const bool is_live_;
  std::optional<operation::RegistrationWork> work_;
  operation::MediumLookWork looks_;
  std::optional<recording::OperationRecord> record_;
  NavigationSummary summary_;
};

}  // namespace

NavigationSummary navigate_source(sources::FrameSource& source, const NavigateOptions& options,
                                  const RecordOptions& record, const NavigationObserver& observer) {
  Navigation navigation(source, options, record, observer);
  pipeline::PrefetchedSource prefetched(source);
  const double end_s = options.duration_s.value_or(std::numeric_limits<double>::infinity());
  std::string ending;
  try {
    while (const camera::FramePtr picture = prefetched.next()) {
      if (static_cast<double>(picture->timestamp_ns) * 1e-9 >= end_s) break;
      navigation.take(picture);
    }
  } catch (const DeviceError& error) {
    // What was made until then stays: a camera that is pulled out is the end of many an operation.
    if (!source.info().is_live()) throw;
    ending = error.what();
  }
  NavigationSummary summary = navigation.finish();
  summary.ending = std::move(ending);
  return summary;
}

}  // namespace arthronaut::theatre
