#include "app/report/session_rows.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "app/report/plans_in_force.h"
#include "app/report/source_faults.h"
#include "navigation/operation/command.h"
#include "navigation/recording/counting_registration.h"
#include "navigation/recording/cut_short.h"
#include "navigation/sources/frame_source.h"
#include "planning/files/format.h"
#include "planning/geometry/error.h"

namespace arthronaut::report {

std::string neutral_source(const recording::SessionHeader& header) {
  constexpr std::size_t kLongestExtension = 5;  // with its dot; what is longer may be a name
  if (header.source_kind && *header.source_kind != sources::SourceKind::Recording) return header.source;
  const std::string extension = std::filesystem::path(header.source).extension().string();
  const bool is_type = extension.size() > 1 && extension.size() <= kLongestExtension &&
                       std::all_of(extension.begin() + 1, extension.end(),
                                   [](unsigned char c) { return std::isalnum(c) != 0; });
  return is_type ? "recording (" + extension.substr(1) + ")" : "recording";
}

std::string bone_in_words(const recording::SessionHeader& header, bones::Side of_case) {
  std::string words(bones::to_text(header.bone));
  if (header.side != of_case)
    words += ", recorded as of a " + std::string(bones::to_text(header.side)) + " knee: THE CASE IS A " +
             (of_case == bones::Side::Left ? "LEFT" : "RIGHT") + " ONE NOW";
  return words;
}

std::string kind_in_words(const recording::SessionHeader& header) {
  const auto kind = header.source_kind;
  if (!kind) return "not recorded";
  return *kind == sources::SourceKind::Live        ? "live: a camera, as it came"
         : *kind == sources::SourceKind::Recording ? "recording: a video that was made before"
                                                   : "simulation: nobody's knee";
}

std::string guided_bundles(const recording::RecordedSession& session) {
  std::string names, last;
  for (const recording::SessionEvent& event : session.events()) {
    if (event.kind != recording::kPlanEvent) continue;
    const auto plan = session.plan_of(event).plan;
    if (!plan || plan->bundle == norms::Bundle::Whole) continue;
    const std::string name = tunnels::name_of(plan->key());
    if (name != last) names += (names.empty() ? "" : ", ") + name;
    last = name;
  }
  return names;
}

recording::ReadRegistration registrations_of(const recording::RecordedSession& session) {
  return
      [&session](const recording::SessionEvent& event) -> std::optional<registration::RegistrationSummary> {
        try {
          return session.registration_of(event);
        } catch (const InvalidInput&) {  // its event alone is told
          return std::nullopt;
        } catch (const IoError&) {
          return std::nullopt;
        }
      };
}

std::optional<registration::RegistrationSummary> registration_that_counts(
    const recording::RecordedSession& session) {
  recording::CountingRegistration registration;
  for (const recording::SessionEvent& event : session.events()) registration.follow(event);
  if (!registration.is_of_before()) return session.registration();
  recording::SessionEvent of_file;
  of_file.text = registration.counts().file;
  return session.registration_of(of_file);
}

namespace {

std::string in_capitals(std::string words) {
  std::transform(words.begin(), words.end(), words.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return words;
}

std::vector<std::pair<std::string, int>> alarms_of(const recording::RecordedSession& session) {
  std::vector<std::pair<std::string, int>> alarms;
  for (const recording::SessionEvent& event : session.events()) {
    if (event.kind != recording::kAlarmEvent && event.kind != recording::kVoidEvent) continue;
    const std::string text = event.text.empty() ? "over" : event.text;
    const auto told = std::ranges::find(alarms, text, &std::pair<std::string, int>::first);
    if (told == alarms.end())
      alarms.emplace_back(text, 1);
    else
      ++told->second;
  }
  return alarms;
}

constexpr const char* kNotKnownToItsEnd = "NOT KNOWN: the record is damaged";

std::string time_out_in_words(const Safety& safety) {
  if (safety.is_partial) return kNotKnownToItsEnd;
  switch (safety.time_out) {
    case Safety::TimeOut::NotRecorded:
      return "not recorded";
    case Safety::TimeOut::NotAsked:
      return "not asked: no live source";
    case Safety::TimeOut::NotConfirmed:
      return "not confirmed in this session";
    case Safety::TimeOut::Confirmed:
      break;
  }
  return std::string("confirmed") +
         (safety.confirmed ? " of the plan " + in_words(*safety.confirmed) : std::string()) +
         (safety.another_plan_followed ? "; NOT CONFIRMED of the plan after it" : "") +
         (safety.beside.empty() ? "" : "; BESIDE " + safety.beside);
}

// What was wrong with the picture when the time-out was confirmed by this command; empty: nothing.
std::string beside_time_out(const recording::SessionEvent& command) {
  const operation::Command given = operation::command_from_text(command.text, "the record");
  const auto* const time_out = std::get_if<operation::ConfirmTimeOut>(&given);
  return time_out != nullptr ? time_out->beside : "";
}

}  // namespace

Safety safety_of(const recording::RecordedSession& session, bool is_being_recorded) {
  bool is_verified = false, is_lost = false, was_verified = false, is_confirmed = false;
  recording::CountingRegistration registration;
  Safety safety{
      .cut_short = recording::cut_short_in_words(session.was_finished(), session.events(), is_being_recorded),
      .is_partial = !session.events_are_whole()};
  if (!session.was_finished() && !session.problems().empty())
    safety.cut_short = "the record is damaged, and how it ended is not known";
  const recording::SessionEvent* command = nullptr;  // the newest
  const std::vector<PlanInForce> plans = plans_in_force(session);
  const operation::PlannedTunnel* plan = nullptr;       // in force
  const operation::PlannedTunnel* confirmed = nullptr;  // that the time-out was confirmed of last
  for (const recording::SessionEvent& event : session.events()) {
    for (const PlanInForce& next : plans)
      if (next.event == &event) plan = &next.plan;
    const bool ends = recording::is_registration(event) || event.kind == recording::kVoidEvent ||
                      event.kind == recording::kVerificationLostEvent;
    is_lost = event.kind == recording::kVerificationLostEvent || (is_lost && !ends);
    is_verified = event.kind == recording::kVerifiedEvent || (is_verified && !ends);
    was_verified = was_verified || is_verified;
    registration.follow(event);
    if (event.kind == recording::kVerificationSkippedEvent) safety.skipped = event.text;
    if (event.kind == recording::kCommandEvent) command = &event;
    if (event.kind == recording::kTimeOutConfirmedEvent) {
      confirmed = plan;
      is_confirmed = true;
      safety.beside = command != nullptr ? beside_time_out(*command) : "";
    }
    if (event.kind == recording::kGuideCheckedEvent) safety.guide = event.text;
  }
  using enum Safety::Verification;
  safety.verification = registration.counts().was_verified ? ByTouches
                        : is_lost                          ? DidNotHold
                        : was_verified                     ? OfAnEarlierRegistration
                        : !safety.skipped.empty()          ? Skipped
                                                           : None;
  const auto kind = session.header().source_kind;
  const bool is_live = kind == sources::SourceKind::Live;
  safety.time_out = is_confirmed ? Safety::TimeOut::Confirmed
                    : is_live    ? Safety::TimeOut::NotConfirmed
                    : kind       ? Safety::TimeOut::NotAsked
                                 : Safety::TimeOut::NotRecorded;
  if (confirmed != nullptr) safety.confirmed = *confirmed;
  safety.another_plan_followed = confirmed != nullptr && *confirmed != *plan;
  if (is_live) safety.source_faults = in_words(source_faults(session));
  safety.alarms = alarms_of(session);
  return safety;
}

std::string verification_in_words(const Safety& safety) {
  if (safety.is_partial) return kNotKnownToItsEnd;
  const std::string without = safety.skipped.empty() ? "" : "; guidance began without it";
  switch (safety.verification) {
    case Safety::Verification::ByTouches:
      return "verified by touches" + without;
    case Safety::Verification::DidNotHold:
      return "verified by touches that did not hold" + without;
    case Safety::Verification::OfAnEarlierRegistration:
      return "verified by touches earlier; of the last registration nothing is recorded" + without;
    case Safety::Verification::Skipped:
      return "SKIPPED: " + safety.skipped;
    case Safety::Verification::None:
      break;
  }
  return "not verified" + without;
}

std::string alarms_in_words(const Safety& safety) {
  std::string words;
  for (const auto& [text, count] : safety.alarms)
    words += (words.empty() ? "" : "; ") + text + (count > 1 ? files::format(" (%d times)", count) : "");
  if (safety.is_partial) return words.empty() ? kNotKnownToItsEnd : words + "; LATER ONES ARE NOT KNOWN";
  return words.empty() ? "none" : words;
}

std::vector<std::vector<std::string>> rows_of(const Safety& safety) {
  const auto told = [&](const std::string& words) { return safety.is_partial ? kNotKnownToItsEnd : words; };
  return {{"Record", safety.is_partial          ? "DAMAGED: what was done is not known to its end"
                     : safety.cut_short.empty() ? "from beginning to end"
                                                : "CUT SHORT: " + safety.cut_short},
          {"Verification", verification_in_words(safety)},
          {"Time-out", time_out_in_words(safety)},
          {"Check of a nominal guide", told(safety.guide.empty() ? "none in this session" : safety.guide)},
          {"Faults of the source", told(safety.source_faults.value_or("not looked for: no live source"))},
          {"Alarms, void registrations", alarms_in_words(safety)}};
}

SessionFigures figures_of(const recording::RecordedSession& session) {
  long with_world = 0, with_mark = 0, in_other_medium = 0;
  const auto options = session.pipeline_options();
  const auto* world = options.tools.find_world_marker(session.header().bone);
  const bool is_of_several = world != nullptr && !world->markers.empty();
  for (const recording::RecordedFrame& frame : session.frames()) {
    for (const auto& pose : frame.poses)
      with_world += world != nullptr && !is_of_several && pose.marker_id == world->marker_id;
    for (const auto& body : frame.bodies) with_world += is_of_several && body.id == world->marker_id;
    if (options.tools.tracker && world != nullptr)
      with_world += tracker::state_of(frame.outside, world->marker_id) == tracker::BodyState::Tracked;
    with_mark += frame.lens.mark == lens::MarkState::Found;
    in_other_medium += frame.guidance.state == guidance::GuidanceState::WrongMedium;
  }
  const double frames = std::max<double>(1, static_cast<double>(session.frames().size()));
  const double length_s =
      session.frames().empty() ? 0 : time_s(session, session.frames().back().timestamp_ns);
  return {session.frames().size(),
          length_s,
          100 * static_cast<double>(with_world) / frames,
          100 * static_cast<double>(with_mark) / frames,
          100 * static_cast<double>(in_other_medium) / frames,
          report::without_picture_s(session)};
}

std::string frames_in_words(const SessionFigures& figures) {
  const std::string words = std::to_string(figures.frames) + " in " + recording::clock_text(figures.length_s);
  return figures.without_picture_s > 0
             ? words + files::format("; NO PICTURE for %.1f s", figures.without_picture_s)
             : words;
}

double time_s(const recording::RecordedSession& session, std::int64_t timestamp_ns) {
  if (session.frames().empty()) return 0;
  return std::max(0.0, static_cast<double>(timestamp_ns - session.frames().front().timestamp_ns) * 1e-9);
}

std::string seen_and_said(const recording::RecordedSession& session,
                          const operation::AchievedTunnel& achieved) {
  std::string words = ", the last at " + recording::clock_text(time_s(session, achieved.timestamp_ns));
  const std::string file = operation::achieved_file_name(achieved.planned.key());
  for (auto it = session.events().rbegin(); it != session.events().rend(); ++it) {
    if (it->kind != recording::kDrilledEvent || it->text != file) continue;
    const bool had_ended = std::any_of(it, session.events().rend(), [](const auto& before) {
      return before.kind == recording::kSourceEndedEvent;
    });
    return words + "; said to be drilled at " + recording::clock_text(time_s(session, it->timestamp_ns)) +
           (had_ended ? ", after the pictures had ended" : "");
  }
  return words;
}

std::vector<Step> steps_of(const recording::RecordedSession& session) {
  struct Run {
    std::string words;
    double first_s = 0, last_s = 0;
    double for_s = 0;  // of a fault of the source
    int more = 0;
  };
  std::vector<Run> runs;
  const auto add = [&](std::string words, double at_s, double for_s) {
    // Each loss of the source keeps its own time.
    if (!runs.empty() && for_s == 0 && runs.back().words == words) {
      runs.back().last_s = at_s;
      ++runs.back().more;
    } else {
      runs.push_back({std::move(words), at_s, at_s, for_s, 0});
    }
  };
  const std::vector<PlanInForce> plans = plans_in_force(session);
  const std::vector<SourceFault> faults = source_faults(session);
  for (const recording::ToldEvent& told :
       recording::told_events(session.events(), registrations_of(session))) {
    const double at_s = time_s(session, told.event->timestamp_ns);
    for (std::size_t i = 1; i < plans.size(); ++i)
      if (plans[i].event == told.event) add("ANOTHER PLAN TAKEN OVER: " + in_words(plans[i].plan), at_s, 0);
    for (const SourceFault& fault : faults)
      if (fault.event == told.event && fault.is_loss())
        add(in_capitals("source: " + std::string(theatre::to_text(fault.trouble))), at_s, fault.for_s);
    if (!told.is_of_operation) continue;
    std::string words = told.words;
    if (told.gravity == recording::Gravity::Alarm) {
      words = in_capitals(words);
      if (!told.detail.empty()) words += ": " + told.detail;
    }
    add(std::move(words), at_s, 0);
  }
  std::vector<Step> steps;
  for (const Run& run : runs) {
    std::string words = run.words;
    if (run.more > 0)
      words += ", and " + std::to_string(run.more) +
               (run.more == 1 ? " time more until " : " times more until ") +
               recording::clock_text(run.last_s);
    else if (run.for_s > 0)
      words += files::format(", for %.1f s", run.for_s);
    steps.push_back({run.first_s, std::move(words)});
  }
  return steps;
}

}  // namespace arthronaut::report
