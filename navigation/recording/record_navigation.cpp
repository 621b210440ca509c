#include "navigation/recording/record_navigation.h"

#include <arthronaut/version.h>

#include "planning/cases/case.h"

namespace arthronaut::recording {

namespace {

SessionHeader header_of(const sources::FrameSource& source, const pipeline::PipelineOptions& options,
                        const std::filesystem::path& folder) {
  SessionHeader header;
  header.id = folder.filename().string();
  header.started_utc = cases::utc_now();
  header.bone = options.bone;
  header.side = options.side;
  header.refractive_index = options.refractive_index;
  header.probe_name = options.probe_name;
  header.guide_name = options.guide_name;
  header.source = source.info().name;
  header.program_version = kProgramVersion;
  return header;
}

}  // namespace

pipeline::NavigationSummary record_navigation(sources::FrameSource& source,
                                              const pipeline::NavigateOptions& options,
                                              const std::filesystem::path& folder, KeepVideo keep,
                                              const std::filesystem::path& video,
                                              const pipeline::NavigationObserver& observer) {
  SessionRecorder recorder(folder, header_of(source, options.pipeline, folder), options.pipeline);
  if (keep == KeepVideo::Copy) recorder.copy_video(video);
  if (keep == KeepVideo::Refer) recorder.refer_to_video(video);
  recorder.set_plan(options.plan, options.planned_length_mm);
  if (options.registration) recorder.set_registration(*options.registration, false);

  pipeline::NavigationObserver recording;
  recording.on_frame = [&](const camera::FramePtr& frame, const pipeline::FrameResult& result) {
    if (keep == KeepVideo::Encode) recorder.append_picture(frame);
    recorder.append(result);
    if (observer.on_frame) observer.on_frame(frame, result);
  };
  recording.on_registration = [&](const registration::RegistrationSummary& registration) {
    recorder.set_registration(registration);
    if (observer.on_registration) observer.on_registration(registration);
  };
  pipeline::NavigationSummary summary = pipeline::navigate_video(source, options, recording);
  if (!summary.curves.empty()) recorder.set_curves(summary.curves);
  recorder.finish();
  return summary;
}

}  // namespace arthronaut::recording
