#include "navigation/recording/session_facts.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "navigation/operation/achieved_tunnel.h"
#include "navigation/recording/case_sessions.h"
#include "navigation/recording/counting_registration.h"
#include "navigation/recording/drilled_by_word.h"
#include "navigation/recording/of_drilled.h"
#include "navigation/recording/recording_lock.h"
#include "navigation/recording/session.h"
#include "navigation/recording/session_database.h"
#include "navigation/recording/session_files.h"
#include "navigation/registration/registration_file.h"
#include "planning/geometry/error.h"

namespace arthronaut::recording {

namespace {

namespace fs = std::filesystem;
using library::SessionFacts;

constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();

// When the steps of an operation came to their ends.
class Steps {
 public:
  explicit Steps(std::int64_t start_ns) : start_ns_(start_ns), guided_ns_(start_ns) {}

  void follow(const SessionEvent& event) {
    // What is before the first frame (a plan, a registration that was brought along) has no time of its own.
    const std::int64_t at = std::max(event.timestamp_ns, start_ns_);
    if (event.kind == kRegistrationEvent && registered_ns_ == kNever) registered_ns_ = guided_ns_ = at;
    if (event.kind == kGivenRegistrationEvent && registered_ns_ == kNever) guided_ns_ = at;
    const bool is_trusted = event.kind == kVerifiedEvent || event.kind == kConfirmedEvent;
    if (is_trusted && verified_ns_ == kNever) verified_ns_ = guided_ns_ = at;
    if (event.kind == kVerificationLostEvent) verified_ns_ = kNever;
    drilled_ns_.follow(event, at);
  }
  void fill(SessionFacts& facts) const {
    facts.registering_min = minutes(start_ns_, registered_ns_);
    facts.verifying_min = minutes(registered_ns_, verified_ns_);
    facts.drilling_min =
        minutes(guided_ns_, drilled_ns_.newest() != nullptr ? *drilled_ns_.newest() : kNever);
  }

 private:
  static std::optional<double> minutes(std::int64_t from_ns, std::int64_t to_ns) {
    if (from_ns == kNever || to_ns == kNever || to_ns < from_ns) return std::nullopt;
    return static_cast<double>(to_ns - from_ns) * 1e-9 / 60;
  }
  std::int64_t start_ns_, guided_ns_;
  std::int64_t registered_ns_ = kNever, verified_ns_ = kNever;
  OfDrilled<std::int64_t> drilled_ns_;
};

void read_header(const fs::path& folder, SessionFacts& facts) {
  pipeline::PipelineOptions options;
  const SessionHeader header = read_session_header(folder, options);
  facts.started_utc = header.started_utc;
  facts.bone = header.bone;
  facts.side = header.side;
  if (header.source_kind) facts.source_kind = sources::to_text(*header.source_kind);
  facts.is_exercise = is_exercise(header);
}

void read_registration_file(const fs::path& file, SessionFacts& facts) {
  if (!fs::exists(file)) return;
  const auto registration = registration::read_registration_file(file);
  facts.registration_is_reliable = registration.has_pose && registration.reliable;
  if (!registration.has_pose) return;
  facts.registration_rms_mm = registration.rms_mm;
  facts.predicted_error_mm = registration.predicted_tre_mm;
}

void read_registration(const fs::path& folder, SessionFacts& facts) {
  read_registration_file(folder / "registration.json", facts);
}

void read_achieved(const fs::path& folder, SessionFacts& facts) {
  // Of two tunnels the one that is farther from its plan.
  for (const fs::path& file : operation::achieved_files(folder)) {
    const operation::AchievedTunnel achieved = operation::read_achieved_file(file);
    const auto difference = operation::compare(achieved.planned, achieved.measured);
    if (facts.entry_offset_mm && *facts.entry_offset_mm >= difference.entry_mm) continue;
    facts.entry_offset_mm = difference.entry_mm;
    facts.angle_deg = difference.angle_deg;
    facts.depth_mm = achieved.depth_mm;
  }
}

void read_record(const fs::path& folder, SessionFacts& facts) {
  SessionDatabase database = SessionDatabase::open(database_file(folder));
  Statement first = database.prepare("SELECT timestamp_ns FROM frames ORDER BY frame LIMIT 1");
  Steps steps(first.step() ? first.integer(0) : 0);
  Statement span = database.prepare(
      "SELECT (SELECT timestamp_ns FROM frames ORDER BY frame DESC LIMIT 1) - "
      "(SELECT timestamp_ns FROM frames ORDER BY frame LIMIT 1)");
  if (span.step() && !span.is_null(0)) facts.length_min = static_cast<double>(span.integer(0)) * 1e-9 / 60;
  Statement events =
      database.prepare("SELECT timestamp_ns, kind, text FROM events WHERE kind <> 'plan' ORDER BY id");
  CountingRegistration registration;
  std::vector<SessionEvent> of_drilling;
  while (events.step()) {
    const SessionEvent event{events.integer(0), events.text(1), events.text(2)};
    if (tells_of_drilling(event)) of_drilling.push_back(event);
    steps.follow(event);
    registration.follow(event);
    if (event.kind == kAlarmEvent && !event.text.empty()) ++facts.alarm_count;
  }
  facts.is_drilled_by_word = facts.bone && !drilled_by_word(of_drilling, *facts.bone).empty();
  facts.was_verified = registration.counts().was_verified;
  if (registration.is_of_before()) read_registration_file(folder / registration.counts().file, facts);
  if (registration.counts().is_void && facts.registration_is_reliable) facts.registration_is_reliable = false;
  steps.fill(facts);
  facts.was_finished = database.prepare("SELECT finished FROM ending").step();
}

}  // namespace

SessionFacts read_session_facts(const fs::path& session_folder) {
  SessionFacts facts;
  facts.id = session_folder.filename().string();
  facts.is_being_recorded = is_being_recorded(session_folder);
  // Each file by itself: what is whole is told although another one is broken.
  for (const auto read : {read_header, read_registration, read_achieved, read_record}) {
    try {
      read(session_folder, facts);
    } catch (const InvalidInput& error) {
      if (facts.problem.empty()) facts.problem = error.what();
    } catch (const IoError& error) {
      if (facts.problem.empty()) facts.problem = error.what();
    }
  }
  return facts;
}

}  // namespace arthronaut::recording
