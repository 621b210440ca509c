#include "app/command_line/demo_operation.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <mutex>

#include "app/case/case_calibration.h"
#include "app/command_line/frame_dump.h"
#include "app/command_line/interruption.h"
#include "app/command_line/tracking_report.h"
#include "app/report/report.h"
#include "app/scene/overlay_picture.h"
#include "app/scene/tool_clearance.h"
#include "navigation/calibration/calibration.h"
#include "navigation/operation/achieved_tunnel.h"
#include "navigation/recording/operation_record.h"
#include "navigation/simulator/simulated_operation.h"
#include "navigation/strokes/body_rows.h"
#include "navigation/theatre/navigate_source.h"
#include "navigation/tools/pivot_calibration.h"
#include "planning/bones/mesh_hash.h"
#include "planning/cases/case.h"
#include "planning/files/fixed_number.h"
#include "planning/files/utc_clock.h"
#include "planning/geometry/error.h"
#include "planning/geometry/quantile.h"
#include "planning/phantom/phantom_case.h"

namespace arthronaut::command_line {

namespace {

namespace fs = std::filesystem;
using simulator::Phase;

// Enough for a tip that is sure; the swing's own 130 frames would take as long again to render.
constexpr int kPivotFrames = 70;

// Ctrl+C during minutes of work: what was begun is removed before the program ends.
void stop_if_interrupted(const Interruption& interruption) {
  if (interruption.caught() != 0) throw DeviceError("the demo was stopped by hand");
}

// Keeps how deep the drill truly was in every frame: frames are rendered in another thread than they are
// tracked in.
class WatchedOperation : public sources::FrameSource {
 public:
  WatchedOperation(const simulator::SimulationOptions& options, Phase phase, const Interruption& interruption)
      : operation_(options, phase), interruption_(interruption) {}
  const sources::SourceInfo& info() const override { return operation_.info(); }
  camera::FramePtr next() override {
    stop_if_interrupted(interruption_);
    camera::FramePtr frame = operation_.next();
    const std::lock_guard lock(mutex_);
    if (frame) depth_mm_[frame->index] = operation_.truth().drilled_depth_mm;
    return frame;
  }
  [[nodiscard]] double depth_mm(std::int64_t frame) const {
    const std::lock_guard lock(mutex_);
    return depth_mm_.at(frame);
  }
  [[nodiscard]] const simulator::SimulatedOperation& operation() const { return operation_; }

 private:
  simulator::SimulatedOperation operation_;
  const Interruption& interruption_;
  mutable std::mutex mutex_;
  std::map<std::int64_t, double> depth_mm_;
};

class Demo {
 public:
  Demo(Context& context, const DemoOptions& options, const Interruption& interruption)
      : context_(context),
        options_(options),
        interruption_(interruption),
        started_(std::chrono::steady_clock::now()) {}

  void run() {
    plan();
    if (!calibrate()) return;
    pivot();
    scratch();
    if (drill()) say_result();
    finish();
  }

 private:
  void step(const std::string& name) {
    stop_if_interrupted(interruption_);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started_;
    context_.say(format("[%5.1f s] ", elapsed.count()) + name);
  }

  void plan() {
    step("Plan: a " + std::string(bones::to_text(options_.side)) +
         " phantom knee with its anatomical tunnels");
    simulation_.knee = phantom::make_phantom_knee({.side = options_.side, .seed = options_.seed});
    simulation_.camera = simulator::standard_camera();
    simulation_.tools = tools::standard_tools();
    simulation_.plan = simulation_.knee.femoral_tunnel;
    simulation_.seed = options_.seed;
    simulation_.surroundings = options_.surroundings;
    const geometry::TriangleMesh& mesh = simulation_.knee.femur.mesh;
    femur_ = std::make_shared<const geometry::Surface>(mesh);
    planned_length_mm_ = tunnels::measure(simulation_.plan, *femur_).length_mm;
    cases::save_case(options_.case_folder,
                     phantom::case_of(simulation_.knee, options_.case_folder.stem().string()));
    fs::create_directory(options_.case_folder / "pictures");
    context_.say(format("          femur of %zu triangles; tunnel of %.1f mm, diameter %.1f mm",
                        mesh.triangles.size(), planned_length_mm_, simulation_.plan.diameter_mm));
  }

