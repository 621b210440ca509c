#include "navigation/operation/operation.h"

#include <utility>

#include "navigation/operation/operation_parts.h"

namespace arthronaut::operation {

registration::Provenance provenance_of(const OperationSetup& setup, const SourceSetup& source,
                                       int placement) {
  const pipeline::PipelineOptions& options = source.pipeline;
  registration::Provenance now;
  now.mesh_sha256 = setup.mesh_sha256;
  now.bone = setup.bone;
  if (const auto* marker = options.tools.find_world_marker(setup.bone))
    now.world_marker_id = marker->marker_id;
  now.placement = placement;
  now.camera = registration::camera_identity(options.calibration);
  now.tools = registration::tools_identity(options.tools, setup.bone, options.probe_name);
  now.refractive_index = options.refractive_index;
  now.source = source.kind;
  return now;
}

RegistrationWorkOptions work_options(const OperationSetup& setup) {
  RegistrationWorkOptions options;
  options.online.seed = options.fit.seed = setup.seed;
  options.online.cartilage = options.fit.cartilage = setup.cartilage;
  if (setup.plan) {
    options.online.target_in_bone_mm = options.fit.target_in_bone_mm = setup.plan->tunnel.entry_mm;
    options.online.direction_in_bone = setup.plan->tunnel.direction;
  }
  return options;
}

Operation::Operation(OperationSetup setup) : parts_(std::make_unique<Parts>(std::move(setup))) {
  parts_->note_plan();  // what the registration was set up with, whatever is offered before a source runs
}
Operation::~Operation() = default;

void Operation::start_source(const SourceSetup& source) {
  Parts& p = *parts_;
  // First what may throw: then nothing has changed.
  auto pipeline = std::make_unique<pipeline::NavigationPipeline>(source.pipeline);
  const registration::Provenance now = provenance_of(p.setup, source, p.ledger.now().placement);
  const bool is_first = p.source == nullptr && p.resumed == nullptr;
  p.pipeline = std::move(pipeline);
  p.source = std::make_shared<const SourceSetup>(source);
  p.has_source = true;
  p.medium.on_source(source.pipeline);
  p.seen_medium.reset();
  p.strokes.on_source();
  p.confirmed.on_source(source.pipeline);
  p.bone_watch.on_source(source.pipeline.calibration.image_size_px);
  p.frame = {};
  p.frame_count = 0;
  p.timing = PictureTiming::InTime;
  p.note(JournalKind::SourceStarted);
  p.tip.clear();
  p.drilling.on_source(p.plan);
  p.touch.refusal = TouchRefusal::None;
  p.in_view.on_source();
  p.grades.on_other_numbers();
  p.marker_is_out = false;
  p.pipeline->set_bone(p.setup.surface);
  p.pipeline->set_plan(p.plan ? std::optional(p.plan->tunnel) : std::nullopt, p.plan ? p.plan->length_mm : 0);
  // What differed from the plan of before the crash was offered by nobody who saw it: it is still asked for.
  if (p.offered && !p.resumed_plan_waits)
    p.take_offered();
  else
    p.note_plan();
  if (registration::mismatch_but_placement(p.ledger.now(), now)) p.stroke_bias.on_other_source();
  p.ledger.set_now(now);
  p.guide_check.begin(source.pipeline, now, source.kind == sources::SourceKind::Live);
  p.note_guide_check();
  if (!p.strokes.points().empty() && registration::mismatch_of(p.strokes_of, now)) {
    p.set_aside_count += p.strokes.points().size();
    p.clear_strokes();
  }
  p.look_for_end_of_loss();  // another world takes with it what rested on the marker
  // Nobody saw the marker between two sources, however long that was.
  if (!is_first && source.kind == sources::SourceKind::Live) p.marker_may_have_moved();
  p.hand_registration();
  if (p.ledger.in_force().registration != nullptr) p.note_in_force(true);
  p.followed.change = p.ledger.change_count();
  // Each record says how it stands from its beginning on, whatever the one before it said.
  p.followed.standing = Standing::None;
  p.followed.is_verified = false;
  p.follow_ledger();
  const RegistrationInForce& in_force = p.ledger.in_force();
  // What was resumed waits for a touch; what is drawn meanwhile would be of a marker that nobody has checked.
  const bool waits_for_touch =
      p.resumed != nullptr && in_force.standing == Standing::Void && in_force.can_be_confirmed;
  p.draws = source.draws && in_force.standing != Standing::Stands && !waits_for_touch;
}

void Operation::end_source() {
  Parts& p = *parts_;
  if (!p.has_source) return;
  p.take_seen();
  p.note(JournalKind::SourceEnded);
  p.bone_watch.on_source_end();
  p.has_source = p.draws = false;
  p.tip.clear();
  p.guide_check.end_source();
  p.end_frame();
  p.medium.on_source_end();
}

void Operation::process(const camera::Frame& frame, const tracker::TrackerPoses* outside,
                        const AskTiming& timing) {
  parts_->take_seen();
  parts_->pipeline->process(frame, parts_->frame, outside);
  parts_->timing = timing ? timing(parts_->frame) : PictureTiming::InTime;
  parts_->check_medium();
  parts_->take_frame();
  parts_->watch_bone(frame);
}

void Operation::heed_pictures() { parts_->take_seen(); }

void Operation::process_recorded(const pipeline::FrameResult& result) {
  parts_->frame = result;
  parts_->timing = timing_of(result.guidance.state);
  if (result.guidance.is_valid()) parts_->medium.confirmed_by_record();
  parts_->take_frame();
}

void Operation::apply(const Command& command) {
  Parts& p = *parts_;
  p.take_seen();  // what the last picture showed comes before what is done about it
  p.note(JournalKind::CommandGiven, to_text(command));
  std::visit([&](const auto& c) { p.apply(c); }, command);
  if (!p.ledger.touches().has_control_point()) p.guide_check.forget_point();
  p.bone_watch.on_touches(p.ledger.touches());
  p.look_for_end_of_loss();
  p.follow_ledger();
}

void Operation::take_outcome(const OutcomePtr& outcome) {
  Parts& p = *parts_;
  if (outcome == nullptr || outcome == p.outcome) return;
  p.take_seen();  // it was seen of the registration that the outcome may replace
  const OutcomePtr before = std::exchange(p.outcome, outcome);
  p.note(JournalKind::OutcomeTaken, std::to_string(outcome->request_count));
  const bool has_become_ready = outcome->bone_is_ready && (before == nullptr || !before->bone_is_ready);
  // Nothing more may come: what was drawn while the bone was being made ready is judged, nobody asking.
  if (has_become_ready && !p.strokes.points().empty()) p.ask(JudgeAll{});
  if (!outcome->failure.empty()) p.fit.on_failure();
  const auto& online = outcome->online;
  if (online != nullptr && (before == nullptr || before->online != online)) {
    // What was found with strokes that are gone or excluded since, before the registration heard of it, must
    // not take effect any more.
    bool is_of_today = true;
    for (const registration::StrokeInfo& stroke : online->strokes)
      is_of_today = is_of_today && (stroke.is_excluded || p.strokes.uses(stroke.curve));
    if (is_of_today && !p.strokes.points().empty()) {
      p.online = online;
      p.ledger.take_online(online, outcome->request_count);
    }
  }
  if (outcome->fit_number > (before != nullptr ? before->fit_number : 0) &&
      p.fit.has_come(outcome->fit_number))
    p.ledger.take_fit(outcome->fit, p.fit.request(), p.fit.length_mm());
  p.follow_ledger();
}

void Operation::tell_bone_moved(const SeenDrift& drift) {
  parts_->bone_watch.tell(drift);
  parts_->take_seen();
}

void Operation::tell_bone_looks(const SeenLooks& looks) {
  parts_->bone_watch.tell(looks);
  parts_->take_seen();
}

void Operation::tell_medium_wrong(const SeenMedium& medium) {
  parts_->seen_medium = medium;
  parts_->take_seen();
}

void Operation::take_look(const MediumLookPtr& look) { parts_->take_look(look); }
std::optional<MediumLookRequest> Operation::take_look_request() { return parts_->medium.take_request(); }

std::vector<RegistrationRequest> Operation::take_requests() { return std::exchange(parts_->requests, {}); }
std::vector<JournalEntry> Operation::take_journal() { return std::exchange(parts_->journal, {}); }

OperationStatePtr Operation::state() {
  Parts& p = *parts_;
  auto state = p.states.take();  // every field is written
  state->revision = ++p.revision;
  state->bone = p.setup.bone;
  state->has_source = p.has_source;
  state->source = p.source;
  state->frame_count = p.frame_count;
  state->frame = p.frame;
  state->timing = p.timing;
  state->draws = p.draws && !p.holds_for_time_out();
  state->registration = p.registration_state();
  p.changed = false;
  state->verification = p.verification();
  state->time_out = p.time_out();
  state->guided_lately = p.guided_lately();
  state->grades = p.frame.guidance.is_valid() ? p.grades.grades() : GuidanceGrades();
  state->marker_is_out = p.marker_is_out;
  state->resumed = p.resumed;
  state->control_point_due = p.control_point_due();
  state->places_in_doubt = p.places_in_doubt();
  state->touch_refusal = p.touch.refusal;
  state->guide_check = p.guide_check.state();
  state->guide_check.has_point = p.control_point_of_now_mm().has_value();
  state->touch_is_of_guide = p.touch.is_of_guide;
  state->touch_asked_ns = p.touch.time_ns;
  state->plan = p.plan;
  state->plan_was_edited = p.offered.has_value();
  state->edited_plan = p.offered ? p.offered->plan : std::nullopt;
  state->depth_stop_mm = p.drilling.depth_stop_mm();
  state->drilled = p.drilling.state();
  state->medium = p.medium.verdict();
  state->contour = p.bone_watch.verdict();
  state->next_action = next_action_of(*state);
  state->step = step_of(state->next_action);
  return state;
}

const pipeline::FrameResult& Operation::frame() const { return parts_->frame; }
const strokes::Curves& Operation::points() const { return parts_->strokes.points(); }
strokes::Curves Operation::strokes_in_use() const { return parts_->strokes.in_use(); }
const OperationSetup& Operation::setup() const { return parts_->setup; }
const OutcomePtr& Operation::outcome() const { return parts_->outcome; }
const registration::Provenance& Operation::now() const { return parts_->ledger.now(); }

}  // namespace arthronaut::operation
