// One run of the navigation on one source, in a thread of its own: pictures in, live frames out, newest wins.
// The window reads status() and asks for changes; nothing here knows the window.
//
// What the probe draws goes to the bone's registration (bone_registration.h), and what is in force there
// guides from the next picture on. register_curves() asks for a registration of all that was drawn.
//
// Threads: the worker takes frames, runs the pipeline, projects the overlay and is the one that talks to the
// recorder; registrations run in threads of their own and hand their results to the worker. Every public
// function may be called from any thread and none of them waits, but the destructor, which joins both:
// request_stop() first and destroy it elsewhere where that would freeze a screen. States: starting -> running
// -> ended | failed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/navigate/bone_registration.h"
#include "app/scene/plan_overlay.h"
#include "navigation/pipeline/navigation_pipeline.h"
#include "navigation/recording/session.h"
#include "navigation/sources/frame_source.h"

namespace arthronaut::navigate {

struct OperationSetup {
  std::string title;                                                   // "Simulated operation: probe"
  std::string calibration;                                             // in use, in words
  std::function<std::unique_ptr<sources::FrameSource>()> open_source;  // called on the worker
  pipeline::PipelineOptions pipeline;
  std::optional<tunnels::Tunnel> plan;
  double planned_length_mm = 0;
  std::shared_ptr<const geometry::Surface> surface;
  std::shared_ptr<const geometry::TriangleMesh> drawn_bone;
  std::shared_ptr<BoneRegistration> registration;  // of the bone, not null
  bool digitises = true;                           // from the first frame
  // Where the tunnel truly goes; the simulated source alone knows. Filled in by open_source, null else.
  std::shared_ptr<std::optional<tunnels::Tunnel>> truth;
  std::filesystem::path session_folder;  // recorded when not empty
};

// One picture and everything known about it; the overlay belongs to this very picture.
struct LiveFrame {
  camera::FramePtr picture;
  pipeline::FrameResult result;
  scene::PlanOverlay overlay;  // empty when no pose of this frame stands
  double published_s = 0;      // steady clock
  double stale_after_s = 0.2;  // how long it may stand on the screen as live
};

struct OperationStatus {
  enum class Phase { Starting, Running, Ended, Failed } phase = Phase::Starting;
  std::string message;                    // why it failed
  std::shared_ptr<const LiveFrame> live;  // the newest; null before the first
  double frames_per_second = 0;           // that were navigated, lately
  bool digitises = false;
  bool is_registering = false;
  // Of the bone's registration, never null; filled in by who shows it.
  std::shared_ptr<const RegistrationStatus> bone = std::make_shared<RegistrationStatus>();
  std::string touch_notice;         // why a touch was not taken a moment ago; empty else
  std::filesystem::path recording;  // the session's folder while it is recorded, else empty
  std::string recording_error;
};

class Operation {
 public:
  // on_news is called from the worker whenever status() has changed; it must not call back into the
  // operation.
  Operation(OperationSetup setup, std::function<void()> on_news);
  ~Operation();
  Operation(const Operation&) = delete;
  Operation& operator=(const Operation&) = delete;

  [[nodiscard]] OperationStatus status() const;
  [[nodiscard]] bool is_busy() const;  // pictures or a registration are to come
  [[nodiscard]] const pipeline::PipelineOptions& options() const;
  [[nodiscard]] const std::string& title() const;
  [[nodiscard]] const std::string& calibration() const;
  [[nodiscard]] static double now_s();  // the clock of published_s

  // From now on nothing of it takes effect any more; it ends as soon as it can.
  void request_stop();

  void set_digitising(bool on);
  // Takes the place where the tip stands still for a touch that verifies, or for the control point. The probe
  // stops drawing: a touch must not be used in the fit.
  void take_touch(bool is_control_point);
  void register_curves();  // nothing happens while one is running or nothing was touched
  void start_recording(const std::filesystem::path& session_folder);
  void stop_recording();

 private:
  class Worker;
  std::unique_ptr<Worker> worker_;
};

}  // namespace arthronaut::navigate
