#include "app/navigate/operation_job.h"

#include <array>
#include <ctime>
#include <utility>

#include "app/navigate/tool_clearance.h"
#include "arthronaut/version.h"
#include "navigation/pipeline/prefetched_source.h"
#include "planning/geometry/error.h"

namespace arthronaut::navigate {

namespace {

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
  follow_registration();
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
  live->stale_after_s = source_->info().is_live() ? kDeviceStale_s : kOtherStale_s;
  follow_registration();
  pipeline_.process(*live->picture, live->result);
  note_tip(live->result);
  drilled_.add(live->result.guidance);
  record(*live);
  project(*live);
  return live;
}

// What is in force guides from this picture on; an alarm takes it out of force.
void OperationJob::follow_registration() {
  const std::shared_ptr<const RegistrationStatus> status = setup_.registration->status();
  drawn_ = status->drawn;
  if (status->change_count == registration_count_) return;
  registration_count_ = status->change_count;
  registration_ = status->in_force;
  if (registration_ == nullptr) return pipeline_.set_registration(std::nullopt);
  pipeline_.set_registration(*registration_);
  if (recorder_ == nullptr) return;
  try {  // as in record()
    recorder_->set_registration(*registration_, true);
    recorder_->set_curves(setup_.registration->strokes_in_use());
    if (!status->alarm.empty()) recorder_->add_event({last_timestamp_ns_, "alarm", status->alarm});
  } catch (const IoError& error) {
    recording_error_ = error.what();
    recorder_.reset();
  }
}

void OperationJob::note_tip(const pipeline::FrameResult& result) {
  last_timestamp_ns_ = result.timestamp_ns;
  const double time_s = static_cast<double>(result.timestamp_ns) * 1e-9;
  tip_.add(time_s, result.tip_is_valid ? std::optional(result.tip_in_world_mm) : std::nullopt);
  if (!digitises_ || !result.tip_is_valid) return;
  setup_.registration->add_tip(time_s, result.tip_in_world_mm, result.shaft_in_world);
  has_drawn_ = true;
}

std::string OperationJob::take_touch(bool is_control_point) {
  const auto tip_mm = tip_.position_mm();
  if (!tip_mm) return tip_.why_not();
  if (is_control_point)
    setup_.registration->touch_control_point(*tip_mm);
  else
    setup_.registration->add_touch(*tip_mm);
  return "";
}

void OperationJob::record(const LiveFrame& live) {
  if (recorder_ == nullptr) return;
  // A disk that fails ends the record, not the guidance: the one exception to where exceptions are caught.
  try {
    recorder_->append(live.result);
    if (!source_->info().encoded_file.empty()) return;
    if (source_->info().is_live())
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
  const std::vector<scene::ClearDisc> clear = clear_discs_of(result, setup_.pipeline.tools);
  if (registration_ && registration_->has_pose && registration_->reliable)
    live.overlay =
        overlay_.project(result.camera, camera_from_world * registration_->marker_from_bone, clear);
  std::vector<Eigen::Vector3d> curves;
  curves.reserve(drawn_->size());
  for (const strokes::CurvePoint& point : *drawn_) curves.push_back(camera_from_world * point.position_mm);
  scene::add_curves(live.overlay, result.camera, curves, strokes::StrokeOptions{}.max_hop_mm, clear);
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
  if (has_drawn_) recorder_->set_curves(setup_.registration->strokes_in_use());
  record_drilled_tunnel();
  recorder_->finish();
  recorder_.reset();
}

void OperationJob::record_drilled_tunnel() {
  if (!setup_.plan) return;
  std::optional<operation::AchievedTunnel> achieved = drilled_.measured(*setup_.plan);
  if (!achieved) return;
  if (setup_.truth != nullptr) achieved->truth = *setup_.truth;
  operation::write_achieved_file(recorder_->folder() / "achieved.json", *achieved);
  recorder_->add_event({achieved->timestamp_ns, "tunnel drilled", "achieved.json"});
}

const sources::SourceInfo& OperationJob::source_info() const { return source_->info(); }

}  // namespace arthronaut::navigate