  bool calibrate() {
    step("Calibrate: stills of a checkerboard in air, the lens turned in between");
    WatchedOperation source(simulation_, Phase::Calibrate, interruption_);
    std::vector<calibration::CalibrationPicture> pictures;
    std::vector<std::uint8_t> gray;
    while (const camera::FramePtr frame = source.next()) {
      camera::gray_from(*frame, gray);
      auto picture = calibration::observe_picture("still " + std::to_string(frame->index),
                                                  {gray.data(), frame->width, frame->height, frame->width});
      // As in theatre: a still without a board is not used. One without a mark is: the others give its lens
      // angle.
      if (picture.board.found()) {
        pictures.push_back(std::move(picture));
      } else {
        context_.say("          " + picture.name + " is left out: " + picture.board.reason);
      }
    }
    if (pictures.size() < 3) {
      context_.say_unreliable("the calibration", {"fewer than three stills show a board"});
      return false;
    }
    calibration::CalibrationOptions options;
    options.square_mm = simulation_.square_mm;
    options.scope_name = camera::kSimulatedScope;
    calibration::CalibrationSummary summary = calibration::calibrate(pictures, options);
    if (!summary.is_usable()) {
      context_.say_unreliable("the calibration", summary.reasons);
      return false;
    }
    for (const std::string& note : summary.notes) context_.say("          " + note);
    summary.record.provenance = {provenance::Origin::Simulated, summary.record.date_utc};
    camera::write_camera_file(cases::camera_file(options_.case_folder), summary.record);
    navigation_.source.pipeline.calibration = summary.record.calibration;
    navigation_.source.pipeline.calibrated =
        std::make_shared<const camera::CalibrationRecord>(summary.record);
    const camera::Calibration& found = summary.record.calibration;
    context_.say(format(
        "          %zu stills, rms %.2f px; focal length %s %%, principal point %.1f px from the truth",
        pictures.size(), summary.rms_px,
        files::fixed(100 * (found.focal_px / simulation_.camera.focal_px - 1), 2).c_str(),
        (found.principal_point_px -
         simulation_.camera.turned(simulation_.camera.principal_point_px,
                                   simulation_.camera.lens_angle_rad(found.reference_mark_angle_deg)))
            .norm()));
    if (summary.outcome == calibration::CalibrationSummary::Outcome::Unreliable) {
      context_.say_unreliable("the calibration", summary.reasons);
    }
    return true;
  }

  // From here on in saline, with the camera and the tip that were found, not the true ones.
  void pivot() {
    step("Pivot: the probe swings about its tip");
    pipeline::ViewTrackerOptions view;
    view.calibration = navigation_.source.pipeline.calibration;
    view.refractive_index = simulation_.refractive_index;
    simulator::SimulationOptions swing = simulation_;
    swing.frame_count = kPivotFrames;
    WatchedOperation source(swing, Phase::Pivot, interruption_);
    const pipeline::TrackedVideo tracked = pipeline::track_video(source, view, simulation_.tools);
    tools::ToolSet tools = simulation_.tools;
    const auto probe =
        std::find_if(tools.tools.begin(), tools.tools.end(), [](const auto& t) { return t.name == "probe"; });
    const int world_id = tools.find_world_marker(simulation_.bone)->marker_id;
    std::map<std::int64_t, geometry::RigidTransform> camera_from_world;
    const std::vector<strokes::PoseRow> rows = strokes::body_rows(tracked.rows, tools);
    for (const strokes::PoseRow& row : rows) {
      if (row.marker_id == world_id) camera_from_world[row.frame] = row.camera_from_marker;
    }
    std::vector<geometry::RigidTransform> world_from_probe;
    for (const strokes::PoseRow& row : rows) {
      const auto world = camera_from_world.find(row.frame);
      if (row.marker_id != probe->marker_id || world == camera_from_world.end()) continue;
      world_from_probe.push_back(world->second.inverse() * row.camera_from_marker);
    }
    const tools::PivotCalibrationSummary summary = tools::calibrate_pivot(world_from_probe);
    if (summary.has_tip()) {
      context_.say(format("          %d poses, rms %.3f mm, cone %.0f deg; tip %.3f mm from the truth",
                          summary.pose_count, summary.rms_mm, summary.cone_deg,
                          (summary.tip_in_tool_mm - *probe->tip_mm).norm()));
    }
    if (summary.is_usable()) {
      probe->tip_mm = summary.tip_in_tool_mm;
      probe->tip_covariance_mm2 = summary.tip_error_mm2();
      probe->residual_mm = summary.rms_mm;
      probe->provenance = {provenance::Origin::Simulated, files::utc_now()};
    } else {
      context_.say_unreliable("the pivot (the tip stays as made)", summary.reasons);
    }
    tools::write_tools_file(cases::tools_file(options_.case_folder), tools);
    navigation_.source.pipeline.tools = tools;
    navigation_.source.pipeline.refractive_index = simulation_.refractive_index;
    navigation_.source.pipeline.bone = simulation_.bone;
    navigation_.source.pipeline.side = options_.side;
    navigation_.operation.bone = simulation_.bone;
    navigation_.operation.mesh_sha256 = bones::mesh_sha256(simulation_.knee.femur.mesh);
    navigation_.operation.surface = femur_;
    navigation_.operation.plan = {simulation_.plan, planned_length_mm_};
  }

