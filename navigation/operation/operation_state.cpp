#include "navigation/operation/operation_state.h"

#include <span>

namespace arthronaut::operation {

namespace {

// So many points are a few strokes: worth asking whether they are enough.
constexpr std::size_t kEnoughPoints = 150;

// 64-bit FNV-1a.
class Digest {
 public:
  template <typename Value>
  void add(const Value& value) {
    static_assert(std::is_arithmetic_v<Value> || std::is_enum_v<Value>, "no padding may be hashed");
    for (const std::byte byte : std::as_bytes(std::span(&value, 1))) {
      hash_ ^= static_cast<std::uint64_t>(byte);
      hash_ *= 0x100000001B3U;
    }
  }
  template <typename Derived>
  void add_matrix(const Eigen::MatrixBase<Derived>& matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i)
      add(static_cast<double>(matrix.derived().coeff(i / matrix.cols(), i % matrix.cols())));
  }
  void add(const geometry::RigidTransform& transform) {
    add_matrix(transform.rotation.coeffs());
    add_matrix(transform.translation_mm);
  }
  void add(const geometry::TrackedPose& pose) {
    add(pose.is_valid);
    if (!pose.is_valid) return;
    add(pose.target_from_source);
    add_matrix(pose.covariance);
  }
  void add(const tunnels::Tunnel& tunnel) {
    add_matrix(tunnel.entry_mm);
    add_matrix(tunnel.direction);
    add(tunnel.diameter_mm);
    // Of the tunnel of the whole ligament nothing: records of before there were others stay as they were.
    if (tunnel.bundle != norms::Bundle::Whole) add(tunnel.bundle);
  }
  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xCBF29CE484222325U;
};

// Where none is seen nothing: records of before there was this stay as they were.
void add_drill(Digest& digest, const std::optional<guidance::DrillDepth>& drill) {
  if (!drill) return;
  digest.add_matrix(drill->tip_mm);
  digest.add_matrix(drill->direction);
  for (const double number :
       {drill->depth_mm, drill->remaining_mm, drill->to_exit_mm, drill->lateral_mm, drill->exit_lateral_mm,
        drill->sigma_mm, drill->sigma_offset_mm, drill->sigma_angle_deg})
    digest.add(number);
}

void add_guidance(Digest& digest, const guidance::GuidanceNumbers& g) {
  digest.add(g.state);
  add_drill(digest, g.drill);
  if (!g.is_valid()) return;
  digest.add_matrix(g.guide_point_mm);
  digest.add_matrix(g.guide_direction);
  for (const double number :
       {g.tip_to_entry_mm, g.axis_to_entry_mm, g.angle_deg, g.offset_mm, g.offset_anterior_mm,
        g.offset_proximal_mm, g.offset_lateral_mm, g.depth_mm, g.sigma_offset_mm, g.sigma_angle_deg})
    digest.add(number);
  digest.add(g.drill.has_value());
}

void add_frame(Digest& digest, const pipeline::FrameResult& frame) {
  digest.add(frame.frame_index);
  digest.add(frame.timestamp_ns);
  digest.add(frame.intrinsics_are_known);
  digest.add(frame.is_frozen);
  for (const markers::MarkerObservation& marker : frame.markers) digest.add(marker.state);
  digest.add(frame.camera_from_world);
  // Of operations without an outside tracker nothing: their records stay as they were.
  for (const tracker::BodyPose& body : frame.outside.bodies) digest.add(body.state);
  if (!frame.outside.bodies.empty()) digest.add(frame.tracker_from_world);
  for (const pipeline::ToolPose& tool : frame.tools) digest.add(tool.world_from_tool);
  digest.add(frame.tip_is_valid);
  if (frame.tip_is_valid) digest.add_matrix(frame.tip_in_world_mm);
  add_guidance(digest, frame.guidance);
}

void add_registration(Digest& digest, const RegistrationState& state) {
  digest.add(state.point_count);
  digest.add(state.excluded.size());
  digest.add(state.in_force.standing);
  digest.add(state.in_force.is_verified);
  digest.add(state.change_count);
  digest.add(state.history->size());
  if (const auto& r = state.in_force.registration; r != nullptr && r->has_pose) {
    digest.add(r->marker_from_bone);
    digest.add_matrix(r->covariance);
    digest.add(r->reliable);
    digest.add(r->predicted_tre_mm);
  }
  digest.add(state.alarm.kind);
  digest.add(state.is_chosen);
  digest.add(state.entry_in_force.has_value());
  if (state.entry_in_force) digest.add(*state.entry_in_force);
  digest.add(state.set_aside_count);
  digest.add(state.bone_trouble.empty());
  digest.add(state.touches.count());
  for (const auto& residual_mm : state.touches.residuals_mm()) digest.add(residual_mm.value_or(-1));
  if (state.online != nullptr) {
    digest.add(state.online->revision);
    digest.add(state.online->state);
    digest.add(state.online->length_mm);
  }
}

// What was drawn was registered, and that is not reliable, or was too short for it.
bool was_refused(const RegistrationState& registration) {
  const Standing standing = registration.in_force.standing;
  return registration.strokes_were_tried && (standing == Standing::NotReliable || standing == Standing::None);
}

// Strokes that are worth asking whether they are enough.
bool may_be_enough(const RegistrationState& registration) {
  return registration.point_count >= kEnoughPoints && !was_refused(registration);
}

NextAction action_without_registration(const OperationState& state) {
  const RegistrationState& registration = *state.registration;
  if (registration.is_fitting) return NextAction::WaitForRegistration;
  if (state.frame_count > 0 && !state.frame.world_is_seen()) return NextAction::ShowWorldMarker;
  if (state.draws) return NextAction::GoOnDrawing;
  if (registration.in_force.standing == Standing::Void) return NextAction::RegisterAnew;
  return may_be_enough(registration) ? NextAction::RegisterStrokes : NextAction::Draw;
}

// Enough places were touched, and they lie off the bone: no further touch can verify, another registration
// may.
NextAction action_of_denied(const OperationState& state) {
  if (state.registration->is_fitting) return NextAction::WaitForRegistration;
  if (!state.draws) return NextAction::RegisterAnew;
  return state.registration->point_count > 0 ? NextAction::RegisterStrokes : NextAction::GoOnDrawing;
}

}  // namespace

