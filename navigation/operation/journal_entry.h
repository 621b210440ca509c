// The journal of an operation: every command, every outcome of the registration that was taken in, and what
// came of them, each with the frame after which it happened. Commands, outcomes and frames are all that a
// second run needs; the rest is for whoever reads it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "navigation/operation/achieved_tunnel.h"
#include "navigation/operation/command.h"
#include "navigation/operation/registration_work.h"

namespace arthronaut::operation {

enum class JournalKind {
  CommandGiven,   // text: to_text(Command)
  OutcomeTaken,   // text: its request count
  LookTaken,      // text: index of the frame whose picture was seen in the other medium
  LookFailed,     // text: the same, then ": " and why
  BoneMoved,      // in the picture, against its marker; text: see seen_drift.h
  BoneLooks,      // in the picture; text: see seen_drift.h. A doubt ends without it, too: by the control
                  // point, and with its registration
  MediumWrong,    // what was measured since is gone; text: see seen_drift.h
  SourceStarted,  // what stands before the first of these was given before any source
  SourceEnded,
  RegistrationInForce,  // registration is set; without a pose: none is in force any more
  Alarm,                // text: what it says, empty when it is over
  Void,                 // text: why
  Confirmed,            // by a touch
  Verified,
  VerificationLost,  // of the one in force; text: why
  VerificationSkipped,
  TimeOutConfirmed,  // text: what was on the screen
  GuideChecked,      // text: how far its tip was off, or that nobody checked it
  Plan,              // in force from now on: plan, or none
  Drilled,           // achieved is set
  DrilledByWord,     // without poses; text: "femur AM: " and why
  DrilledTakenBack,  // the one of before; achieved is set
  SaidTooEarly,      // of one that was drilled by word alone, or under another source; text: "femur AM"
  MarkerOut,         // the world marker is out of the bone; text: empty, or why it is not after all
  Note,
};

struct JournalEntry {
  std::int64_t after_frame = -1;  // index of the last frame before it; -1: none of this source yet
  // Of that frame: the operation has no clock, and whoever has one may date it.
  std::int64_t timestamp_ns = 0;
  JournalKind kind = JournalKind::Note;
  std::string text;
  RegistrationPtr registration;  // with RegistrationInForce
  registration::Provenance of;
  bool registration_was_given = false;
  std::optional<PlannedTunnel> plan;  // with Plan
  std::optional<AchievedTunnel> achieved;
};
[[nodiscard]] inline JournalEntry entry_of(JournalKind kind, std::string text = "") {
  JournalEntry entry;
  entry.kind = kind;
  entry.text = std::move(text);
  return entry;
}

}  // namespace arthronaut::operation
