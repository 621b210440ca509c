#include "navigation/recording/rerun.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "navigation/recording/session_files.h"
#include "planning/geometry/error.h"

namespace arthronaut::recording {

namespace {

pipeline::FrameResult result_of(const RecordedFrame& recorded, const pipeline::PipelineOptions& options) {
  pipeline::FrameResult result;
  result.frame_index = recorded.index;
  result.timestamp_ns = recorded.timestamp_ns;
  result.lens = recorded.lens;
  result.intrinsics_are_known = recorded.intrinsics_are_known;
  result.is_frozen = recorded.is_frozen;
  const auto& outside = options.tools.tracker;
  result.outside = recorded.outside;
  const auto pose_of = [&](int marker_id, bool is_of_several) {
    geometry::TrackedPose pose;
    if (outside) {
      pose = tracker::pose_of(recorded.outside, marker_id, recorded.timestamp_ns, *outside);
      pose.is_valid = pose.is_valid && !recorded.is_frozen;
      return pose;
    }
    pose.timestamp_ns = recorded.timestamp_ns;
    for (const strokes::PoseRow& row : recorded.poses) {
      if (row.marker_id != marker_id) continue;
      pose.is_valid = !recorded.is_frozen;
      pose.target_from_source = row.camera_from_marker;
    }
    // A body of several markers has a pose of its own: that of its first marker is not it.
    if (!is_of_several) return pose;
    pose.is_valid = false;
    for (const RecordedBody& body : recorded.bodies) {
      if (body.id != marker_id) continue;
      pose.is_valid = !recorded.is_frozen;
      pose.target_from_source = body.camera_from_body;
    }
    return pose;
  };
  geometry::TrackedPose& world_pose = outside ? result.tracker_from_world : result.camera_from_world;
  if (const auto* world = options.tools.find_world_marker(options.bone))
    world_pose = pose_of(world->marker_id, !world->markers.empty());
  const geometry::TrackedPose world_from_reference = geometry::inverse(world_pose);
  for (const tools::Tool& tool : options.tools.tools)
    result.tools.push_back(
        {tool.marker_id,
         geometry::compose(world_from_reference, pose_of(tool.marker_id, !tool.markers.empty()))});
  result.tip_is_valid = recorded.tip_is_valid;
  result.tip_in_world_mm = recorded.tip_in_world_mm;
  for (std::size_t i = 0; i < result.tools.size(); ++i) {
    const tools::Tool& tool = options.tools.tools[i];
    const auto shaft = tools::shaft_direction(tool);
    if (recorded.tip_is_valid && tool.name == options.probe_name && shaft)
      result.shaft_in_world = result.tools[i].world_from_tool.target_from_source.rotate(*shaft);
  }
  result.guidance = recorded.guidance;
  return result;
}

operation::Command command_of(const RecordedSession& session, const SessionEvent& event) {
  return operation::command_from_text(event.text, database_file(session.folder()).string());
}

// What the pictures showed of the bone is the record's, too: pictures that it did not keep count in it.
operation::OperationSetup hearing_of_drifts(operation::OperationSetup setup) {
  setup.hears_of_drifts = true;
  return setup;
}

}  // namespace

Rerun::Rerun(const operation::OperationSetup& setup, Registrations registrations,
             const operation::SurfaceIndexPtr& bone)
    : registrations_(registrations), operation_(hearing_of_drifts(setup)) {
  if (registrations != Registrations::FoundAgain) return;
  work_.emplace([&] { return bone; }, operation::work_options(setup));
  outcomes_[0] = work_->outcome();
}

void Rerun::start(const RecordedSession& session) {
  session_ = &session;
  pipeline_ = session.pipeline_options();
  next_event_ = 0;
  looks_.clear();
  journal_.clear();
  const SessionHeader& header = session.header();
  has_journal_ = header.has_journal();
  play_before_source();
  operation::SourceSetup source;
  source.kind = header.source_kind.value_or(sources::SourceKind::Recording);
  source.draws = header.probe_drew_at_start;
  source.time_out_first = header.time_out_first;
  source.title = header.source;
  source.pipeline = pipeline_;
  operation_.start_source(source);
  pass_on();
}

void Rerun::play_before(std::int64_t frame) {
  const auto& events = session_->events();
  for (; next_event_ < events.size() && events[next_event_].after_frame < frame; ++next_event_)
    play(events[next_event_]);
}

void Rerun::play_rest() {
  for (; next_event_ < session_->events().size(); ++next_event_) play(session_->events()[next_event_]);
  operation_.end_source();
  pass_on();
}

operation::OperationStatePtr Rerun::process(const camera::Frame& picture, const RecordedFrame& recorded) {
  operation_.process(picture, &recorded.outside, [&](const pipeline::FrameResult&) {
    return operation::timing_of(recorded.guidance.state);
  });
  const operation::OperationStatePtr state = operation_.state();
  if (auto request = operation_.take_look_request())
    looks_[picture.index] = look_work_.look(std::move(*request), picture);
  pass_on();
  return state;
}

operation::OperationStatePtr Rerun::process(const RecordedFrame& recorded) {
  operation_.process_recorded(result_of(recorded, pipeline_));
  const operation::OperationStatePtr state = operation_.state();
  pass_on();
  return state;
}

bool Rerun::run(const RecordedSession& session, const std::function<bool()>& stops) {
  start(session);
  const bool is_whole = session.for_each_frame([&](const RecordedFrame& frame) {
    if (stops && stops()) return false;
    play_before(frame.index);
    operation_.process_recorded(result_of(frame, pipeline_));
    pass_on();
    return true;
  });
  if (is_whole) play_rest();
  return is_whole;
}

// What was given before any source ran, where the record says so.
void Rerun::play_before_source() {
  const auto& events = session_->events();
  const auto started = std::find_if(events.begin(), events.end(), [](const SessionEvent& event) {
    return event.kind == kSourceStartedEvent;
  });
  if (started == events.end()) return;
  while (events.begin() + static_cast<std::ptrdiff_t>(next_event_) != started) play(events[next_event_++]);
}

std::int64_t Rerun::number_of(const SessionEvent& event) const {
  std::int64_t number = 0;
  const char* const end = event.text.data() + event.text.size();
  if (const auto [at, error] = std::from_chars(event.text.data(), end, number);
      error != std::errc() || at != end)
    throw InvalidInput(database_file(session_->folder()), "events",
                       "\"" + event.text + "\" of " + event.kind + " is no number");
  return number;
}

void Rerun::play(const SessionEvent& event) {
  if (event.kind == kCommandEvent) {
    play_command(command_of(*session_, event));
  } else if (event.kind == kOutcomeEvent) {
    const auto outcome = outcomes_.find(number_of(event));
    if (outcome != outcomes_.end()) operation_.take_outcome(outcome->second);
  } else if (event.kind == kLookEvent) {
    const auto look = looks_.find(number_of(event));
    if (look != looks_.end()) operation_.take_look(look->second);
  } else if (event.kind == kLookFailedEvent) {
    play_failed_look(event);
  } else if (event.kind == kBoneMovedEvent) {
    operation_.tell_bone_moved(
        operation::seen_drift_from_text(event.text, database_file(session_->folder()).string()));
  } else if (event.kind == kBoneLooksEvent) {
    operation_.tell_bone_looks(
        operation::seen_looks_from_text(event.text, database_file(session_->folder()).string()));
  } else if (event.kind == kMediumWrongEvent) {
    operation_.tell_medium_wrong(
        operation::seen_medium_from_text(event.text, database_file(session_->folder()).string()));
  } else if (event.kind == kSourceEndedEvent) {
    operation_.end_source();
  } else if (!has_journal_ && event.kind == kPlanEvent) {
    const RecordedSession::PlanChange change = session_->plan_of(event);
    operation::OfferPlan offer{.plan = std::nullopt, .moves_target = false};
    if (change.plan) offer.plan = {*change.plan, change.planned_length_mm};
    operation_.apply(offer);
    operation_.apply(operation::TakePlanOver{});
  } else if (is_registration(event) && (!has_journal_ || registrations_ == Registrations::AsRecorded)) {
    play_registration(event);
  }
  pass_on();
}

// It failed there, whatever is seen here.
void Rerun::play_failed_look(const SessionEvent& event) {
  SessionEvent of_frame = event;
  of_frame.text.resize(std::min(event.text.find(':'), event.text.size()));
  const auto look = looks_.find(number_of(of_frame));
  if (look == looks_.end()) return;
  auto failed = std::make_shared<operation::MediumLook>(*look->second);
  failed->in_other_medium.clear();
  failed->failure = event.text;
  operation_.take_look(failed);
}

// Which of the registrations is in force says the record itself, where they are taken from it.
void Rerun::play_command(const operation::Command& command) {
  const bool is_of_registrations = std::holds_alternative<operation::GiveRegistration>(command) ||
                                   std::holds_alternative<operation::ChooseRegistration>(command) ||
                                   std::holds_alternative<operation::RegisterStrokes>(command);
  if (!is_of_registrations || registrations_ != Registrations::AsRecorded) operation_.apply(command);
}

void Rerun::play_registration(const SessionEvent& event) {
  const registration::RegistrationSummary registration = session_->registration_of(event);
  operation::SourceSetup source;
  source.kind = sources::SourceKind::Recording;
  source.pipeline = pipeline_;
  const bool is_as_recorded = registrations_ == Registrations::AsRecorded;
  // What does not guide anyway is left as it is: one that waits for a touch is void here as it was there.
  const bool guides = operation_.state()->registration->in_force.standing == operation::Standing::Stands;
  if (is_as_recorded && !registration.reliable && !guides) return;
  operation_.apply(operation::GiveRegistration{
      registration,
      is_as_recorded ? operation_.now() : operation::provenance_of(operation_.setup(), source)});
}

void Rerun::pass_on() {
  for (operation::JournalEntry& entry : operation_.take_journal()) journal_.push_back(std::move(entry));
  for (const operation::RegistrationRequest& request : operation_.take_requests())
    if (work_ && work_->work_in(request)) outcomes_[work_->outcome()->request_count] = work_->outcome();
}

std::vector<RecordedSession> sessions_before(const RecordedSession& session,
                                             const std::function<void(const std::string& id)>& missing) {
  std::vector<RecordedSession> before;
  const auto goes_on_from = [](const RecordedSession& from) {
    return resumed_by(from) ? std::string() : from.header().continues;
  };
  std::string id = goes_on_from(session);
  while (!id.empty()) {
    const std::filesystem::path folder = session.folder().parent_path() / id;
    if (!std::filesystem::exists(folder)) {
      missing(id);
      break;
    }
    before.push_back(RecordedSession::without_frames(folder));
    id = goes_on_from(before.back());
  }
  std::reverse(before.begin(), before.end());
  return before;
}

operation::OperationSetup setup_of(const RecordedSession& first) {
  operation::OperationSetup setup;
  setup.bone = first.header().bone;
  setup.mesh_sha256 = first.header().mesh_sha256;
  if (first.header().registers_after_mm > 0) setup.registers_after_mm = first.header().registers_after_mm;
  for (const SessionEvent& event : first.events()) {
    if (event.kind != kPlanEvent) continue;
    const RecordedSession::PlanChange change = first.plan_of(event);
    if (change.plan) setup.plan = {*change.plan, change.planned_length_mm};
    break;
  }
  return setup;
}

std::optional<operation::ResumeOperation> resumed_by(const RecordedSession& session) {
  for (const SessionEvent& event : session.events()) {
    if (event.kind == kSourceStartedEvent) break;
    if (event.kind != kCommandEvent) continue;
    operation::Command command = command_of(session, event);
    if (auto* resume = std::get_if<operation::ResumeOperation>(&command)) return std::move(*resume);
  }
  return std::nullopt;
}

}  // namespace arthronaut::recording
