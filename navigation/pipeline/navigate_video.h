// A whole operation from a recorded video: tracks, digitises what the probe draws, registers, guides. What
// `arthronaut navigate` does; `replay` does it again.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "navigation/pipeline/navigation_pipeline.h"
#include "navigation/pipeline/track_video.h"
#include "navigation/registration/registration.h"
#include "navigation/sources/frame_source.h"
#include "navigation/strokes/curves.h"

namespace arthronaut::pipeline {

struct NavigateOptions {
  PipelineOptions pipeline;
  std::optional<tunnels::Tunnel> plan;
  double planned_length_mm = 0;
  // Used from the first frame, until the strokes of this video give a reliable one.
  std::optional<registration::RegistrationSummary> registration;
  // What strokes are registered to; null: nothing is registered. Must outlive the call.
  const registration::SurfaceIndex* bone = nullptr;
  std::optional<registration::CartilageRegion> covered = std::nullopt;  // of the bone
  std::uint64_t seed = 1;
  strokes::StrokeOptions strokes;
  // While the guide is seen and no reliable registration exists, one is tried whenever the probe has drawn
  // this much more; below it there is nothing to find.
  double retry_after_mm = 40;
};

// Called in the thread of navigate_video, in the order of events.
struct NavigationObserver {
  std::function<void(const camera::FramePtr& frame, const FrameResult& result)> on_frame;
  // One that was found and is used from the next frame on, or was found after the last one.
  std::function<void(const registration::RegistrationSummary& registration)> on_registration;
};

struct NavigationSummary {
  ViewStatistics statistics;
  std::vector<strokes::PoseRow> rows;
  strokes::Curves curves;
  double stroke_length_mm = 0;
  // The last one that was found; the one that was given where none was found or only an unreliable one.
  std::optional<registration::RegistrationSummary> registration;
  bool registration_was_found = false;  // here, not given
  long frames_with_tip = 0, frames_with_guidance = 0;
  guidance::GuidanceNumbers last_guidance;  // the last valid one; not valid when there was none
  guidance::GuidanceState last_state = guidance::GuidanceState::NoPlan;
  std::vector<std::string> reasons;  // why the result is not reliable; empty when it is
};

// Deterministic for a video, options and seed. Decoding runs in a thread of its own. Throws InvalidInput when
// the options break their contract or a frame has another size than the camera's, and what the source throws.
[[nodiscard]] NavigationSummary navigate_video(sources::FrameSource& source, const NavigateOptions& options,
                                               const NavigationObserver& observer = {});

// Length of all strokes in mm.
[[nodiscard]] double stroke_length_mm(const strokes::Curves& curves);

}  // namespace arthronaut::pipeline
