// What a session says of itself in a report: where its pictures came from, and what stood against a mistake.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "navigation/operation/achieved_tunnel.h"
#include "navigation/operation/command.h"
#include "navigation/recording/session.h"
#include "navigation/recording/told_events.h"

namespace arthronaut::report {

// The name of a recording's file is often the patient's: only of what kind it is. A camera, a stream and a
// simulation are called what they are.
[[nodiscard]] std::string neutral_source(const recording::SessionHeader& header);
// "live: a camera, as it came"; "not recorded".
[[nodiscard]] std::string kind_in_words(const recording::SessionHeader& header);
// "femur"; where it was recorded as of the other side than the case has now, that too.
[[nodiscard]] std::string bone_in_words(const recording::SessionHeader& header, bones::Side of_case);
// Which tunnels of bundles the session guided to, in the order of time: "femur AM, femur PL"; empty where a
// bone's single one was.
[[nodiscard]] std::string guided_bundles(const recording::RecordedSession& session);
// What a tunnel was drilled by; where none was, the newest registration: at its end the world marker is taken
// out, and nothing is registered any more. Throws IoError or InvalidInput where its file cannot be read.
[[nodiscard]] std::optional<registration::RegistrationSummary> registration_that_counts(
    const recording::RecordedSession& session);
// A registration of it by its event.
[[nodiscard]] recording::ReadRegistration registrations_of(const recording::RecordedSession& session);
// What was asked before the guide was followed, and what spoke against it, as the session's events say it.
struct Safety {
  enum class Verification { None, Skipped, OfAnEarlierRegistration, DidNotHold, ByTouches };
  enum class TimeOut { NotRecorded, NotAsked, NotConfirmed, Confirmed };
  std::string cut_short = {};  // why the record is not whole; empty: it is. Names files, and whom they name
  bool is_partial = false;     // what was done is not known to its end: what is not told may have been
  Verification verification = Verification::None;
  std::string skipped = {};  // how guidance began without a verification; empty: it did not
  TimeOut time_out = TimeOut::NotRecorded;
  std::optional<operation::PlannedTunnel> confirmed = {};  // of which plan; nullopt: of none that is known
  bool another_plan_followed = false;                      // which was never confirmed
  std::string beside = {};                        // what was wrong with the picture then; empty: nothing
  std::string guide = {};                         // how a nominal guide was found; empty: nobody checked
  std::optional<std::string> source_faults = {};  // in_words(); nullopt: of no live source
  // Alarms and void registrations in the order of the first of their kind, and how many were alike: an alarm
  // comes and goes many times.
  std::vector<std::pair<std::string, int>> alarms = {};
};
[[nodiscard]] Safety safety_of(const recording::RecordedSession& session, bool is_being_recorded);
// A name and a text each.
[[nodiscard]] std::vector<std::vector<std::string>> rows_of(const Safety& safety);
[[nodiscard]] std::string verification_in_words(const Safety& safety);
[[nodiscard]] std::string alarms_in_words(const Safety& safety);

// How much of a session was seen.
struct SessionFigures {
  std::size_t frames = 0;
  double length_s = 0;                         // from the first to the last
  double world_percent = 0, mark_percent = 0;  // of the frames: world marker tracked, lens mark found
  double other_medium_percent = 0;             // of them: nothing stood, since the medium was contradicted
  double without_picture_s = 0;                // of a live source: for so long none came
};
[[nodiscard]] SessionFigures figures_of(const recording::RecordedSession& session);
// "2094 in 1:10.0; NO PICTURE for 26.4 s"
[[nodiscard]] std::string frames_in_words(const SessionFigures& figures);

// Seconds from the first frame; 0 for what was before it.
[[nodiscard]] double time_s(const recording::RecordedSession& session, std::int64_t timestamp_ns);
// When the last pose of a tunnel was seen that was drilled in this session, and when it was said to be: what
// was seen is not of all the time between them. ", the last at 0:54.2; said to be drilled at 1:23.0, after
// the pictures had ended".
[[nodiscard]] std::string seen_and_said(const recording::RecordedSession& session,
                                        const operation::AchievedTunnel& achieved);

// A step of the operation on its time line: registered, verified, confirmed, drilled; and what stood against
// one, in capitals: an alarm, a registration that is void, another plan, pictures that did not come or showed
// nothing.
struct Step {
  double time_s = 0;
  std::string words;  // of several alike that follow each other the first, and how many more until when
};
[[nodiscard]] std::vector<Step> steps_of(const recording::RecordedSession& session);

}  // namespace arthronaut::report
