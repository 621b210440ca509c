// The work of an operation without its threads: one step a frame. Deterministic; tests call it directly.
#pragma once

#include <memory>
#include <vector>

#include "app/navigate/operation.h"
#include "app/navigate/tunnel_meter.h"

namespace arthronaut::navigate {

class OperationJob {
 public:
  explicit OperationJob(const OperationSetup& setup);
  ~OperationJob();

  // The next frame with what is known about it; null at the end of the source. Throws what source and
  // pipeline throw. published_s is left for the caller.
  [[nodiscard]] std::shared_ptr<LiveFrame> step();

  void set_digitising(bool on) { digitises_ = on; }
  [[nodiscard]] bool digitises() const { return digitises_; }
  // Hands the place where the tip stands still to the bone's registration. Returns why it could not; empty
  // when done.
  [[nodiscard]] std::string take_touch(bool is_control_point);

  [[nodiscard]] bool is_recording() const { return recorder_ != nullptr; }
  void start_recording(const std::filesystem::path& session_folder);  // throws IoError
  void stop_recording();                                              // throws IoError
  // Why recording ended by itself; empty while all is well.
  [[nodiscard]] const std::string& recording_error() const { return recording_error_; }
  [[nodiscard]] const sources::SourceInfo& source_info() const;

 private:
  void follow_registration();
  void note_tip(const pipeline::FrameResult& result);
  void record(const LiveFrame& live);
  void record_drilled_tunnel();
  void project(LiveFrame& live) const;

  OperationSetup setup_;
  std::unique_ptr<sources::FrameSource> source_, prefetched_;
  pipeline::NavigationPipeline pipeline_;
  scene::OverlayModel overlay_;
  RegistrationPtr registration_;                  // in force
  std::uint64_t registration_count_ = 0;          // of its changes that were taken in
  std::shared_ptr<const strokes::Curves> drawn_;  // what the overlay shows
  bool digitises_ = false, has_drawn_ = false;
  SteadyTip tip_;
  std::int64_t last_timestamp_ns_ = 0;
  std::unique_ptr<recording::SessionRecorder> recorder_;
  std::string recording_error_;
  TunnelMeter drilled_;
};

}  // namespace arthronaut::navigate