  void scratch() {
    step("Scratch: the probe draws on the notch wall, and the femur is found from nothing");
    navigation_.bone = std::make_shared<const registration::SurfaceIndex>(simulation_.knee.femur.mesh);
    const theatre::NavigationSummary summary = navigate(Phase::Scratch, "scratch");
    navigation_.bone = nullptr;
    if (summary.registration)
      navigation_.registration = {*summary.registration,
                                  operation::provenance_of(navigation_.operation, navigation_.source)};
    if (summary.registration && summary.registration->has_pose) {
      const Eigen::Vector3d& entry = simulation_.plan.entry_mm;
      context_.say(format(
          "          strokes of %.0f mm; rms %.2f mm, predicted error at the entry %.2f mm, true error %.2f "
          "mm",
          summary.drawn_length_mm, summary.registration->rms_mm, summary.registration->predicted_tre_mm,
          (summary.registration->marker_from_bone * entry - true_marker_from_bone_ * entry).norm()));
    }
    if (!summary.reasons.empty()) context_.say_unreliable("the registration", summary.reasons);
  }

  bool drill() {
    step("Drill: the guide is led to the plan, and the tunnel is drilled");
    const theatre::NavigationSummary summary = navigate(Phase::Drill, "drill");
    context_.say(format("          guidance in %ld of %ld frames",
                        summary.guidance_counts.of(guidance::GuidanceState::Valid),
                        summary.statistics.frame_count));
    if (!summary.drilled.tunnel) {
      context_.say_unreliable("the drilled tunnel",
                              {std::string(guidance::to_text(summary.drilled.evidence)) + ": " +
                               std::string(guidance::to_text(summary.last_state))});
      return false;
    }
    achieved_ = *summary.drilled.tunnel;
    context_.say(format("          the tunnel measured in %d poses of the guide", achieved_.pose_count));
    achieved_.truth = true_tunnel_;
    recording::rewrite_file(last_session_, "achieved.json", [&] {
      operation::write_achieved_file(last_session_ / "achieved.json", achieved_);
    });
    return true;
  }