std::string_view to_text(Step step) {
  constexpr std::string_view kNames[] = {"plan",     "calibrate", "world marker", "tools", "digitise",
                                         "register", "verify",    "guide",        "finish"};
  return kNames[static_cast<std::size_t>(step)];
}

std::string_view to_text(NextAction action) {
  constexpr std::string_view kNames[] = {"plan tunnel",
                                         "start source",
                                         "confirm time-out",
                                         "show world marker",
                                         "draw",
                                         "go on drawing",
                                         "register strokes",
                                         "wait for registration",
                                         "check world marker",
                                         "confirm by touch",
                                         "register anew",
                                         "take plan over",
                                         "verify by touch",
                                         "set control point",
                                         "check control point",
                                         "check guide",
                                         "bring guide",
                                         "follow bullseye",
                                         "record drilled",
                                         "finish"};
  return kNames[static_cast<std::size_t>(action)];
}

NextAction next_action_of(const OperationState& state) {
  const RegistrationState& registration = *state.registration;
  const RegistrationInForce& in_force = registration.in_force;
  if (!state.plan) return NextAction::PlanTunnel;
  // What ends an alarm is a touch, which is not taken before.
  if (registration.alarm && holds_for_time_out(state)) return NextAction::ConfirmTimeOut;
  if (registration.alarm) return NextAction::CheckWorldMarker;
  const bool is_drilled = state.drilled.outcome == DrilledState::Outcome::Recorded;
  if (is_drilled && !state.plan_was_edited) return NextAction::Finish;
  if (!state.has_source) {
    const bool may_register = in_force.standing != Standing::Stands && may_be_enough(registration);
    if (registration.is_fitting) return NextAction::WaitForRegistration;
    // A recording shows once what was drilled in it, and so does the simulator's script: what follows it
    // drills the same tunnel again. Of a live source that ended nobody knows what comes.
    const bool was_live = state.source == nullptr || state.source->kind == sources::SourceKind::Live;
    if (!was_live && in_force.standing == Standing::Stands && state.drilled.has_evidence)
      return NextAction::RecordDrilled;
    return may_register ? NextAction::RegisterStrokes : NextAction::StartSource;
  }
  if (state.time_out == TimeOut::Due) return NextAction::ConfirmTimeOut;
  if (state.plan_was_edited) return NextAction::TakePlanOver;
  if (in_force.standing == Standing::Void && in_force.can_be_confirmed && !state.draws)
    return NextAction::ConfirmByTouch;
  if (in_force.standing != Standing::Stands) return action_without_registration(state);
  // Until that is answered no touch and no number says anything.
  if (state.control_point_due == ControlPointDue::CheckShift) return NextAction::CheckControlPoint;
  // What is to be done does not change with a picture in which the guide is not seen.
  const bool guides = state.guided_lately;
  if (state.verification == Verification::NotYet && !guides) {
    if (registration.touches.places_to_verify() > 0) return NextAction::VerifyByTouch;
    return action_of_denied(state);
  }
  if (asks_for_places(state.control_point_due)) return NextAction::VerifyByTouch;
  // Not asked of a hand that drills or has drilled: a control point that is set then tells nothing of before.
  if (state.control_point_due == ControlPointDue::Set && !guides && !state.drilled.has_evidence)
    return NextAction::SetControlPoint;
  if (state.control_point_due > ControlPointDue::Set) return NextAction::CheckControlPoint;
  if (!state.guide_check.may_guide())
    return state.guide_check.has_point                ? NextAction::CheckGuide
           : registration.touches.has_control_point() ? NextAction::CheckControlPoint
                                                      : NextAction::SetControlPoint;
  if (state.drilled.has_evidence) return NextAction::RecordDrilled;
  // A bone that is lost guides nobody, however short. What comes too late shows a guide that is in the hand.
  const auto& guidance = state.frame.guidance;
  const bool only_the_guide_is_away = guidance.state == guidance::GuidanceState::GuideLost;
  return guidance.is_valid() || guidance.is_too_late() || (guides && only_the_guide_is_away)
             ? NextAction::FollowBullseye
             : NextAction::BringGuide;
}

