#include "app/theatre_view/operation_job.h"

#include <array>
#include <ctime>
#include <utility>

#include "arthronaut/version.h"
#include "navigation/pipeline/prefetched_source.h"
#include "planning/geometry/error.h"

namespace arthronaut::theatre_view {

namespace {

constexpr double kTipClearance_px = 45;  // of 1080 lines: what is drawn keeps this far from a tool's tip

const tools::Tool* guide_of(const pipeline::PipelineOptions& options) {
  return options.tools.find_tool(options.guide_name);
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text.data();
}

}  // namespace

OperationJob::OperationJob(const OperationSetup& setup)
    : setup_(setup),
      source_(setup.open_source()),
      prefetched_(std::make_unique<pipeline::PrefetchedSource>(*source_)),
      pipeline_(setup.pipeline),
      overlay_(setup.surface, *setup.drawn_bone, setup.plan, setup.planned_length_mm),
      digitises_(setup.digitises) {
  pipeline_.set_plan(setup.plan, setup.planned_length_mm);
  if (setup.registration) set_registration(*setup.registration, false);
  if (!setup.session_folder.empty()) start_recording(setup.session_folder);
}

OperationJob::~OperationJob() = default;

std::shared_ptr<LiveFrame> OperationJob::step() {
  auto live = std::make_shared<LiveFrame>();
  live->picture = prefetched_->next();
  if (live->picture == nullptr) return nullptr;
  // A camera that stops must not go unnoticed. Recorded and simulated pictures come as the machine can make
  // them.
  constexpr double kDeviceStale_s = 0.2, kOtherStale_s = 2.0;
  live->stale_after_s = source_->info().is_live ? kDeviceStale_s : kOtherStale_s;
  pipeline_.process(*live->picture, live->result);
  if (digitises_ && live->result.tip_is_valid) digitise(live->result);
  drilled_.add(live->result.guidance);
  record(*live);
  project(*live);
  return live;
}

void OperationJob::digitise(const pipeline::FrameResult& result) {
  pipeline::append_pose_rows(result, poses_);
  trail_.push_back(result.tip_in_world_mm);
  const strokes::StrokeOptions limits;
  strokes::CurvePoint point{0, static_cast<double>(result.timestamp_ns) * 1e-9, result.tip_in_world_mm};
  if (last_point_) {
    const bool goes_on = *point.time_s - *last_point_->time_s <= limits.max_gap_s &&
                         (point.position_mm - last_point_->position_mm).norm() <= limits.max_hop_mm;
    point.curve = last_point_->curve + (goes_on ? 0 : 1);
  }
  last_point_ = point;
  new_points_.push_back(point);
}

strokes::Curves OperationJob::take_new_points() { return std::exchange(new_points_, {}); }

void OperationJob::record(const LiveFrame& live) {
  if (recorder_ == nullptr) return;
  // A disk that fails ends the record, not the guidance: the one exception to where exceptions are caught.
  try {
    recorder_->append(live.result);
    if (!source_->info().encoded_file.empty()) return;
    if (source_->info().is_live)
      recorder_->try_append_picture(live.picture);
    else
      recorder_->append_picture(live.picture);
  } catch (const IoError& error) {
    recording_error_ = error.what();
    recorder_.reset();
  }
}

void OperationJob::project(LiveFrame& live) const {
  const pipeline::FrameResult& result = live.result;
  if (!result.camera_from_world.is_valid) return;
  const geometry::RigidTransform& camera_from_world = result.camera_from_world.target_from_source;
  const std::vector<scene::ClearDisc> tips = tool_tips(result);
  if (registration_ && registration_->has_pose && registration_->reliable)
    live.overlay = overlay_.project(result.camera, camera_from_world * registration_->marker_from_bone, tips);
  std::vector<Eigen::Vector3d> curves;
  curves.reserve(trail_.size());
  for (const Eigen::Vector3d& point : trail_) curves.push_back(camera_from_world * point);
  scene::add_curves(live.overlay, result.camera, curves, strokes::StrokeOptions{}.max_hop_mm, tips);
}

std::vector<scene::ClearDisc> OperationJob::tool_tips(const pipeline::FrameResult& result) const {
  std::vector<scene::ClearDisc> tips;
  const geometry::RigidTransform& camera_from_world = result.camera_from_world.target_from_source;
  const double radius = kTipClearance_px * result.camera.image_size_px().y() / 1080.0;
  const auto add = [&](const Eigen::Vector3d& tip_in_world_mm) {
    if (const auto pixel = result.camera.project(camera_from_world * tip_in_world_mm))
      tips.push_back({*pixel, radius});
  };
  if (result.tip_is_valid) add(result.tip_in_world_mm);
  const tools::Tool* guide = guide_of(setup_.pipeline);
  if (guide == nullptr || !guide->axis) return tips;
  for (const pipeline::ToolPose& tool : result.tools)
    if (tool.marker_id == guide->marker_id && tool.world_from_tool.is_valid)
      add(tool.world_from_tool.target_from_source * guide->axis->point_mm);
  return tips;
}

void OperationJob::clear_curves() {
  poses_.clear();
  trail_.clear();
  new_points_.clear();
}

strokes::Curves OperationJob::curves() const {
  return strokes::digitise(poses_, setup_.pipeline.tools, setup_.pipeline.bone, setup_.pipeline.probe_name);
}

void OperationJob::set_registration(const registration::RegistrationSummary& registration,
                                    bool found_in_this_session) {
  registration_ = registration;
  pipeline_.set_registration(registration);
  if (recorder_ == nullptr) return;
  recorder_->set_registration(registration, found_in_this_session);
  if (found_in_this_session) recorder_->set_curves(curves());
}

void OperationJob::start_recording(const std::filesystem::path& session_folder) {
  recording::SessionHeader header;
  header.id = session_folder.filename().string();
  header.started_utc = utc_now();
  header.bone = setup_.pipeline.bone;
  header.side = setup_.pipeline.side;
  header.refractive_index = setup_.pipeline.refractive_index;
  header.probe_name = setup_.pipeline.probe_name;
  header.guide_name = setup_.pipeline.guide_name;
  header.source = source_->info().name;
  header.program_version = kProgramVersion;
  recorder_ = std::make_unique<recording::SessionRecorder>(session_folder, header, setup_.pipeline);
  if (!source_->info().encoded_file.empty()) recorder_->copy_video(source_->info().encoded_file);
  recorder_->set_plan(setup_.plan, setup_.planned_length_mm);
  if (registration_) recorder_->set_registration(*registration_, false);
}

void OperationJob::stop_recording() {
  if (recorder_ == nullptr) return;
  if (!poses_.empty()) recorder_->set_curves(curves());
  record_drilled_tunnel();
  recorder_->finish();
  recorder_.reset();
}

void OperationJob::record_drilled_tunnel() {
  if (!setup_.plan) return;
  std::optional<recording::AchievedTunnel> achieved = drilled_.measured(*setup_.plan);
  if (!achieved) return;
  if (setup_.truth != nullptr) achieved->truth = *setup_.truth;
  recording::write_achieved_file(recorder_->folder() / "achieved.json", *achieved);
  recorder_->add_event({achieved->timestamp_ns, "tunnel drilled", "achieved.json"});
}

const sources::SourceInfo& OperationJob::source_info() const { return source_->info(); }

}  // namespace arthronaut::theatre_view
