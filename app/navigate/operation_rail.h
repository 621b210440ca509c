// The nine steps of an operation on one bone as a rail: which is done, which is now, which is open and which
// waits for what. Pure: state in, enums out; operation_rail.cpp's words_of() makes the words.
//
// Conditions open a step: a registration needs strokes, guidance a registration that stands. Nothing blocks
// the way back: a step that was done once can be looked at and done again at any time.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "navigation/operation/operation_state.h"
#include "planning/tunnels/plan_checks.h"

namespace arthronaut::navigate {

inline constexpr std::size_t kStepCount = 9;

enum class StepState {
  Closed,  // something that it needs is missing
  Open,    // can be done, and is not
  Now,     // is to be done now
  Done,
};

// What a step waits for; the first thing where there are several.
enum class Missing {
  Nothing,
  Plan,
  TunnelChoice,   // of two tunnels in the bone
  PlanTakenOver,  // it was edited
  Camera,         // no calibration
  CameraOfScope,  // it is of the simulated arthroscope, and the pictures are not
  LensUnchanged,  // the zoom was changed since, or the coupler slipped
  Source,
  MarkerInView,
  MarkerInPlace,  // it may have moved, or was taken out
  ProbeTip,
  GuideAxis,
  RealTools,  // one was calibrated with the simulated arthroscope
  Strokes,
  Registration,  // none that stands
  TimeOut,
  Touches,       // that verify
  ControlPoint,  // to be set, or touched again
  GuideCheck,    // of a nominal guide
  Tunnel,        // drilled
  Evidence,      // of it: it is drilled by word alone
  MarkerOut,
  OtherBone,  // its tunnel, or its marker's end
};

struct RailStep {
  operation::Step step = operation::Step::Plan;
  StepState state = StepState::Closed;
  Missing missing = Missing::Nothing;  // of Now and Closed: what it waits for
  // Of what is done: that there is a plan is no tick for a plan that fails its own checks, nor that there are
  // tools for tools that nobody measured. Fine, Look, Wrong.
  tunnels::PlanCheck::Verdict verdict = tunnels::PlanCheck::Verdict::Fine;
};
using Rail = std::array<RailStep, kStepCount>;

// What is known beside the operation.
struct RailContext {
  bool is_planned = false;   // a tunnel of this bone, and nobody has to choose one
  bool must_choose = false;  // of two
  tunnels::PlanCheck::Verdict plan_verdict = tunnels::PlanCheck::Verdict::Fine;  // JudgedPlan's worst
  bool has_camera = false;  // for the pictures that come next; the one in use counts once a source ran
  bool simulates = false;   // those pictures
  bool camera_is_simulated = false;
  const tools::ToolSet* tools = nullptr;  // likewise; null: none that can be read
  bool is_drilled = false;                // said since the case was opened, of the plan in force
  bool was_measured = false;              // and the drill or the guide was seen at it, not only said
  bool was_verified = false;              // likewise: touches had verified what guided to it
  bool marker_is_out = false;             // likewise
  bool other_bone_is_left = false;        // it is planned, and not drilled or its marker not out
};

[[nodiscard]] Rail rail_of(const operation::OperationState& state, const RailContext& context);
// The step to be done now: the rail's one.
[[nodiscard]] operation::Step step_of_now(const Rail& rail);
// The step before another, for the way back; the step of now follows on the first one.
[[nodiscard]] std::optional<operation::Step> step_before(operation::Step step);

// "Digitise".
[[nodiscard]] std::string name_of(operation::Step step);
// Short enough to stand under its number: "Draw".
[[nodiscard]] std::string short_name_of(operation::Step step);
// "no calibrated camera"; empty for Nothing.
[[nodiscard]] std::string words_of(Missing missing);

// What the pedal does when the surgeon has gone back to a step that is not the one of now.
enum class Repeat {
  ShowPlan,       // in its own screen
  ShowSetUp,      // likewise
  TouchControl,   // tells whether the marker sits where it sat
  Draw,           // more strokes
  RegisterAnew,   // all strokes
  Touch,          // one more that verifies
  ShowGuide,      // bullseye and numbers
  OtherPictures,  // those so far have ended, and the tunnel is not drilled
  NotDrilled,     // it was said to be drilled, too early: takes that back
  ShowFinish,     // the check list
  NothingNow,     // what it needs is not there
};
// is_said_drilled: of the plan in force, maybe while another source ran.
[[nodiscard]] Repeat repeat_of(operation::Step step, const operation::OperationState& state,
                               bool is_said_drilled);
// "draw more strokes on the bone": what that is, said as what comes next.
[[nodiscard]] std::string words_of(Repeat repeat, operation::Step step);

}  // namespace arthronaut::navigate
