// The work of an operation without its threads: one step a frame. Deterministic; tests call it directly.
#pragma once

#include <memory>
#include <vector>

#include "app/theatre_view/operation.h"
#include "app/theatre_view/tunnel_meter.h"

namespace arthronaut::theatre_view {

class OperationJob {
 public:
  explicit OperationJob(const OperationSetup& setup);
  ~OperationJob();

  // The next frame with what is known about it; null at the end of the source. Throws what source and
  // pipeline throw. published_s is left for the caller.
  [[nodiscard]] std::shared_ptr<LiveFrame> step();

  void set_digitising(bool on) { digitises_ = on; }
  [[nodiscard]] bool digitises() const { return digitises_; }
  void clear_curves();
  [[nodiscard]] const std::vector<Eigen::Vector3d>& trail() const { return trail_; }
  [[nodiscard]] strokes::Curves curves() const;
  // Points that were drawn since the last call, numbered by stroke, for the registration that runs along.
  [[nodiscard]] strokes::Curves take_new_points();
  void set_registration(const registration::RegistrationSummary& registration, bool found_in_this_session);

  [[nodiscard]] bool is_recording() const { return recorder_ != nullptr; }
  void start_recording(const std::filesystem::path& session_folder);  // throws IoError
  void stop_recording();                                              // throws IoError
  // Why recording ended by itself; empty while all is well.
  [[nodiscard]] const std::string& recording_error() const { return recording_error_; }
  [[nodiscard]] const sources::SourceInfo& source_info() const;

 private:
  void digitise(const pipeline::FrameResult& result);
  void record(const LiveFrame& live);
  void record_drilled_tunnel();
  void project(LiveFrame& live) const;
  [[nodiscard]] std::vector<scene::ClearDisc> tool_tips(const pipeline::FrameResult& result) const;

  OperationSetup setup_;
  std::unique_ptr<sources::FrameSource> source_, prefetched_;
  pipeline::NavigationPipeline pipeline_;
  scene::OverlayModel overlay_;
  std::optional<registration::RegistrationSummary> registration_;
  bool digitises_ = false;
  std::vector<strokes::PoseRow> poses_;
  std::vector<Eigen::Vector3d> trail_;
  strokes::Curves new_points_;
  std::optional<strokes::CurvePoint> last_point_;
  std::unique_ptr<recording::SessionRecorder> recorder_;
  std::string recording_error_;
  TunnelMeter drilled_;
};

}  // namespace arthronaut::theatre_view
