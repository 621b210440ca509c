#include "navigation/recording/counting_registration.h"

namespace arthronaut::recording {

void CountingRegistration::follow(const SessionEvent& event) {
  // What verified the one before says nothing of this one.
  if (event.kind == kRegistrationEvent || event.kind == kGivenRegistrationEvent) newest_ = {event.text};
  if (event.kind == kVerifiedEvent) newest_.was_verified = true;
  if (event.kind == kVerificationLostEvent) newest_.was_verified = false;
  if (event.kind == kVoidEvent) {
    newest_.is_void = true;
    newest_.was_verified = false;
  }
  drilled_by_.follow(event, newest_);
}

}  // namespace arthronaut::recording
