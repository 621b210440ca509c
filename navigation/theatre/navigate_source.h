// A whole operation from a source, with nobody at the pedal: the probe draws from the first frame, strokes
// are registered as they come, all of them when the guide comes into view and at the end. What `arthronaut
// navigate` and the demo do. It is the window's OperationRun, with registration and second looks worked in at
// once; only who gives the commands differs.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "navigation/guidance/guidance_counts.h"
#include "navigation/operation/operation.h"
#include "navigation/pipeline/track_video.h"
#include "navigation/recording/operation_record.h"
#include "navigation/sources/frame_source.h"
#include "navigation/theatre/latency.h"
#include "navigation/theatre/source_watch.h"
#include "navigation/tracker/pose_source.h"
#include "planning/geometry/error.h"

namespace arthronaut::theatre {

struct NavigateOptions {
  operation::SourceSetup source;
  operation::OperationSetup operation;
  // What strokes are registered to; null: nothing is registered.
  operation::SurfaceIndexPtr bone;
  // Used from the first frame; what it is of is checked like any other.
  std::optional<operation::GiveRegistration> registration;
  // Of a live source: whoever began it has said by what patient, bone, plan, camera and tools, and that a
  // nominal guide is used as it is. Without that it guides nobody.
  bool is_confirmed = false;
  // See TheatreSource::tracker.
  std::function<std::unique_ptr<tracker::PoseSource>()> tracker = {};
  double retry_after_mm = 40;        // see OperationSetup::registers_after_mm
  std::optional<double> duration_s;  // frames of later than this are not taken; else to the source's end
};

// Thrown by an observer to end a live source where it is: what was made stays, and nothing is the matter.
class StoppedByHand : public DeviceError {
 public:
  using DeviceError::DeviceError;
};

// Called in the thread of navigate_source.
struct NavigationObserver {
  std::function<void(const camera::FramePtr& picture, const operation::OperationStatePtr& state)> on_frame;
  // Instead of on_frame for a live picture that is not of now (see is_of_now()): by what. Nobody is to take
  // the poses of its state for valid.
  std::function<void(const camera::FramePtr& picture, const std::string& why,
                     const operation::OperationStatePtr& state)>
      on_late;
  // Instead of on_frame, ten times a second while a live source gives no picture: why, and what is known by
  // now.
  std::function<void(const SourceWatch& watch, const operation::OperationStatePtr& state)> on_silence;
  // Asked after each frame: commands to be given before the next one. A script at the pedal.
  std::function<std::vector<operation::Command>(const operation::OperationState& state)> pedal;
};

struct NavigationSummary {
  pipeline::ViewStatistics statistics;
  strokes::Curves curves;
  double drawn_length_mm = 0;  // of the curves, along their samples
  // The one that is in force at the end; none when nothing was found or given.
  std::optional<registration::RegistrationSummary> registration;
  operation::Standing standing = operation::Standing::None;
  bool registration_was_found = false;  // here, not given
  long frames_with_tip = 0;
  guidance::GuidanceCounts guidance_counts;  // of all frames
  // Frames in which a registration stood, and those of them whose picture was seen to show the bone where it
  // lay.
  long frames_registered = 0, frames_bone_seen = 0, frames_bone_otherwise = 0;
  // Frames whose markers look as in another medium than the one in force, and the last verdict that says so.
  long frames_in_other_medium = 0;
  pipeline::MediumVerdict other_medium;
  guidance::GuidanceNumbers last_guidance;  // the last valid one; not valid when there was none
  guidance::GuidanceState last_state = guidance::GuidanceState::NoPlan;
  operation::DrilledState drilled;
  std::string ending;                 // why a live source ended before its end; empty when it did not
  LatencyReport latency{};            // of a live source; of others tracking and operation alone
  std::vector<std::string> troubles;  // what was wrong with a live source, in order, each when it began
  std::vector<std::string> tracker_troubles{};  // likewise with the outside tracker
  std::string record_trouble;        // why the record ended before the source; empty when it did not
  std::string video_trouble{};       // the same of its video alone
  std::vector<std::string> reasons;  // why the result is not reliable; empty when it is
};

struct RecordOptions {
  std::filesystem::path folder;  // exists and is empty; empty path: no record
  recording::KeepVideo keep = recording::KeepVideo::No;
  std::filesystem::path video;  // the source's file or pattern, for Copy and Refer
  recording::PicturesAs pictures = recording::PicturesAs::AsTheyCame;  // for Encode
};

// Deterministic for a source, options and seed. Decoding runs in a thread of its own, which shares the
// source. Throws InvalidInput when the options break their contract or a frame has another size than the
// camera's, IoError when the record can't be begun, and what the source throws; a live source that fails
// after its first picture has ended, which the summary's `ending` tells; so has one of which nothing came for
// 15 s.
[[nodiscard]] NavigationSummary navigate_source(const std::shared_ptr<sources::FrameSource>& source,
                                                const NavigateOptions& options,
                                                const RecordOptions& record = {},
                                                const NavigationObserver& observer = {});

}  // namespace arthronaut::theatre
