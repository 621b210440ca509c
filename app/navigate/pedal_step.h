// What the pedal of the next step stands for on the theatre screen. One step is decided here; what is said of
// it, whether a press does it and whether it has to be read before are read off that step. Pure.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/navigate/finish_words.h"
#include "app/navigate/operation_rail.h"
#include "navigation/theatre/live_operation.h"

namespace arthronaut::navigate {

// A value: two that are equal ask the same of the surgeon, whatever flickers in the words beside them.
struct PedalStep {
  // In the order in which they are looked for: the first one that holds is the step.
  enum class Kind {
    OpenCase,
    OpenPictures,   // that are chosen among cameras and streams
    TypeAddress,    // of a stream
    WaitForSearch,  // for an operation that was left
    Resume,
    Exercise,  // asks for what it wants; the pedal does nothing
    WaitForEnd,
    GoBackTo,  // a step that is done again
    ChooseTunnel,
    Finish,
    WaitForPicture,   // the first one
    ChangeMedium,     // the pictures contradict it: they end, and the next ones look through the other one
    WaitForPictures,  // that show something
    PlanTunnel,
    TakePlanOver,
    TakeGuide,  // in the simulation
    FindAnew,   // after an alarm that no touch can take away
    SetUp,
    Start,
    Act,  // what the operation asks for
  };
  Kind kind = Kind::OpenCase;
  bones::BoneKind bone = bones::BoneKind::Femur;
  operation::NextAction action = operation::NextAction::PlanTunnel;  // of Act and WaitForPictures
  operation::Step step = operation::Step::Plan;                      // of GoBackTo
  Repeat repeat = Repeat::NothingNow;                                // likewise
  bool is_shown = false;  // likewise: what it would show is on the screen
  FinishAction finish = FinishAction::Nothing;
  std::string medium;                            // of ChangeMedium, to take; empty: none can be taken
  std::optional<tunnels::TunnelKey> tunnel;      // to choose
  std::optional<operation::PlannedTunnel> plan;  // to take over, or that Act is done by
  tunnels::PlanCheck::Verdict plan_verdict = tunnels::PlanCheck::Verdict::Fine;  // of one to take over
  [[nodiscard]] bool operator==(const PedalStep&) const = default;
};

// What is known beside the operation.
struct PedalContext {
  bool has_case = false;
  bones::BoneKind bone = bones::BoneKind::Femur;  // that is navigated
  bool chooses_pictures = false;
  std::string pictures;  // those that are chosen; empty: an address is typed
  bool pictures_do_not_answer = false;
  bool searches = false, was_left = false;
  std::string exercise;  // what it asks for; empty: there is none, or it asks for nothing
  bool goes_to_other_bone = false;
  std::optional<operation::Step> looked_at;
  Repeat repeat = Repeat::NothingNow;  // of that
  std::vector<FinishedBone> bones;     // `bone` first
  std::optional<tunnels::TunnelKey> offered, guided;
  bool must_choose = false;
  tunnels::PlanCheck::Verdict edited_verdict = tunnels::PlanCheck::Verdict::Fine;
  bool stops_once_open = false;
  bool can_take_guide = false;     // the simulation of the probe runs, and that of the guide can
  std::optional<bool> hand_rests;  // the simulated one, where it holds the probe
  bool may_change_medium = false;  // its pictures can be begun again in another one
  bool must_set_up = false;
  std::string start;  // how pictures are begun: "open the camera again"
};

[[nodiscard]] PedalStep pedal_step(const theatre::LiveState& live, const PedalContext& context);
// `step` as pedal_step() gave it, of the same.
[[nodiscard]] std::string words_of(const PedalStep& step, const theatre::LiveState& live,
                                   const PedalContext& context);
// A press does something, once what must be read was there for long enough.
[[nodiscard]] bool acts(const PedalStep& step);
// What is confirmed, recorded or said to be out stands in the record for good. It has to have been asked on
// the screen for long enough to be read: a second press of a foot that slipped, and one that was meant for
// what stood there before, say nothing.
[[nodiscard]] bool must_be_read(const PedalStep& step);

// All tunnels of the bone that is navigated are drilled.
[[nodiscard]] bool finishes(const std::vector<FinishedBone>& bones, bones::BoneKind bone);
// Another plan than the one in force is offered to an operation that runs, and nothing stands before it.
[[nodiscard]] bool waits_for_take_over(const operation::OperationState& state);

}  // namespace arthronaut::navigate