  // One phase as a session of the case; its last frame with a registration becomes a picture.
  theatre::NavigationSummary navigate(Phase phase, const std::string& name) {
    const auto source = std::make_shared<WatchedOperation>(simulation_, phase, interruption_);
    last_session_ = cases::create_session_folder(options_.case_folder);
    camera::FramePtr last_frame;
    pipeline::FrameResult last_result;
    Progress progress(name, static_cast<long>(source->info().frame_count));
    long done = 0;
    theatre::NavigationObserver observer;
    observer.on_frame = [&](const camera::FramePtr& frame, const operation::OperationStatePtr& now) {
      const operation::OperationState& state = *now;
      const pipeline::FrameResult& result = state.frame;
      progress.advance_to(++done);
      if (!result.camera_from_world.is_valid) return;
      last_frame = frame;
      last_result = result;
    };
    // With the last picture the surgeon reads the depth stop, to the millimetre, and says that he has
    // drilled.
    observer.pedal = [&](const operation::OperationState& state) -> std::vector<operation::Command> {
      const bool has_drilled =
          phase == Phase::Drill && state.frame.frame_index + 1 == source->info().frame_count;
      if (!has_drilled) return {};
      return {operation::ReadDepthStop{std::round(source->depth_mm(state.frame.frame_index))},
              operation::TunnelDrilled{}};
    };
    theatre::RecordOptions record;
    record.folder = last_session_;
    record.keep = recording::KeepVideo::Encode;
    navigation_.source.title = "Simulated operation: " + name;
    const theatre::NavigationSummary summary =
        theatre::navigate_source(source, navigation_, record, observer);
    if (const auto reasons = record_reasons(summary); !reasons.empty())
      context_.say_unreliable("the record of \"" + name + "\"", reasons);
    true_marker_from_bone_ = source->operation().marker_from_bone();
    if (phase == Phase::Drill) true_tunnel_ = source->operation().drilled_tunnel();
    if (last_frame) write_picture(name, *last_frame, last_result, summary.registration);
    return summary;
  }

  // With the plan where registration and world marker of this frame put it; without them the frame alone.
  void write_picture(const std::string& name, const camera::Frame& frame, const pipeline::FrameResult& result,
                     const std::optional<registration::RegistrationSummary>& registration) const {
    scene::Image picture = image_of(frame);
    if (registration && registration->has_pose && result.camera_from_world.is_valid) {
      const geometry::TriangleMesh& bone = simulation_.knee.femur.mesh;
      const scene::OverlayModel overlay(std::make_shared<geometry::Surface>(bone), bone, simulation_.plan,
                                        planned_length_mm_);
      const auto clear = scene::clear_discs_of(result, navigation_.source.pipeline.tools);
      const geometry::RigidTransform camera_from_bone =
          result.camera_from_world.target_from_source * registration->marker_from_bone;
      scene::draw_overlay(picture, overlay.project(result.camera, camera_from_bone, clear));
    }
    scene::mark_simulated(picture);
    scene::write_png(options_.case_folder / "pictures" / (name + ".png"), picture);
  }

  void say_result() {
    const auto line = [&](const char* what, const operation::TunnelDifference& d) {
      context_.say(format("          %s: entry %.2f mm, angle %.2f deg", what, d.entry_mm, d.angle_deg));
    };
    line("planned against measured ", operation::compare(achieved_.planned, achieved_.measured));
    line("planned against the truth", operation::compare(achieved_.planned, *achieved_.truth));
    line("measured against the truth", operation::compare(*achieved_.truth, achieved_.measured));
  }

  void finish() {
    step("Report");
    const fs::path report = options_.case_folder / "report.pdf";
    report::write_report(options_.case_folder, report);
    step("Done");
    context_.say("case:     " + options_.case_folder.string());
    context_.say("report:   " + report.string());
    context_.say("pictures: " + (options_.case_folder / "pictures").string());
  }

  Context& context_;
  DemoOptions options_;
  const Interruption& interruption_;
  std::chrono::steady_clock::time_point started_;
  simulator::SimulationOptions simulation_;  // the truth
  theatre::NavigateOptions navigation_;      // what the theatre has found so far
  std::shared_ptr<const geometry::Surface> femur_;
  double planned_length_mm_ = 0;
  fs::path last_session_;
  geometry::RigidTransform true_marker_from_bone_;
  tunnels::Tunnel true_tunnel_;
  operation::AchievedTunnel achieved_;
};

}  // namespace

void run_demo(Context& context, const DemoOptions& options) {
  const Interruption interruption;
  try {
    Demo(context, options, interruption).run();
  } catch (...) {
    std::error_code ignored;
    fs::remove_all(options.case_folder, ignored);
    if (interruption.caught() != 0) interruption.end_program();
    throw;
  }
}

}  // namespace arthronaut::command_line
