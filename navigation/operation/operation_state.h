// Everything that is known of an operation at one moment: what screen, record and report read. A snapshot is
// immutable and whole; verdicts are enums and numbers, and whoever shows them makes the words (of
// camera and tools whoever starts the source, who has read their files).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "navigation/contour/contour_verdict.h"
#include "navigation/guidance/drill_evidence.h"
#include "navigation/operation/achieved_tunnel.h"
#include "navigation/operation/command.h"
#include "navigation/operation/guidance_grades.h"
#include "navigation/operation/guide_check.h"
#include "navigation/operation/picture_timing.h"
#include "navigation/operation/registration_ledger.h"
#include "navigation/operation/stroke_book.h"
#include "navigation/pipeline/medium_check.h"
#include "navigation/pipeline/navigation_pipeline.h"

namespace arthronaut::operation {

// Where the pictures come from. A value: to start a source is to hand this over.
struct SourceSetup {
  sources::SourceKind kind = sources::SourceKind::Simulation;
  std::string title;  // "Simulated operation: probe"
  // Camera and tools in words, for the screen: "camera measured 2026-11-21, 4 days old; tools nominal", and
  // with ages in place of dates, as they stand on the time-out's card.
  std::string calibration, calibration_in_short;
  pipeline::PipelineOptions pipeline;
  bool camera_is_simulated = false;  // its calibration is of the simulated arthroscope
  bool draws = true;  // the probe draws from the first frame, unless something reliable guides already
  // Where a time-out is asked, no stroke and no touch is taken before it is confirmed: they would be of a
  // knee that nobody has said is the right one. Records of before there was this took them, and run again as
  // they ran.
  bool time_out_first = true;
};

// What a real scope shows is measured by a calibration of the simulated one: no number of it is right.
[[nodiscard]] inline bool has_camera_of_simulator(const SourceSetup& source) {
  return source.camera_is_simulated && source.kind != sources::SourceKind::Simulation;
}

// What is known of where the bone lies.
struct RegistrationState {
  TracePtr drawn = std::make_shared<const strokes::Curves>();  // for the screen, never null
  std::size_t point_count = 0;                                 // that were drawn
  std::set<int> excluded;                                      // strokes that are not used
  // These very ones were to be registered already: the same again gives the same.
  bool strokes_were_tried = false;
  // Null until the bone is ready and what was drawn by then is judged.
  std::shared_ptr<const registration::OnlineResult> online;
  RegistrationInForce in_force;
  std::uint64_t change_count = 0;  // of in_force.registration
  std::shared_ptr<const std::vector<RegistrationEntry>> history =
      std::make_shared<const std::vector<RegistrationEntry>>();  // never null
  std::optional<std::size_t> entry_in_force;
  bool is_chosen = false;  // by the surgeon: newer ones wait
  TouchAlarm alarm;
  Touches touches;
  bool bone_is_ready = false;
  bool is_fitting = false;   // a registration of all strokes was asked for and is not there yet
  std::string bone_trouble;  // why nothing can be registered to this bone; empty else
  // Strokes that were set aside because the pictures are of something else now.
  std::size_t set_aside_count = 0;