Step step_of(NextAction action) {
  switch (action) {
    case NextAction::PlanTunnel:
    case NextAction::TakePlanOver:
      return Step::Plan;
    case NextAction::StartSource:
    case NextAction::ConfirmTimeOut:
    case NextAction::ShowWorldMarker:
      return Step::WorldMarker;
    case NextAction::Draw:
    case NextAction::GoOnDrawing:
      return Step::Digitise;
    case NextAction::RegisterStrokes:
    case NextAction::WaitForRegistration:
    case NextAction::RegisterAnew:
      return Step::Register;
    case NextAction::CheckWorldMarker:
    case NextAction::ConfirmByTouch:
    case NextAction::VerifyByTouch:
    case NextAction::SetControlPoint:
    case NextAction::CheckControlPoint:
    case NextAction::CheckGuide:
      return Step::Verify;
    case NextAction::BringGuide:
    case NextAction::FollowBullseye:
      return Step::Guide;
    case NextAction::RecordDrilled:
    case NextAction::Finish:
      return Step::Finish;
  }
  return Step::Plan;
}

Unverified unverified_of(const OperationState& state) {
  const bool is_verified = state.verification == Verification::ByTouches;
  if (state.drilled.outcome == DrilledState::Outcome::Recorded)
    return is_verified ? Unverified::Nothing : Unverified::Touches;
  if (state.verification == Verification::NotYet) return Unverified::Touches;
  if (state.control_point_due != ControlPointDue::None) return Unverified::ControlPoint;
  if (!state.guide_check.may_guide()) return Unverified::GuideCheck;
  return is_verified ? Unverified::Nothing : Unverified::Touches;
}

std::uint64_t digest_of_frame(const OperationState& state) {
  Digest digest;
  if (state.frame_count > 0) add_frame(digest, state.frame);
  // Not what the picture says of the bone: that rests on all pictures since the registration, and a record
  // need not keep them. What followed from it is in the decisions.
  return digest.value();
}

std::uint64_t digest_of_decisions(const OperationState& state) {
  Digest digest;
  add_registration(digest, *state.registration);
  digest.add(state.draws);
  digest.add(state.verification);
  digest.add(state.time_out);
  digest.add(state.resumed != nullptr);
  digest.add(state.depth_stop_mm.value_or(-1));
  digest.add(state.control_point_due);
  digest.add(state.touch_refusal);
  digest.add(state.guide_check.standing);
  digest.add(state.guide_check.error_mm);
  digest.add(state.touch_is_of_guide);
  digest.add(state.plan.has_value());
  if (state.plan) {
    digest.add(state.plan->tunnel);
    digest.add(state.plan->length_mm);
  }
  digest.add(state.plan_was_edited);
  digest.add(state.drilled.outcome);
  digest.add(state.drilled.tunnel.has_value());
  if (state.drilled.tunnel) {
    digest.add(state.drilled.tunnel->measured);
    digest.add(state.drilled.tunnel->depth_mm.value_or(-1));
  }
  // Where nothing was, nothing: records of before there was this stay as they were.
  if (state.drilled.was_taken_back) digest.add(state.drilled.was_taken_back);
  if (state.marker_is_out) digest.add(state.marker_is_out);
  if (state.grades.offset != Grade::None) {
    digest.add(state.grades.offset);
    digest.add(state.grades.angle);
  }
  digest.add(state.next_action);
  return digest.value();
}

}  // namespace arthronaut::operation
