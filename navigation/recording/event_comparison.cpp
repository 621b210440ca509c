#include "navigation/recording/event_comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "navigation/recording/operation_record.h"
#include "navigation/recording/session_files.h"
#include "planning/geometry/error.h"

namespace arthronaut::recording {

namespace {

// Commands and whatever else the second run is given come back by themselves, and so does the word that a
// tunnel is drilled without poses, or that it is not: older records have it as a note.
constexpr std::array kDecisions = {kAlarmEvent,
                                   kVoidEvent,
                                   kConfirmedEvent,
                                   kVerifiedEvent,
                                   kVerificationLostEvent,
                                   kVerificationSkippedEvent,
                                   kTimeOutConfirmedEvent,
                                   kGuideCheckedEvent,
                                   kPlanEvent,
                                   kRegistrationEvent,
                                   kGivenRegistrationEvent,
                                   kDrilledEvent,
                                   kDrilledTakenBackEvent};

struct Decision {
  std::int64_t frame = -1;
  std::string kind, text;
};

std::vector<Decision> decisions_of(const std::vector<SessionEvent>& events) {
  std::vector<Decision> decisions;
  for (const SessionEvent& event : events)
    if (std::ranges::find(kDecisions, event.kind) != kDecisions.end() &&
        (event.kind != kDrilledTakenBackEvent || !event.text.empty()))
      decisions.push_back(
          {event.after_frame, event.kind, is_registration(event) ? std::string() : event.text});
  return decisions;
}

std::vector<Decision> decisions_of(const std::vector<operation::JournalEntry>& entries) {
  using operation::JournalKind;
  std::vector<SessionEvent> events;
  for (const operation::JournalEntry& entry : entries) {
    if (const auto event = event_of(entry)) {
      events.push_back(*event);
    } else if (entry.kind == JournalKind::Plan) {
      events.push_back(
          {entry.timestamp_ns, std::string(kPlanEvent),
           entry.plan ? plan_to_text(entry.plan->tunnel, entry.plan->length_mm) : std::string()});
    } else {
      events.push_back(
          {entry.timestamp_ns,
           std::string(entry.registration_was_given ? kGivenRegistrationEvent : kRegistrationEvent), ""});
    }
    events.back().after_frame = entry.after_frame;
  }
  return decisions_of(events);
}

// Takes out of both what `is_same` finds in both.
template <typename IsSame, typename Tell>
void take_out(std::vector<Decision>& then, std::vector<Decision>& now, const IsSame& is_same,
              const Tell& tell) {
  std::erase_if(then, [&](const Decision& one) {
    const auto other = std::ranges::find_if(now, [&](const Decision& it) { return is_same(one, it); });
    if (other == now.end()) return false;
    tell(one, *other);
    now.erase(other);
    return true;
  });
}

std::string said(const Decision& decision) {
  return decision.text.empty() ? std::string() : " (" + decision.text + ")";
}

// The journal of a record that was cut off ends anywhere within its last frame.
std::int64_t first_frame_that_may_lack(const RecordedSession& session) {
  const bool was_stopped = std::ranges::any_of(
      session.events(), [](const SessionEvent& event) { return event.kind == kRecordingStoppedEvent; });
  if (session.was_finished() && !was_stopped) return std::numeric_limits<std::int64_t>::max();
  return session.frames().empty() ? -1 : session.frames().back().index;
}

using operation::AchievedTunnel;

// Of what was drilled in the end, by the files that keep it; taken back again, it is in none of them.
std::map<std::string, AchievedTunnel> achieved_of(const std::vector<operation::JournalEntry>& entries) {
  std::map<std::string, AchievedTunnel> achieved;
  for (const operation::JournalEntry& entry : entries) {
    if (!entry.achieved) continue;
    const std::string file = operation::achieved_file_name(entry.achieved->planned.key());
    if (entry.kind == operation::JournalKind::Drilled)
      achieved[file] = *entry.achieved;
    else
      achieved.erase(file);
  }
  return achieved;
}

}  // namespace

void compare_achieved(const RecordedSession& session, const std::vector<operation::JournalEntry>& entries,
                      double tolerance_mm, double tolerance_deg, ReplaySummary& summary) {
  for (const auto& [file, now] : achieved_of(entries)) {
    const std::string of = file == "achieved.json" ? "drilled" : "drilled (" + file + ")";
    const auto differs = [&](const std::string& detail) {
      summary.differences.push_back({-1, of, 0, "", detail});
    };
    AchievedTunnel then;
    try {
      then = operation::read_achieved_file(session.folder() / file);
    } catch (const IoError& error) {
      differs(error.what());
      continue;
    } catch (const InvalidInput& error) {
      differs(error.what());
      continue;
    }
    if (then.is_taken_back) {
      differs("was taken back and stands now");
      continue;
    }
    const auto amount = [&](const char* what, double value, const char* unit, double tolerance) {
      // Written so that NaN is a difference.
      if (value <= tolerance) return;
      summary.differences.push_back({-1, of + " " + what, value, unit, ""});
    };
    const auto measured = operation::compare(then.measured, now.measured),
               planned = operation::compare(then.planned, now.planned);
    amount("entry", measured.entry_mm, "mm", tolerance_mm);
    amount("direction", measured.angle_deg, "deg", tolerance_deg);
    amount("diameter", std::abs(then.measured.diameter_mm - now.measured.diameter_mm), "mm", tolerance_mm);
    amount("planned entry", planned.entry_mm, "mm", tolerance_mm);
    amount("planned direction", planned.angle_deg, "deg", tolerance_deg);
    amount("planned diameter", std::abs(then.planned.diameter_mm - now.planned.diameter_mm), "mm",
           tolerance_mm);
    amount("sigma of offset", std::abs(then.sigma_offset_mm - now.sigma_offset_mm), "mm", tolerance_mm);
    amount("sigma of angle", std::abs(then.sigma_angle_deg - now.sigma_angle_deg), "deg", tolerance_deg);
    if (then.depth_mm && now.depth_mm)
      amount("depth", std::abs(*then.depth_mm - *now.depth_mm), "mm", tolerance_mm);
    else if (then.depth_mm.has_value() != now.depth_mm.has_value())
      differs(now.depth_mm ? "has a depth now and had none" : "had a depth and has none now");
  }
}

void compare_events(const RecordedSession& session, const std::vector<operation::JournalEntry>& entries,
                    ReplaySummary& summary) {
  std::vector<Decision> then = decisions_of(session.events()), now = decisions_of(entries);
  const auto nothing = [](const Decision&, const Decision&) {};
  const auto differs = [&](const Decision& decision, const std::string& detail) {
    summary.differences.push_back({decision.frame, decision.kind, 0, "", detail});
  };
  if (summary.is_lossy) {
    take_out(
        then, now, [](const Decision& a, const Decision& b) { return a.kind == b.kind; }, nothing);
  } else {
    take_out(
        then, now,
        [](const Decision& a, const Decision& b) {
          return a.kind == b.kind && a.frame == b.frame && a.text == b.text;
        },
        nothing);
    take_out(
        then, now,
        [](const Decision& a, const Decision& b) { return a.kind == b.kind && a.frame == b.frame; },
        [&](const Decision& was, const Decision& is) {
          differs(was, "said \"" + was.text + "\" and says \"" + is.text + "\" now");
        });
  }
  for (const Decision& decision : then)
    differs(decision, "was recorded and does not come now" + said(decision));
  const std::int64_t may_lack = first_frame_that_may_lack(session);
  for (const Decision& decision : now)
    if (decision.frame < may_lack) differs(decision, "comes now and was not recorded" + said(decision));
}

}  // namespace arthronaut::recording