  [[nodiscard]] WayOut way_out() const { return way_out_of(alarm, touches); }
  // An alarm holds that no touch of the control point can take away.
  [[nodiscard]] bool must_be_found_anew() const {
    return way_out() == WayOut::StrokesAnew || way_out() == WayOut::MarkerPlacedAnew;
  }
};
using RegistrationStatePtr = std::shared_ptr<const RegistrationState>;

// Whether a touch on the bone has shown that the registration holds, before it guides.
enum class Verification { NotYet, ByTouches, Skipped };

// Whether patient, side, plan, camera, tools and medium were confirmed. Only a live source asks: in a
// recording and in a simulation nobody is drilled.
enum class TimeOut { NotAsked, Due, Confirmed };

// What the control point is wanted for.
enum class ControlPointDue {
  None,
  Set,
  CheckBeforeDrilling,
  CheckAfterLoss,
  CheckLooks,  // the picture does not show the bone as it did
  // So it is, and no control point was set before: one that is set now learns where the bone lies since.
  // Asked for until as many places were touched as verify; what they say is the surgeon's to judge.
  CannotCheckLooks,
  CheckShift,  // touched again it lay elsewhere: once more tells a bumped marker from a probe that slipped
  // The marker was lost for long, and no control point was set before: asked for likewise.
  CannotCheckLoss,
};

// The nine steps of an operation.
enum class Step { Plan, Calibrate, WorldMarker, Tools, Digitise, Register, Verify, Guide, Finish };
[[nodiscard]] std::string_view to_text(Step step);

// The next sensible thing to do. A pedal carries out what is a command; the rest is told.
enum class NextAction {
  PlanTunnel,
  StartSource,
  ConfirmTimeOut,
  ShowWorldMarker,
  Draw,             // the probe is to draw, and does not
  GoOnDrawing,      // strokes are missing: the coach says which
  RegisterStrokes,  // what was drawn may be enough
  WaitForRegistration,
  CheckWorldMarker,  // an alarm says that it may have moved
  ConfirmByTouch,    // what guides is void until one touch confirms it
  RegisterAnew,      // what guides is void for good
  TakePlanOver,
  VerifyByTouch,
  SetControlPoint,
  CheckControlPoint,
  CheckGuide,  // a nominal guide: its tip on the control point
  BringGuide,
  FollowBullseye,
  RecordDrilled,
  Finish,
};
[[nodiscard]] std::string_view to_text(NextAction action);

// The tunnel as drilled, or why it is not known.
struct DrilledState {
  enum class Outcome { NotSaid, Recorded, NoEvidence } outcome = Outcome::NotSaid;
  bool has_evidence = false;  // the guide was seen where it must be while a tunnel is drilled
  guidance::EvidenceOutcome evidence = guidance::EvidenceOutcome::NoGuidance;  // why it is not known
  std::optional<AchievedTunnel> tunnel;
  bool was_taken_back = false;  // it was said, and then that it was too early; outcome is NotSaid
};

struct OperationState {
  std::uint64_t revision = 0;  // grows with every snapshot
  bones::BoneKind bone = bones::BoneKind::Femur;
  bool has_source = false;
  // Of the source that runs, or ran last; null before the first.
  std::shared_ptr<const SourceSetup> source;
  std::int64_t frame_count = 0;  // of this source
  // The newest picture and everything known about it; meaningful when frame_count > 0.
  pipeline::FrameResult frame;
  PictureTiming timing = PictureTiming::InTime;  // of that picture; what follows from it is in its guidance
  bool draws = false;                            // not while holds_for_time_out()
  RegistrationStatePtr registration = std::make_shared<const RegistrationState>();  // never null
  Verification verification = Verification::NotYet;
  TimeOut time_out = TimeOut::NotAsked;
  bool guided_lately = false;  // it guides, or did so a moment ago: the guide is in the surgeon's hand
  GuidanceGrades grades;       // of the newest picture's numbers, without a flicker
  bool marker_is_out = false;  // by the surgeon's word, as long as no live source shows it
  ControlPointDue control_point_due = ControlPointDue::None;
  int places_in_doubt = 0;  // still to be touched, with CannotCheckLooks and CannotCheckLoss
  // Of the last touch, check of the guide or word that the marker is out.
  TouchRefusal touch_refusal = TouchRefusal::None;
  bool touch_is_of_guide = false;   // a check of it
  std::int64_t touch_asked_ns = 0;  // in the source's time
  GuideCheckState guide_check;
  std::optional<PlannedTunnel> plan;               // in force
  bool plan_was_edited = false;                    // another one is offered and not taken over
  std::optional<PlannedTunnel> edited_plan;        // that one; empty with plan_was_edited: none is planned
  std::optional<double> depth_stop_mm;             // as the surgeon read it last
  std::shared_ptr<const ResumeOperation> resumed;  // what it went on from; null: it began afresh
  pipeline::MediumVerdict medium;                  // whether the pictures fit the medium in force
  // Whether the newest picture shows the registered bone where it lay; of a record without pictures: unknown.
  contour::ContourVerdict contour;
  DrilledState drilled;
  Step step = Step::Plan;
  NextAction next_action = NextAction::PlanTunnel;
};
using OperationStatePtr = std::shared_ptr<const OperationState>;

// Places are asked for, where no control point can tell.
[[nodiscard]] inline bool asks_for_places(ControlPointDue due) {
  return due == ControlPointDue::CannotCheckLooks || due == ControlPointDue::CannotCheckLoss;
}

// Neither strokes nor touches are taken: the time-out comes first.
[[nodiscard]] inline bool holds_for_time_out(const OperationState& state) {
  return state.has_source && state.time_out == TimeOut::Due && state.source != nullptr &&
         state.source->time_out_first;
}

// Which step an operation has come to, and what is to be done next; pure, from the rest of the state.
[[nodiscard]] NextAction next_action_of(const OperationState& state);
[[nodiscard]] Step step_of(NextAction action);

// What the seventh step still lacks: touches that verify what guides (skipped ones are not there), the
// control point, set or touched again, or the check of a nominal guide. Of a tunnel that is recorded the
// touches alone count still.
enum class Unverified { Nothing, Touches, ControlPoint, GuideCheck };
[[nodiscard]] Unverified unverified_of(const OperationState& state);

// Numbers over everything in the state but `contour` and `timing` (what follows from them is in): two runs
// with the same numbers did the same. The first to the last bit of every pose and covariance of the frame;
// the second of everything else: registration, touches, alarms, plan, steps. 64-bit FNV-1a over the binary
// values.
[[nodiscard]] std::uint64_t digest_of_frame(const OperationState& state);
[[nodiscard]] std::uint64_t digest_of_decisions(const OperationState& state);

}  // namespace arthronaut::operation
