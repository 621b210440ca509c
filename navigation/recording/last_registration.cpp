#include "navigation/recording/last_registration.h"

#include <variant>

namespace arthronaut::recording {

std::string doubt_of(const registration::RegistrationSummary& unreliable) {
  std::string doubt = "it is not reliable";
  for (const std::string& reason : unreliable.reasons) doubt += "; " + reason;
  return doubt;
}

void LastRegistration::follow(const RecordedSession& session) {
  for (const SessionEvent& event : session.events()) follow(session, event);
}

std::string LastRegistration::refusal() const {
  if (!alarm_.empty()) return "it was in doubt at the end: " + alarm_;
  if (!doubt_.empty()) return doubt_;
  return good_ ? "" : "nothing was registered";
}

void LastRegistration::follow(const RecordedSession& session, const SessionEvent& event) {
  if (is_registration(event)) take(registration::read_registration_record(session.folder() / event.text));
  // What is void is of something else: what it is of decides again, and one touch, when it is brought back.
  if (event.kind == kVoidEvent) doubt_.clear();
  if (event.kind == kAlarmEvent && !event.text.empty()) alarm_ = event.text;
  if (event.kind == kVerifiedEvent) was_verified_ = true;
  if (event.kind == kVerificationLostEvent) was_verified_ = false;
  if (event.kind == kCommandEvent) take(operation::command_from_text(event.text, session.folder().string()));
}

void LastRegistration::take(const registration::RegistrationRecord& record) {
  if (!record.registration.has_pose) {  // the marker was placed anew
    *this = {};
    return;
  }
  // An alarm is over when what guided guides again, not when something else takes its place.
  if (record.registration.reliable) return take(record.registration, record.of.value_or(of_));
  doubt_ = doubt_of(record.registration);
}

void LastRegistration::take(const operation::Command& command) {
  // What it takes away is written a moment later, and a program may have ended in between.
  if (std::holds_alternative<operation::MarkerPlacedAnew>(command)) *this = {};
  const auto* given = std::get_if<operation::GiveRegistration>(&command);
  if (given != nullptr && given->registration.reliable) take(given->registration, given->of);
  const auto* resume = std::get_if<operation::ResumeOperation>(&command);
  if (resume != nullptr && resume->registration) take(*resume->registration, resume->registration_of);
}

void LastRegistration::take(const registration::RegistrationSummary& registration,
                            const registration::Provenance& of) {
  *this = {};
  good_ = registration;
  of_ = of;
}

}  // namespace arthronaut::recording
