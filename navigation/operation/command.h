// Everything that a person or a script can ask of an operation, as values: the journal is their list, with
// the frame after which each was given.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "navigation/registration/provenance.h"
#include "navigation/registration/registration.h"
#include "navigation/strokes/curves.h"
#include "planning/tunnels/tunnel.h"

namespace arthronaut::operation {

// A planned tunnel and how long it is inside the bone, along the plan.
struct PlannedTunnel {
  tunnels::Tunnel tunnel;
  double length_mm = 0;
  [[nodiscard]] bool operator==(const PlannedTunnel& other) const;  // in every number
};

// The probe's tip draws on the bone from now on, or no more.
struct Draw {
  bool on = true;
};
// The place where the tip rests is a touch that verifies, or confirms what is void; the probe stops drawing:
// a touch must not be used in the fit.
struct TakeTouch {};
// The same for the control point: the first time it is kept, later it tells whether the marker has moved.
struct TouchControlPoint {};
struct ForgetTouches {};
struct TakeBackStroke {};
struct ExcludeStroke {
  int curve = 0;
  bool is_excluded = true;
};
// Forgets strokes and touches. While an alarm says that the marker has moved, what was registered goes too.
struct ClearStrokes {};
// A registration of all strokes in use, from nothing.
struct RegisterStrokes {};
// An entry of the history takes effect, and stays until the newest is chosen again.
struct ChooseRegistration {
  std::size_t entry = 0;
};
// The plan was edited. Guidance keeps the one in force until it is taken over.
struct OfferPlan {
  std::optional<PlannedTunnel> plan;
  // Once in force, it is where the registration is judged from its next solution on. Records of before there
  // was this keep the target of the first plan: they run again as they ran.
  bool moves_target = true;
};
struct TakePlanOver {
  // With a live source the time-out is due again: what it was confirmed of was another plan. Records of
  // before there was this took the word for a confirmation of its own: they run again as they ran.
  bool asks_time_out = true;
};
// The surgeon goes on without a touch that verifies; that is recorded.
struct SkipVerification {};
// The world marker sits elsewhere now: nothing that was found before holds.
struct MarkerPlacedAnew {};
// What the surgeon reads off the drill's depth stop.
struct ReadDepthStop {
  double depth_mm = 0;
};
// The tunnel is drilled: the surgeon's word. What was seen of the guide or the drill is the evidence.
struct TunnelDrilled {
  // So long no picture of the live source had come when it was said, or none but plain and frozen ones; 0:
  // they came. What was seen before that is no evidence then: nobody saw what was drilled since.
  double without_picture_s = 0;
};
// It is not drilled after all: said too early. What was recorded of it is taken back, and that is recorded.
struct TakeBackDrilled {};
// The world marker is out of the bone, at the end: nothing that was found by it holds. Not believed while a
// live source still shows it.
struct MarkerOut {
  double without_picture_s = 0;  // as in TunnelDrilled: what the last picture showed is so long ago
};
// A registration from a file, or from before a crash.
struct GiveRegistration {
  registration::RegistrationSummary registration;
  registration::Provenance of;
  bool is_resumed = false;  // from before a crash: void until one touch confirms it
};
// Patient, side, plan, camera, tools and medium were read out and are right: the time-out before the first
// guidance with a live source.
struct ConfirmTimeOut {
  bool patient_was_shown = false;  // who it is stays out of the record; that it was on the screen does not
  // What was wrong with the picture beside it: "no picture", "plain picture", "frozen picture", "torn
  // picture"; empty: it was of then.
  std::string beside = {};
};
// The guide's tip rests on the control point: a nominal guide guides live only when it is found there.
struct CheckGuide {};
// A nominal guide guides unchecked: said by whoever starts a live operation where nobody can hold a guide
// against anything. That is recorded; the window has no such way.
struct TrustGuide {};
// What an operation had come to that a crash or a closed window cut off, for another one to go on with it.
// All of it is here: nothing else is read to run it again. Takes effect once, before the first source.
struct ResumeOperation {
  std::string session;                // id of its newest record
  registration::Provenance of;        // what the pictures were of at its end
  std::optional<PlannedTunnel> plan;  // in force then
  bool moves_target = true;           // as that of OfferPlan
  std::optional<double> depth_stop_mm;
  // Void until one touch confirms it: nobody saw the marker meanwhile. Empty: nothing guided, or what did may
  // not be brought back.
  std::optional<registration::RegistrationSummary> registration;
  registration::Provenance registration_of;
  // History: they are shown, and say nothing of the marker as it sits now. World-marker frame.
  strokes::Curves drawn;  // thinned
  int stroke_count = 0;
  std::vector<Eigen::Vector3d> touches_mm;
  std::optional<Eigen::Vector3d> control_point_mm;  // as it was touched first: touched again it still tells
};

using Command =
    std::variant<Draw, TakeTouch, TouchControlPoint, ForgetTouches, TakeBackStroke, ExcludeStroke,
                 ClearStrokes, RegisterStrokes, ChooseRegistration, OfferPlan, TakePlanOver, SkipVerification,
                 MarkerPlacedAnew, ReadDepthStop, TunnelDrilled, GiveRegistration, ConfirmTimeOut, CheckGuide,
                 TrustGuide, ResumeOperation, TakeBackDrilled, MarkerOut>;

// "exclude stroke", ...: what the journal calls it.
[[nodiscard]] std::string_view name_of(const Command& command);
// One line of JSON, every number to its last bit.
[[nodiscard]] std::string to_text(const Command& command);
// Throws InvalidInput for what is not such a line; `name` says where it stands.
[[nodiscard]] Command command_from_text(const std::string& text, const std::string& name);

}  // namespace arthronaut::operation
